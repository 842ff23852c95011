#include "tools/wex/pipeline.hpp"

#include <chrono>
#include <cstdio>

#include "hw_interface/socketcan/socketcan_machine.hpp"
#include "initializer/explained_plan.hpp"
#include "models/excavator/mjcf.hpp"
#include "models/types/cpu_clock.hpp"
#include "mpc/refinement/refine.hpp"
#include "tools/wex/drive.hpp"
#include "tools/wex/motion_csv.hpp"
#include "tools/wex/output_folder.hpp"
#include "tools/wex/overview_picture.hpp"
#include "tools/wex/real_time_priority.hpp"
#include "tools/wex/scenario.hpp"
#include "tools/wex/timeline_picture.hpp"

namespace wex::app {
namespace {

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[160];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

/// CPU and elapsed time since construction or the last lap.
class Stopwatch {
 public:
  StageTime lap() {
    const double cpu_s = thread_cpu_time_s();
    const auto wall = Clock::now();
    const StageTime time{cpu_s - cpu_s_, std::chrono::duration<double>(wall - wall_).count()};
    cpu_s_ = cpu_s;
    wall_ = wall;
    return time;
  }

 private:
  using Clock = std::chrono::steady_clock;
  double cpu_s_ = thread_cpu_time_s();
  Clock::time_point wall_ = Clock::now();
};

/// Off-screen pictures at even steps of the drive's progress, the last one at its end.
class FrameRecorder {
 public:
  FrameRecorder(SimulatedMachine& machine, const OutputFolder& folder, int count)
      : machine_(machine), folder_(folder), count_(count) {}

  void at(double fraction) {
    while (next_ < count_ - 1 && fraction >= static_cast<double>(next_) / (count_ - 1)) render();
  }
  void finish() {
    while (next_ < count_) render();
  }
  [[nodiscard]] const StageTime& time() const noexcept { return time_; }
  [[nodiscard]] const std::optional<std::string>& problem() const noexcept { return problem_; }

 private:
  void render() {
    Stopwatch watch;
    ++next_;
    const Result<void> rendered =
        folder_.publish(format("frames/frame_%02d.png", next_),
                        [&](const auto& file) { return machine_.render(file.string()); });
    if (!rendered) {
      problem_ = "no frames: " + rendered.error().message;
      count_ = 0;  // one attempt tells: without a renderer all others fail alike
    }
    const StageTime lap = watch.lap();
    time_.cpu_s += lap.cpu_s;
    time_.wall_s += lap.wall_s;
  }

  SimulatedMachine& machine_;
  const OutputFolder& folder_;
  int count_;
  int next_ = 0;
  StageTime time_;
  std::optional<std::string> problem_;
};

/// One run; each stage is a member that returns what the caller must know to go on.
class Pipeline {
 public:
  Pipeline(const RunOptions& options, Scenario scenario, std::vector<std::string> joint_names,
           std::string model_xml, OutputFolder folder, std::unique_ptr<can::SocketCanMachine> bus,
           Stopwatch watch, Progress& progress)
      : scenario_(std::move(scenario)),
        joint_names_(std::move(joint_names)),
        model_xml_(std::move(model_xml)),
        folder_(std::move(folder)),
        bus_(std::move(bus)),
        lock_step_(bus_ && bus_->lock_step()),
        bus_begin_s_(bus_ ? bus_->read().t_s : 0.0),
        watch_(watch),
        progress_(progress) {
    report_.options = options;
    report_.task_map = {map_from_local(scenario_.task.start, scenario_.terrain),
                        map_from_local(scenario_.task.goal, scenario_.terrain)};
    report_.map_origin_m = scenario_.terrain.map_origin_m();
  }

  Result<RunReport> run() {
    report_.stages["load"] = watch_.lap();
    Result<void> done = plan();
    if (done && go_on()) done = refine_plan();
    if (done && go_on()) done = bus_ ? drive_on_bus() : drive_simulation();
    if (done) done = draw();
    if (!done) return tl::unexpected(done.error());
    report_.stages["report"] = watch_.lap();
    done = folder_.publish_text("result.json", result_json(report_));
    if (!done) return tl::unexpected(done.error());
    return std::move(report_);
  }

 private:
  bool go_on() const { return !report_.failure && report_.options.depth == Depth::kDrive; }

  Result<void> plan() {
    progress_.begin("plan");
    PlanSettings settings = report_.options.planning;
    // Refinement and tracking hold four wheels on the ground.
    if (report_.options.depth == Depth::kDrive) settings.mode = PlanMode::kDriveOnly;
    settings.seed = report_.options.seed;
    settings.iterations = report_.options.iterations;
    settings.time_budget_s = report_.options.time_budget_s;
    SearchCensus turned_down;
    Result<Plan> plan = make_plan(
        scenario_.terrain, scenario_.machine, scenario_.task, settings,
        [this](const PlanProgress& p) {
          listen();
          progress_.update(format("%.1f s, ", p.elapsed_s) +
                           (p.best_cost ? format("best path costs %.2f m", *p.best_cost)
                                        : std::string("no path yet")));
        },
        turned_down);
    report_.stages["plan"] = watch_.lap();
    if (!plan &&
        (plan.error().code == ErrorCode::kBadInput || plan.error().code == ErrorCode::kInternal)) {
      return tl::unexpected(plan.error());
    }
    // From here on this run owns the folder.
    folder_.remove_stale({"result.json", "plan.csv", "refined.csv", "executed.csv", "model.xml",
                          "overview.png", "timeline.png", "frames", "bus.log"});
    if (Result<void> done = folder_.publish_text("model.xml", model_xml_); !done) return done;
    if (!plan) {
      progress_.end("failed");
      report_.failure = plan.error();
      if (turned_down.num_poses() > 0) report_.search = std::move(turned_down);
      return {};
    }
    report_.plan = std::move(*plan);
    progress_.end(
        format("%.2f m, %zu nodes", report_.plan->path_length_m, report_.plan->nodes.size()));
    return publish_motion("plan.csv", report_.plan->nodes);
  }

  Result<void> refine_plan() {
    progress_.begin("refine");
    Result<RefinedTrajectory> refined = refine(
        scenario_.terrain, scenario_.machine, *report_.plan, {}, [this](const SolveIteration& i) {
          listen();
          progress_.update(
              format("iteration %d, infeasibility %.1e", i.iteration, i.infeasibility));
        });
    report_.stages["refine"] = watch_.lap();
    if (!refined) {
      progress_.end("failed");
      report_.failure = refined.error();
      return {};
    }
    report_.refined = std::move(*refined);
    progress_.end(format("%d iterations, %s", report_.refined->report.iterations,
                         report_.refined->report.status.c_str()));
    return publish_motion("refined.csv", report_.refined->nodes);
  }

  /// Takes what has come meanwhile, so that the bus's receive buffer does not overflow.
  void listen() {
    if (bus_) (void)bus_->read();
  }

  Result<void> drive_simulation() {
    progress_.begin("drive");
    Result<std::unique_ptr<SimulatedMachine>> machine = SimulatedMachine::create(
        scenario_.machine, scenario_.terrain, report_.refined->nodes.front().q);
    if (!machine) return tl::unexpected(machine.error());
    SimulatedMachine& io = **machine;
    RecedingHorizon optimizer(scenario_.terrain, scenario_.machine, *report_.refined);
    FrameRecorder frames(io, folder_, report_.options.frames);

    DriveInstruments instruments;
    instruments.solve = [&](const HorizonInput& input) { return optimizer.solve(input); };
    instruments.ground_truth = [&] { return io.ground_truth(); };
    instruments.scalar_joints = [&] { return io.scalar_joint_positions(); };
    instruments.on_progress = [&](double fraction, double margin_m) {
      frames.at(fraction);
      progress_.update(
          format("%3.0f %% of the drive, stability margin %.2f m", 100.0 * fraction, margin_m));
    };
    DriveSettings settings;
    settings.solve_delay_s = report_.options.solve_delay_s;
    report_.drive = drive(scenario_.terrain, scenario_.machine, *report_.refined,
                          scenario_.task.goal, io, instruments, settings);
    frames.finish();
    if (frames.problem()) report_.warnings.push_back(*frames.problem());
    report_.failure = report_.drive->failure;
    report_.simulation_cpu_s = io.cpu_time_s();
    StageTime time = watch_.lap();
    time.cpu_s -= frames.time().cpu_s;
    time.wall_s -= frames.time().wall_s;
    report_.stages["drive"] = time;
    report_.stages["frames"] = frames.time();
    return end_of_drive();
  }

  /// Whatever happens to the drive, the machine is left disabled and the bus reported.
  Result<void> drive_on_bus() {
    progress_.begin("drive");
    if (report_.options.frames > 0) {
      report_.warnings.push_back(
          "no frames and no ground truth: the machine on the bus is not simulated here");
    }
    report_.simulation_cpu_s = std::numeric_limits<double>::quiet_NaN();
    RecedingHorizon optimizer(scenario_.terrain, scenario_.machine, *report_.refined);
    DriveInstruments instruments;
    instruments.solve = [&](const HorizonInput& input) { return optimizer.solve(input); };
    instruments.cause = [this] { return can::describe(bus_->cause()); };
    instruments.on_progress = [&](double fraction, double margin_m) {
      progress_.update(
          format("%3.0f %% of the drive, stability margin %.2f m", 100.0 * fraction, margin_m));
    };
    DriveSettings settings;
    settings.solve_delay_s = report_.options.solve_delay_s;
    settings.solve_beside = !lock_step_;
    std::optional<RealTimePriority> priority;
    if (!lock_step_) priority.emplace();
    if (const Result<void> enabled = bus_->activate(); enabled) {
      report_.drive = drive(scenario_.terrain, scenario_.machine, *report_.refined,
                            scenario_.task.goal, *bus_, instruments, settings);
      report_.failure = report_.drive->failure;
    } else {
      report_.failure = enabled.error();
    }
    bus_->deactivate();
    priority.reset();
    report_.bus = bus_report(report_.options.can_interface, lock_step_, *bus_);
    report_.bus->machine_s = bus_->read().t_s - bus_begin_s_;
    StageTime time = watch_.lap();
    if (settings.solve_beside && report_.drive) {
      for (const SolveSample& solve : report_.drive->solves) time.cpu_s += solve.cpu_time_s;
    }
    report_.stages["drive"] = time;
    if (report_.failure) {
      const Result<void> written = folder_.publish("bus.log", [&](const auto& file) {
        return bus_->recorder().write(file.string(), report_.options.can_interface);
      });
      if (!written) return written;
      report_.bus->log = "bus.log";
    }
    return end_of_drive();
  }

  Result<void> end_of_drive() {
    progress_.end(report_.failure ? report_.failure->message : "goal reached");
    if (!report_.drive) return {};
    return folder_.publish_text(
        "executed.csv",
        executed_motion_csv(joint_names_, report_.drive->samples, report_.map_origin_m));
  }

  /// A picture that cannot be drawn is a warning: the run and its numbers stand.
  Result<void> draw() {
    const auto try_to = [this](const char* name, const auto& draw_picture) {
      if (const Result<void> drawn = folder_.publish(name, draw_picture); !drawn) {
        report_.warnings.push_back(drawn.error().message);
      }
    };
    try_to("overview.png", [&](const auto& file) {
      return draw_overview(report_, scenario_.terrain, scenario_.machine, file);
    });
    if (report_.drive) {
      try_to("timeline.png", [&](const auto& file) { return draw_timeline(report_, file); });
    } else if (report_.plan && report_.options.depth == Depth::kPlanOnly) {
      const std::string title = report_.options.map.filename().string() + ", seed " +
                                std::to_string(report_.options.seed) + ": the plan over time";
      try_to("timeline.png", [&](const auto& file) {
        return draw_plan_timeline(*report_.plan, scenario_.machine, title, file);
      });
    }
    return {};
  }

  Result<void> publish_motion(const char* name, const std::vector<WholeBodyNode>& nodes) {
    return folder_.publish_text(
        name, planned_motion_csv(scenario_.machine, joint_names_, nodes, report_.map_origin_m));
  }

  Scenario scenario_;
  std::vector<std::string> joint_names_;
  std::string model_xml_;
  OutputFolder folder_;
  std::unique_ptr<can::SocketCanMachine> bus_;  ///< empty: the simulation
  bool lock_step_;
  double bus_begin_s_;  ///< machine time
  Stopwatch watch_;
  Progress& progress_;
  RunReport report_;
};

can::SocketCanSettings::Pace pace_of(CanPace pace) {
  switch (pace) {
    case CanPace::kRealTime:
      return can::SocketCanSettings::Pace::kRealTime;
    case CanPace::kLockStep:
      return can::SocketCanSettings::Pace::kLockStep;
    case CanPace::kAsAnnounced:
      break;
  }
  return can::SocketCanSettings::Pace::kAsAnnounced;
}

/// The machine on the bus tells where it stands.
Result<Pose2> connect(const RunOptions& options, const TerrainMap& terrain,
                      const MachineModel& machine, std::unique_ptr<can::SocketCanMachine>& bus) {
  can::SocketCanSettings settings;
  settings.pace = pace_of(options.can_pace);
  auto opened =
      can::SocketCanMachine::open(options.can_interface, machine, terrain.map_origin_m(), settings);
  if (!opened) return tl::unexpected(opened.error());
  bus = std::move(*opened);
  const MachineState state = bus->read();
  return Pose2{state.base[kBaseX], state.base[kBaseY], state.base[kBaseYaw]};
}

}  // namespace

Result<RunReport> run_pipeline(const RunOptions& options, Progress& progress) {
  const Stopwatch watch;
  progress.begin("load");
  std::unique_ptr<can::SocketCanMachine> bus;
  MeasureStart measure_start;
  if (!options.can_interface.empty()) {
    if (options.start) {
      return fail(ErrorCode::kBadInput,
                  "--start and --can exclude each other: the machine on the bus says where it "
                  "stands");
    }
    measure_start = [&](const TerrainMap& terrain, const MachineModel& machine) {
      return connect(options, terrain, machine, bus);
    };
  }
  Result<Scenario> scenario = load_scenario(options, measure_start);
  if (!scenario) return tl::unexpected(scenario.error());
  Result<OutputFolder> folder = OutputFolder::open(options.out);
  if (!folder) return tl::unexpected(folder.error());
  Result<std::vector<std::string>> joint_names = scalar_joint_names(scenario->machine);
  if (!joint_names) return tl::unexpected(joint_names.error());
  Result<std::string> model_xml = machine_mjcf(scenario->machine);
  if (!model_xml) return tl::unexpected(model_xml.error());
  progress.end(options.map.string());
  return Pipeline(options, std::move(*scenario), std::move(*joint_names), std::move(*model_xml),
                  std::move(*folder), std::move(bus), watch, progress)
      .run();
}

}  // namespace wex::app
