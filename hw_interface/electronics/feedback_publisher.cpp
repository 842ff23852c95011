#include "hw_interface/electronics/feedback_publisher.hpp"

#include <algorithm>
#include <cmath>

namespace wex::can {
namespace {

// What the DBC lets a sensor say; beyond it a sensor is at its rail. Kept inside by one step of the
// coarsest resolution, so that rounding cannot leave the range.
constexpr double kPositionMargin = 0.2499;  ///< rad or m beyond a stop
constexpr double kMaxRate = 5.999;          ///< rad/s or m/s
constexpr double kMaxPressure_pa = 59e6;
constexpr double kMaxAngularVelocity_rad_s = 9.9;
constexpr double kMaxAcceleration_m_s2 = 99.0;
constexpr double kMaxVelocity_m_s = 19.9;
constexpr double kGravity_m_s2 = 9.81;
constexpr long kPeriodsPerPressure = 2, kPeriodsPerStatus = 5;

Eigen::Vector3d clamped(const Eigen::Vector3d& value, double limit) noexcept {
  return value.cwiseMax(-limit).cwiseMin(limit);
}

}  // namespace

FeedbackPublisher::FeedbackPublisher(const MachineModel& machine, const SlotMap& slots,
                                     const Eigen::Vector2d& map_origin_m, double period_s)
    : slots_(slots), map_origin_m_(map_origin_m), period_s_(period_s) {
  for (int i = 0; i < machine.num_joints(); ++i) {
    const Joint& joint = machine.joints[i];
    joints_[i] = {limits_of(slot_of(joint.name)), joint.continuous, joint.role == JointRole::kWheel,
                  machine.pump_pressure_pa / joint.max_effort};
  }
}

template <typename Message>
void FeedbackPublisher::send(FramePort& port, const Message& message,
                             SendContext& context) noexcept {
  CanFrame frame;
  // A value that the codec refuses is never sent; the receiver's ages tell.
  if (!encode(message, context, frame)) {
    ++not_taken_;
    return;
  }
  port_status_ = port.send(frame);
  ++(port_status_ == SocketStatus::kOk ? sent_ : not_taken_);
}

void FeedbackPublisher::send_zone_feedback(FramePort& port, const Sample& sample,
                                           int zone) noexcept {
  ZoneFeedback feedback;
  feedback.zone = zone;
  feedback.sample_time_ms = sample.sample_time_ms;
  feedback.quality.fill(JointQuality::kNotAvailable);
  for (int i = 0; i < kMaxZoneJoints; ++i) {
    const int joint = slots_[zone][i];
    if (joint < 0) continue;
    const JointData& data = joints_[joint];
    const double position = sample.plant->position[joint], rate = sample.plant->rate[joint];
    feedback.spool[i] = data.wheel ? sample.input->wheel_rate[joint] / data.limits.max_rate
                                   : sample.input->spool[joint];
    feedback.spool[i] = std::clamp(feedback.spool[i], -1.0, 1.0);
    feedback.quality[i] = JointQuality::kInvalid;
    if (!sample.plant->sensors_valid || !std::isfinite(position) || !std::isfinite(rate)) continue;
    const double shown = data.continuous ? wrap_angle(position)
                                         : std::clamp(position, data.limits.lower - kPositionMargin,
                                                      data.limits.upper + kPositionMargin);
    feedback.position[i] = shown;
    feedback.rate[i] = std::clamp(rate, -kMaxRate, kMaxRate);
    if (data.continuous || shown == position) feedback.quality[i] = JointQuality::kOk;
  }
  send(port, feedback, feedback_[zone]);
}

void FeedbackPublisher::send_zone_pressure(FramePort& port, const Sample& sample,
                                           int zone) noexcept {
  ZonePressure pressure;
  pressure.zone = zone;
  for (int i = 0; i < kMaxZoneJoints; ++i) {
    const int joint = slots_[zone][i];
    if (joint < 0 || !std::isfinite(sample.plant->effort[joint])) continue;
    // The chamber that pushes carries the effort, the other one is at tank pressure.
    const double difference =
        std::clamp(sample.plant->effort[joint] * joints_[joint].pressure_per_effort,
                   -kMaxPressure_pa, kMaxPressure_pa);
    pressure.pressure_a_pa[i] = std::max(0.0, difference);
    pressure.pressure_b_pa[i] = std::max(0.0, -difference);
  }
  send(port, pressure, pressure_[zone]);
}

void FeedbackPublisher::send_zone_status(FramePort& port, const Sample& sample, int zone) noexcept {
  ZoneStatus status;
  status.zone = zone;
  status.mode = sample.status->mode;
  status.fault_bits = sample.status->bits;
  status.challenge = sample.status->challenge;
  status.session = sample.status->session;
  status.last_accepted_counter = (*sample.zones)[zone].last_accepted_counter;
  status.rejected_frames = (*sample.zones)[zone].rejected_frames;
  status.dbc_hash = dbc_hash();
  send(port, status, status_context_[zone]);
}

void FeedbackPublisher::send_base_pose(FramePort& port, const Sample& sample) noexcept {
  BasePose pose;
  pose.sample_time_ms = sample.sample_time_ms;
  pose.quality = JointQuality::kInvalid;
  const PlantState& plant = *sample.plant;
  if (plant.base_pose_valid && plant.base.allFinite() && plant.base_velocity.allFinite()) {
    pose.quality = JointQuality::kOk;
    pose.p_map_base_m = plant.base.head<3>();
    pose.p_map_base_m.head<2>() += map_origin_m_;
    pose.yaw_rad = wrap_angle(plant.base[kBaseYaw]);
    pose.pitch_rad = wrap_angle(plant.base[kBasePitch]);
    pose.roll_rad = wrap_angle(plant.base[kBaseRoll]);
    pose.velocity_m_s = clamped(plant.base_velocity.head<3>(), kMaxVelocity_m_s);
  }
  send(port, pose, base_pose_);
}

void FeedbackPublisher::send_imu(FramePort& port, const Sample& sample) noexcept {
  Imu imu;
  imu.sample_time_ms = sample.sample_time_ms;
  const PlantState& plant = *sample.plant;
  if (plant.base.allFinite() && plant.base_velocity.allFinite()) {
    imu.angular_velocity_rad_s = clamped(plant.base_velocity.tail<3>(), kMaxAngularVelocity_rad_s);
    const Eigen::Vector3d velocity = plant.base_velocity.head<3>();
    Eigen::Vector3d acceleration_world = Eigen::Vector3d::Zero();
    if (has_last_velocity_) acceleration_world = (velocity - last_velocity_) / period_s_;
    acceleration_world.z() += kGravity_m_s2;  // an accelerometer feels what holds it up
    imu.acceleration_m_s2 =
        clamped(T_world_base_from(plant.base).linear().transpose() * acceleration_world,
                kMaxAcceleration_m_s2);
    last_velocity_ = velocity;
    has_last_velocity_ = true;
  }
  send(port, imu, imu_);
}

void FeedbackPublisher::publish(FramePort& port, const Sample& sample) noexcept {
  EStopState estop;
  estop.chain_open = sample.chain_open;
  estop.cause = sample.estop_cause;
  send(port, estop, estop_);
  // Before all that has no stamp of its own: who listens dates that by these.
  send_imu(port, sample);
  send_base_pose(port, sample);
  const bool changed = !(*sample.status == last_status_);
  if (changed || period_ % kPeriodsPerStatus == 0) {
    for (int zone = 0; zone < kNumZones; ++zone) send_zone_status(port, sample, zone);
  }
  last_status_ = *sample.status;
  if (period_ % kPeriodsPerPressure == 0) {
    for (int zone = 0; zone < kNumZones; ++zone) send_zone_pressure(port, sample, zone);
  }
  // Last, so that who waits for the feedback of all zones has everything of this period.
  for (int zone = 0; zone < kNumZones; ++zone) send_zone_feedback(port, sample, zone);
  ++period_;
}

}  // namespace wex::can
