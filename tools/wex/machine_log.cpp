#include "tools/wex/machine_log.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

namespace wex::app {
namespace {

constexpr double kMovingRate = 0.06;  ///< rad/s or m/s: shut cylinders swing back more slowly
constexpr double kTravellingRate_rad_s = 0.08;  ///< 5 cm/s at the tyre

}  // namespace

const char* name_of(can::MachineMode mode) noexcept {
  switch (mode) {
    case can::MachineMode::kInit:
      return "init";
    case can::MachineMode::kReady:
      return "ready";
    case can::MachineMode::kEnabling:
      return "enabling";
    case can::MachineMode::kEnabled:
      return "enabled";
    case can::MachineMode::kHold:
      return "hold";
    case can::MachineMode::kFault:
      return "fault";
    case can::MachineMode::kEStop:
      return "estop";
  }
  return "unknown";
}

MachineLog::MachineLog(std::filesystem::path name, std::FILE* file, const MachineModel& machine,
                       const Eigen::Vector2d& map_origin_m)
    : name_(std::move(name)),
      file_(file),
      machine_(machine),
      map_origin_m_(map_origin_m),
      workspace_(machine.tree.make_workspace()),
      q_(Eigen::VectorXd::Zero(machine.num_coordinates())) {
  std::fputs("t,mode,session,faults,base_x,base_y,base_z,base_yaw,base_pitch,base_roll", file);
  for (const char* prefix : {"q", "dq"}) {
    for (const Joint& joint : machine_.joints) {
      std::fprintf(file, ",%s_%s", prefix, joint.name.c_str());
    }
  }
  for (int wheel = 0; wheel < kNumWheels; ++wheel) {
    std::fprintf(file, ",load_%s", std::string(kLimbNames[wheel]).c_str());
  }
  std::fputs(
      ",bucket_x,bucket_y,bucket_z,accepted,rejected,moving,travelling,driven,brakes,base_dz,sink,"
      "side_slip,travel,lift_off,margin,body_contact\n",
      file);
}

Result<MachineLog> MachineLog::open(const std::filesystem::path& file, const MachineModel& machine,
                                    const Eigen::Vector2d& map_origin_m) {
  std::FILE* stream = std::fopen(file.c_str(), "w");
  if (stream == nullptr) {
    return fail(ErrorCode::kBadInput,
                "--log " + file.string() + " cannot be written: " + std::strerror(errno));
  }
  return MachineLog(file, stream, machine, map_origin_m);
}

void MachineLog::row(std::int64_t now_ms, const can::Electronics& electronics,
                     const SimulatedPlant& plant) {
  std::FILE* file = file_.get();
  const can::PlantState& state = electronics.plant_state();
  const can::MachineAutomaton& automaton = electronics.automaton();
  const int num_joints = machine_.num_joints();
  std::fprintf(file, "%.2f,%s,%08x,%u", 1e-3 * static_cast<double>(now_ms),
               name_of(automaton.mode()), automaton.session(), automaton.fault_bits());
  std::fprintf(file, ",%.5f,%.5f,%.5f,%.6f,%.6f,%.6f", state.base[kBaseX] + map_origin_m_.x(),
               state.base[kBaseY] + map_origin_m_.y(), state.base[kBaseZ], state.base[kBaseYaw],
               state.base[kBasePitch], state.base[kBaseRoll]);
  bool moving = false, travelling = false;
  for (int i = 0; i < num_joints; ++i) std::fprintf(file, ",%.6f", state.position[i]);
  for (int i = 0; i < num_joints; ++i) {
    std::fprintf(file, ",%.5f", state.rate[i]);
    const bool is_wheel = machine_.joints[i].role == JointRole::kWheel;
    travelling = travelling || (is_wheel && std::abs(state.rate[i]) > kTravellingRate_rad_s);
    moving = moving || (!is_wheel && std::abs(state.rate[i]) > kMovingRate);
  }
  const GroundTruth truth = plant.ground_truth();
  for (const double load_n : truth.wheel_load_n) std::fprintf(file, ",%.0f", load_n);
  Eigen::Vector3d bucket = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  if (machine_.arm) {
    q_.head<kNumBaseCoordinates>() = state.base;
    for (int i = 0; i < num_joints; ++i) q_[kNumBaseCoordinates + i] = state.position[i];
    machine_.tree.update(q_, workspace_);
    bucket = machine_.tree.position(workspace_, machine_.arm->contact_body,
                                    machine_.arm->p_body_contact);
    bucket.head<2>() += map_origin_m_;
  }
  std::fprintf(file, ",%.4f,%.4f,%.4f", bucket.x(), bucket.y(), bucket.z());
  const can::PlantInput& input = electronics.plant_input();
  bool driven = false;
  for (int i = 0; i < num_joints; ++i) driven = driven || input.spool[i] != 0.0;
  driven = input.motion_released && (driven || !electronics.brakes_closed());
  const can::ElectronicsCounters& counters = electronics.counters();
  std::fprintf(file, ",%ld,%ld,%d,%d,%d,%d", counters.commands_accepted,
               counters.commands_rejected(), moving, travelling, driven,
               electronics.brakes_closed());
  const auto sum = [](const auto& wheels) {
    return std::accumulate(wheels.begin(), wheels.end(), 0.0);
  };
  std::fprintf(
      file, ",%.5f,%.5f,%.4f,%.4f,%.2f,%.3f,%d\n", truth.base_vertical_rate_m_s,
      *std::max_element(truth.wheel_penetration_m.begin(), truth.wheel_penetration_m.end()),
      sum(truth.side_slip_m), sum(truth.wheel_travel_m), sum(truth.airborne_s),
      truth.stability_margin_m, truth.body_contact);
}

Result<void> MachineLog::close() {
  const bool failed = std::ferror(file_.get()) != 0;
  if (std::fclose(file_.release()) != 0 || failed) {
    return fail(ErrorCode::kInternal,
                "--log " + name_.string() + " is not complete: the disk did not take it");
  }
  return {};
}

}  // namespace wex::app
