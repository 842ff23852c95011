#include "tools/wex/drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>

#include "models/excavator/mjcf.hpp"
#include "models/types/cpu_clock.hpp"
#include "tools/wex/height_bias.hpp"
#include "tools/wex/reference_progress.hpp"
#include "tools/wex/solver_thread.hpp"
#include "tools/wex/support_margin.hpp"
#include "tools/wex/trajectory_execution.hpp"

namespace wex::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[320];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

const char* describe(Lifecycle lifecycle) {
  switch (lifecycle) {
    case Lifecycle::kFault:
      return "the machine is in fault";
    case Lifecycle::kEStop:
      return "the machine is in emergency stop";
    case Lifecycle::kUnconfigured:
      return "the machine is not heard any more";
    case Lifecycle::kInactive:
    case Lifecycle::kActive:
      break;
  }
  return "the machine is not enabled any more";
}

/// Refusals that pass: the machine holds meanwhile.
bool passes(WriteOutcome outcome) {
  switch (outcome) {
    case WriteOutcome::kBusStalled:
    case WriteOutcome::kRejectedStale:
    case WriteOutcome::kRejectedExpired:
    case WriteOutcome::kRejectedStopped:
    case WriteOutcome::kRejectedNotActive:
      return true;
    default:
      return false;
  }
}

const char* describe_refusal(WriteOutcome outcome) {
  switch (outcome) {
    case WriteOutcome::kRejectedNotFinite:
      return "a value that is not finite";
    case WriteOutcome::kRejectedWrongSize:
      return "another number of joints than the machine has";
    default:
      return "a joint far beyond its limits";
  }
}

/// One closed loop, from the first read to the end of the hold. Time is counted in control ticks
/// since the first read, so that nothing depends on rounding.
class Loop {
 public:
  Loop(const TerrainMap& terrain, const MachineModel& machine, const RefinedTrajectory& reference,
       const Pose2& goal, MachineIo& io, const DriveInstruments& instruments,
       const DriveSettings& settings)
      : machine_(machine),
        goal_(goal),
        io_(io),
        instruments_(instruments),
        settings_(settings),
        bias_(terrain, machine),
        progress_(reference.nodes),
        planned_duration_s_(reference.nodes.back().t_s - reference.nodes.front().t_s),
        workspace_(machine.tree.make_workspace()) {
    const MachineState first = io_.read();
    t0_s_ = first.t_s + first.age_s;
    // The reference's yaw and the machine's may differ by whole turns; the reference's is kept.
    const double yaw_difference = reference.nodes.front().q[kBaseYaw] - first.base[kBaseYaw];
    yaw_turns_rad_ = yaw_difference - wrap_angle(yaw_difference);
    if (settings_.solve_beside) solver_.emplace(instruments_.solve);
    if (instruments_.ground_truth) truth_at_start_ = instruments_.ground_truth();
    record_.extremes.min_scheduled_margin_m = record_.extremes.min_loaded_margin_m =
        std::numeric_limits<double>::infinity();
  }

  DriveRecord run() {
    io_.release();
    while (!finished_) {
      observe();
      check_limits();
      if (!finished_) check_lifecycle();
      if (!finished_) check_arrival();
      if (finished_) break;
      if (solver_) take_solved();
      take_pending_result();
      if (tick_ > 0 && !holding_since_s_) {
        progress_.advance(ticks_passed_ * settings_.control_period_s,
                          q_.head<kNumBaseCoordinates>());
      }
      if (tick_ >= next_solve_tick_ && !request_) solve();
      check_trajectory_age();
      if (!finished_ && !trajectory_.empty()) command();
      if (finished_) break;
      next_tick();
    }
    record_.duration_s = elapsed_s();
    integrate_truth();
    hold();
    judge();
    if (!instruments_.ground_truth) forget_what_only_truth_knows();
    record_.simulated_s = elapsed_s();
    record_.health = io_.health();
    return std::move(record_);
  }

 private:
  /// A solve under way.
  struct Request {
    int tick = 0;
    int expected_ticks = 0;
  };

  double elapsed_s() const { return tick_ * settings_.control_period_s; }
  double now_s() const { return t0_s_ + elapsed_s(); }
  int ticks(double duration_s) const {
    constexpr double kRounding = 1e-6;
    return static_cast<int>(std::ceil(duration_s / settings_.control_period_s - kRounding));
  }
  void next_tick() {
    const int before = tick_++;
    io_.wait_until(now_s());
    // A machine whose clock does not wait may be further: nothing is caught up.
    const MachineState state = io_.read();
    const double ahead_s = state.t_s + state.age_s - now_s();
    if (ahead_s >= settings_.control_period_s) {
      tick_ += static_cast<int>(ahead_s / settings_.control_period_s);
    }
    ticks_passed_ = tick_ - before;
  }
  void end(ErrorCode code, std::string reason) {
    record_.failure = Error{code, std::move(reason)};
    finished_ = true;
  }

  void observe() {
    state_ = io_.read();
    q_ = coordinates(machine_, state_);
    q_[kBaseYaw] += yaw_turns_rad_;
    bias_time_s_ = std::max(bias_time_s_, state_.t_s);  // a bus may deliver late
    bias_.update(bias_time_s_, q_);
    if (instruments_.ground_truth) truth_ = instruments_.ground_truth();
    DriveExtremes& x = record_.extremes;
    x.max_roll_rad = std::max(x.max_roll_rad, std::abs(q_[kBaseRoll]));
    x.max_pitch_rad = std::max(x.max_pitch_rad, std::abs(q_[kBasePitch]));
    for (int i = 0; i < kNumWheels; ++i) {
      x.max_wheel_penetration_m =
          std::max(x.max_wheel_penetration_m, truth_.wheel_penetration_m[i]);
      x.max_tyre_deflection_m = std::max(x.max_tyre_deflection_m, truth_.tyre_deflection_m[i]);
    }
    if (tick_ >= next_log_tick_) {
      log();
      const int period = ticks(settings_.log_period_s);
      next_log_tick_ = (tick_ / period + 1) * period;
    }
  }

  void log() {
    DriveSample sample_now;
    sample_now.t_s = elapsed_s();
    sample_now.base = q_.head<kNumBaseCoordinates>();
    sample_now.scalar_joints = instruments_.scalar_joints ? instruments_.scalar_joints()
                                                          : scalar_joint_values(machine_, q_);
    machine_.tree.update(q_, workspace_);
    for (int i = 0; i < kNumWheels; ++i) {
      const WheeledLeg& leg = machine_.legs[i];
      sample_now.wheel_m[i] =
          machine_.tree.position(workspace_, leg.carrier_body, leg.p_carrier_wheel).head<2>();
    }
    const ContactFlags scheduled =
        trajectory_.empty() ? kDrivingContacts : sample(trajectory_, now_s()).contacts;
    sample_now.scheduled_margin_m = support_margin_m(machine_, q_, scheduled);
    sample_now.contacts = scheduled;
    sample_now.loaded_margin_m = kUnknown;
    if (instruments_.ground_truth) {
      sample_now.contacts = {};
      for (int i = 0; i < kNumWheels; ++i) {
        sample_now.contacts[i] = truth_.wheel_load_n[i] > kContactLoadN;
      }
      sample_now.loaded_margin_m = truth_.stability_margin_m;
    }
    sample_now.reference_time_s = progress_.time_s();
    sample_now.reference_error_m = progress_.error_m(sample_now.base);
    sample_now.goal_distance_m = goal_distance_m();
    DriveExtremes& x = record_.extremes;
    x.min_scheduled_margin_m = std::min(x.min_scheduled_margin_m, sample_now.scheduled_margin_m);
    x.min_loaded_margin_m = std::min(x.min_loaded_margin_m, sample_now.loaded_margin_m);
    x.max_reference_error_m = std::max(x.max_reference_error_m, sample_now.reference_error_m);
    record_.samples.push_back(std::move(sample_now));
  }

  double goal_distance_m() const {
    return std::hypot(q_[kBaseX] - goal_.x_m, q_[kBaseY] - goal_.y_m);
  }
  double goal_yaw_error_rad() const { return std::abs(wrap_angle(q_[kBaseYaw] - goal_.yaw_rad)); }

  void check_limits() {
    const double tilt = std::max(std::abs(q_[kBaseRoll]), std::abs(q_[kBasePitch]));
    if (!q_.allFinite()) {
      end(ErrorCode::kInternal, format("the machine's state is not finite at %.1f s", elapsed_s()));
    } else if (tilt > settings_.max_tilt_rad) {
      end(ErrorCode::kOutOfLimits,
          format("tipped: %.1f degrees of tilt after %.1f s (limit %.0f)", tilt / kDegree,
                 elapsed_s(), settings_.max_tilt_rad / kDegree));
    } else if (truth_.body_contact) {
      end(ErrorCode::kOutOfLimits, format("the body touched the ground after %.1f s", elapsed_s()));
    }
  }

  std::string cause() const { return instruments_.cause ? ": " + instruments_.cause() : ""; }

  void check_lifecycle() {
    if (io_.lifecycle() == Lifecycle::kActive) return;
    end(ErrorCode::kStoppedSafely,
        format("stopped safely after %.1f s, ", elapsed_s()) + describe(io_.lifecycle()) + cause());
  }

  void command() {
    const WriteOutcome outcome =
        io_.write(command_at(machine_, trajectory_, now_s(), settings_.command_validity_s));
    if (taken(outcome)) {
      holding_since_s_.reset();
    } else if (!passes(outcome)) {
      end(ErrorCode::kStoppedSafely,
          format("stopped safely after %.1f s: the machine refused a command with %s", elapsed_s(),
                 describe_refusal(outcome)));
    } else if (!holding_since_s_) {
      holding_since_s_ = elapsed_s();
    } else if (elapsed_s() - *holding_since_s_ > settings_.hold_patience_s) {
      end(ErrorCode::kStoppedSafely,
          format("stopped safely after %.1f s: the machine holds since %.1f s", elapsed_s(),
                 *holding_since_s_) +
              cause());
    }
  }

  void integrate_truth() {
    DriveExtremes& x = record_.extremes;
    const GroundTruth truth =
        instruments_.ground_truth ? instruments_.ground_truth() : GroundTruth{};
    for (int i = 0; i < kNumWheels; ++i) {
      x.side_slip_m[i] = truth.side_slip_m[i] - truth_at_start_.side_slip_m[i];
      x.travel_m[i] = truth.wheel_travel_m[i] - truth_at_start_.wheel_travel_m[i];
      x.airborne_s[i] = truth.airborne_s[i] - truth_at_start_.airborne_s[i];
    }
  }

  void forget_what_only_truth_knows() {
    DriveExtremes& x = record_.extremes;
    x.min_loaded_margin_m = x.hold_vertical_rate_m_s = kUnknown;
    x.max_wheel_penetration_m = x.max_tyre_deflection_m = kUnknown;
    x.side_slip_m.fill(kUnknown);
    x.travel_m.fill(kUnknown);
    x.airborne_s.fill(kUnknown);
  }

  void check_arrival() {
    const bool standing = state_.base_velocity.head<3>().norm() < settings_.standing_m_s;
    const double distance_m = goal_distance_m(), yaw_rad = goal_yaw_error_rad();
    if (progress_.finished()) {
      if (!reference_end_s_) reference_end_s_ = elapsed_s();
      const bool exact = distance_m < settings_.arrival_m && yaw_rad < settings_.arrival_rad;
      const bool close =
          distance_m < settings_.goal_tolerance_m && yaw_rad < settings_.goal_tolerance_rad;
      const bool patience_over = elapsed_s() - *reference_end_s_ > settings_.arrival_patience_s;
      if (standing && (exact || (close && patience_over))) {
        finished_ = true;
        return;
      }
    }
    const double allowed_s = std::max(settings_.max_duration_factor * planned_duration_s_,
                                      settings_.least_max_duration_s);
    if (elapsed_s() > allowed_s) {
      end(ErrorCode::kStoppedSafely,
          format("stopped safely: time ran out after %.0f s (planned: %.1f s), %.2f m and %.1f "
                 "degrees from the goal",
                 elapsed_s(), planned_duration_s_, distance_m, yaw_rad / kDegree));
    }
  }

  void take_pending_result() {
    if (!pending_ || tick_ < pending_->applied_tick) return;
    trajectory_ = std::move(pending_->nodes);
    pending_.reset();
  }

  /// The delay a solve is expected to have: the fixed one, or the worst of the recent ones.
  int expected_delay_ticks() const {
    if (settings_.solve_delay_s) return ticks(*settings_.solve_delay_s);
    const auto worst = std::max_element(recent_delays_s_.begin(), recent_delays_s_.end());
    return ticks(worst == recent_delays_s_.end() ? settings_.mpc_period_s : *worst);
  }

  void solve() {
    const int expected = expected_delay_ticks();

    // A machine that holds stands where it is: the motion under way does not count.
    const std::vector<WholeBodyNode>& motion = holding_since_s_ ? kNoMotion : trajectory_;
    HorizonInput input;
    input.t_s = now_s() + expected * settings_.control_period_s;
    input.q = predict(q_, motion, state_.t_s, input.t_s - state_.t_s);
    input.qdot = motion.empty() ? Eigen::VectorXd::Zero(q_.size()) : rates(motion, input.t_s);
    input.reference_time_s =
        progress_.time_s() + (holding_since_s_ ? 0.0 : expected * settings_.control_period_s);
    input.height_bias_m = bias_.value_m();
    const Request request{tick_, expected};
    if (solver_) {
      solver_->begin(std::move(input));
      request_ = request;
    } else {
      const double cpu_begin_s = thread_cpu_time_s();
      HorizonResult result = instruments_.solve(input);
      const double cpu_s = thread_cpu_time_s() - cpu_begin_s;
      accept(request, std::move(result), cpu_s,
             settings_.solve_delay_s ? expected : std::max(expected, ticks(cpu_s)), cpu_s);
    }
    if (instruments_.on_progress) {
      instruments_.on_progress(progress_.fraction(), record_.samples.back().scheduled_margin_m);
    }
  }

  /// What the solver's thread has finished, if it has.
  void take_solved() {
    std::optional<SolverThread::Solved> solved = solver_->take();
    if (!solved) return;
    const Request request = *request_;
    request_.reset();
    const int delay = tick_ - request.tick;
    accept(request, std::move(solved->result), solved->cpu_time_s,
           std::max(request.expected_ticks, delay), delay * settings_.control_period_s);
  }

  /// A result is there when its delay is over, and not before the moment it was computed for.
  void accept(const Request& request, HorizonResult result, double cpu_s, int delay,
              double delay_s) {
    recent_delays_s_.push_back(delay_s);
    if (recent_delays_s_.size() > kRecentSolves) recent_delays_s_.pop_front();
    next_solve_tick_ = request.tick + std::max(delay, ticks(settings_.mpc_period_s));
    const double begin_s = request.tick * settings_.control_period_s;
    const bool late = solver_ && delay > request.expected_ticks;
    record_.solves.push_back({begin_s, begin_s + delay * settings_.control_period_s, cpu_s,
                              result.report.iterations, result.report.feasible, result.usable,
                              late});
    if (!result.usable) {
      last_status_ = result.report.status;
      return;
    }
    for (const auto& [name, residual] : result.report.worst_residual) {
      double& worst = record_.worst_residual[name];
      worst = std::max(worst, residual);
    }
    pending_ = Pending{request.tick + delay, std::move(result.nodes)};
  }

  /// An old trajectory is better than none until it nears its end; then the machine is stopped.
  void check_trajectory_age() {
    const double good_until_s = trajectory_.empty()
                                    ? t0_s_ + kFirstSolutionS
                                    : trajectory_.back().t_s - settings_.stale_before_end_s;
    if (now_s() <= good_until_s) return;
    end(ErrorCode::kStoppedSafely,
        format(
            "stopped safely after %.1f s: the receding-horizon optimizer has no usable result (%s)",
            elapsed_s(), last_status_.c_str()));
  }

  void hold() {
    io_.stop();
    const double stop_s = elapsed_s();
    const auto duration_s = [this] {
      return io_.lifecycle() == Lifecycle::kActive ? settings_.hold_s : settings_.after_loss_s;
    };
    while (elapsed_s() - stop_s < duration_s()) {
      next_tick();
      observe();
      if (elapsed_s() - stop_s > settings_.hold_settle_s) {
        double& worst = record_.extremes.hold_vertical_rate_m_s;
        worst = std::max(worst, std::abs(truth_.base_vertical_rate_m_s));
      }
      if (!record_.failure) check_limits();
      if (!record_.failure) check_lifecycle();
    }
  }

  void judge() {
    record_.goal_error_m = goal_distance_m();
    record_.goal_error_rad = goal_yaw_error_rad();
    const bool reached = record_.goal_error_m <= settings_.goal_tolerance_m &&
                         record_.goal_error_rad <= settings_.goal_tolerance_rad;
    if (record_.failure || reached) return;
    end(ErrorCode::kStoppedSafely,
        format("stopped safely, but drifted to %.2f m and %.1f degrees from the goal while holding",
               record_.goal_error_m, record_.goal_error_rad / kDegree));
  }

  struct Pending {
    int applied_tick = 0;
    std::vector<WholeBodyNode> nodes;
  };
  static constexpr std::size_t kRecentSolves = 10;
  inline static const std::vector<WholeBodyNode> kNoMotion;
  static constexpr double kFirstSolutionS = 3.0;  ///< patience for the first usable result

  const MachineModel& machine_;
  Pose2 goal_;
  MachineIo& io_;
  const DriveInstruments& instruments_;
  DriveSettings settings_;
  HeightBias bias_;
  ReferenceProgress progress_;
  double planned_duration_s_;
  KinematicTree::Workspace workspace_;

  double t0_s_ = 0.0;
  double yaw_turns_rad_ = 0.0;
  int tick_ = 0, ticks_passed_ = 1, next_solve_tick_ = 0, next_log_tick_ = 0;
  double bias_time_s_ = -std::numeric_limits<double>::infinity();
  MachineState state_;
  Eigen::VectorXd q_;
  GroundTruth truth_, truth_at_start_;
  std::vector<WholeBodyNode> trajectory_;  ///< under way, absolute machine time
  std::optional<Pending> pending_;
  std::deque<double> recent_delays_s_;
  std::optional<Request> request_;         ///< under way on the solver's thread
  std::optional<double> holding_since_s_;  ///< the machine holds without being asked to
  std::optional<double> reference_end_s_;
  std::string last_status_ = "none yet";
  bool finished_ = false;
  DriveRecord record_;
  std::optional<SolverThread> solver_;  ///< last: its thread ends first
};

}  // namespace

DriveRecord drive(const TerrainMap& terrain, const MachineModel& machine,
                  const RefinedTrajectory& reference, const Pose2& goal, MachineIo& io,
                  const DriveInstruments& instruments, const DriveSettings& settings) {
  WEX_EXPECTS(!reference.nodes.empty());
  WEX_EXPECTS(instruments.solve != nullptr);
  return Loop(terrain, machine, reference, goal, io, instruments, settings).run();
}

}  // namespace wex::app
