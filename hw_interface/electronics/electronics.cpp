#include "hw_interface/electronics/electronics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wex::can {
namespace {

void add_saturating(std::uint16_t& count) noexcept {
  if (count < 0xFFFF) ++count;
}

/// Frames that only the electronics, the safety controller and the localisation unit may send.
bool is_own(MessageKind kind) noexcept {
  switch (kind) {
    case MessageKind::kEStopState:
    case MessageKind::kZoneFeedback:
    case MessageKind::kZonePressure:
    case MessageKind::kImu:
    case MessageKind::kBasePose:
    case MessageKind::kZoneStatus:
      return true;
    default:
      return false;
  }
}

SlotRole role_of(const MachineModel& machine, int joint) {
  if (machine.joints[joint].role == JointRole::kWheel) return SlotRole::kWheel;
  const bool is_turn = machine.arm && !machine.arm->coordinates.empty() &&
                       machine.arm->coordinates.front() == kNumBaseCoordinates + joint;
  return is_turn ? SlotRole::kSwing : SlotRole::kCylinder;
}

}  // namespace

long ElectronicsCounters::commands_rejected() const noexcept {
  long sum = other_session + not_enabled + sequence_errors + crc_errors;
  for (const long count : limits) sum += count;
  return sum;
}

bool Electronics::Stream::in_order(std::uint8_t counter, int silence_ms,
                                   std::int64_t now_ms) noexcept {
  if (now_ms - last_ms > silence_ms) check.reset();
  const int missing =
      SequenceCheck::missing_after(static_cast<double>(now_ms - last_ms), period_ms);
  last_ms = now_ms;
  const SequenceVerdict verdict = check.update(counter, missing);
  return verdict != SequenceVerdict::kRepeated && verdict != SequenceVerdict::kWrongSequence &&
         check.trusted();
}

Result<std::unique_ptr<Electronics>> Electronics::create(const MachineModel& machine, Plant& plant,
                                                         FramePort& port, RandomSource& random,
                                                         const ElectronicsSettings& settings) {
  WEX_EXPECTS(machine.num_joints() <= kMaxJoints);
  SlotMap slots;
  for (auto& zone : slots) zone.fill(-1);
  for (int joint = 0; joint < machine.num_joints(); ++joint) {
    const std::string& name = machine.joints[joint].name;
    const JointSlot slot = slot_of(name);
    if (slot.zone < 0) {
      return fail(ErrorCode::kBadInput, "joint '" + name + "' of machine '" + machine.name +
                                            "' is none of those that wex.dbc has a signal for");
    }
    slots[slot.zone][slot.index] = joint;
  }
  return std::unique_ptr<Electronics>(
      new Electronics(machine, slots, plant, port, random, settings));
}

Electronics::Electronics(const MachineModel& machine, const SlotMap& slots, Plant& plant,
                         FramePort& port, RandomSource& random, const ElectronicsSettings& settings)
    : slots_(slots),
      plant_(&plant),
      port_(&port),
      settings_(settings),
      automaton_(dbc_hash(), random, settings.automaton),
      publisher_(machine, slots, settings.map_origin_m, settings.zones.period_s) {
  ZoneControllerSettings control = settings.zones;
  control.dead_band = machine.valve_dead_band;
  for (int zone = 0; zone < kNumZones; ++zone) {
    ZoneController::Roles roles{};
    std::array<SlotLimits, kMaxZoneJoints> limits{};
    std::array<bool, kMaxZoneJoints> is_wheel{};
    for (int i = 0; i < kMaxZoneJoints; ++i) {
      const int joint = slots_[zone][i];
      if (joint < 0) continue;
      roles[i] = role_of(machine, joint);
      limits[i] = limits_of({zone, i});
      is_wheel[i] = roles[i] == SlotRole::kWheel;
    }
    zones_.push_back({ZoneController(roles, limits, control),
                      MachineLimits(limits, is_wheel, settings.limits),
                      Stream{MessageKind::kZoneCommand}, ZoneReport{}});
  }
  for (int leg = 0; leg < kNumWheels; ++leg) {
    const WheeledLeg& wheeled_leg = machine.legs[leg];
    const std::string& name = machine.joints[wheeled_leg.wheel - kNumBaseCoordinates].name;
    wheels_[leg] = {slot_of(name), wheeled_leg.wheel_sign * wheeled_leg.radius_m};
  }
  sense();
}

void Electronics::set_estop_chain(bool open, std::uint8_t cause) noexcept {
  chain_open_ = open;
  estop_cause_ = open ? cause : 0;
}

std::optional<std::uint32_t> Electronics::take_lock_step() noexcept {
  return std::exchange(lock_step_, std::nullopt);
}

bool Electronics::brakes_closed() const noexcept {
  return std::all_of(zones_.begin(), zones_.end(),
                     [](const Zone& zone) { return zone.controller.brakes_closed(); });
}

void Electronics::count_codec_error(CodecError error, std::int64_t now_ms) noexcept {
  if (error == CodecError::kBadCrc) {
    ++counters_.crc_errors;
    automaton_.on_crc_error(now_ms);
  } else {
    ++counters_.malformed;
  }
}

template <typename Message>
bool Electronics::take(const CanFrame& frame, Stream& stream, int silence_ms, Message& message,
                       std::int64_t now_ms) noexcept {
  const auto meta = decode(frame, 0, message);
  if (!meta) {
    count_codec_error(meta.error(), now_ms);
    return false;
  }
  if (stream.in_order(meta->counter, silence_ms, now_ms)) return true;
  ++counters_.sequence_errors;
  return false;
}

void Electronics::handle(const CanFrame& frame, std::int64_t now_ms) noexcept {
  ++counters_.frames;
  const MessageKind kind = kind_of(frame);
  switch (kind) {
    case MessageKind::kZoneCommand:
      handle_command(frame, now_ms);
      return;
    case MessageKind::kHostHeartbeat: {
      HostHeartbeat heartbeat;
      if (take(frame, heartbeat_, settings_.silence_ms, heartbeat, now_ms)) {
        automaton_.on_heartbeat(heartbeat, now_ms);
      }
      return;
    }
    case MessageKind::kHostStop: {
      HostStop stop;
      if (take(frame, host_stop_, settings_.silence_ms, stop, now_ms)) {
        automaton_.on_host_stop(stop, now_ms);
      }
      return;
    }
    case MessageKind::kOperatorCommand:
      handle_operator(frame, now_ms);
      return;
    case MessageKind::kLockStep: {
      LockStep step;
      if (settings_.lock_step && decode(frame, 0, step)) {
        lock_step_ = step.run_until_ms;
      } else {
        ++counters_.malformed;
      }
      return;
    }
    default:
      ++counters_.malformed;
      if (is_own(kind)) automaton_.on_masquerade(now_ms);
  }
}

void Electronics::handle_operator(const CanFrame& frame, std::int64_t now_ms) noexcept {
  OperatorCommand command;
  const auto meta = decode(frame, 0, command);
  if (!meta) {
    count_codec_error(meta.error(), now_ms);
    return;
  }
  // A stop is a stop, whatever its counter says.
  if (operator_.in_order(meta->counter, settings_.operator_silence_ms, now_ms) ||
      command.action == OperatorAction::kStop) {
    automaton_.on_operator(command, now_ms);
  } else {
    ++counters_.sequence_errors;
  }
}

void Electronics::reject(int zone) noexcept {
  add_saturating(zones_[zone].report.rejected_frames);
  automaton_.on_bad_command(zone);
}

void Electronics::handle_command(const CanFrame& frame, std::int64_t now_ms) noexcept {
  const int id_zone = zone_of(frame);
  if (session_ == 0) {
    ++counters_.not_enabled;
    reject(id_zone);
    return;
  }
  ZoneCommand command;
  const auto meta = decode(frame, session_, command);
  if (!meta) {
    reject(id_zone);
    ZoneCommand other;
    if (meta.error() == CodecError::kBadCrc &&
        (decode(frame, previous_session_, other) || decode(frame, 0, other))) {
      ++counters_.other_session;  // intact, but from before: an old queue, or a host that is late
    } else if (meta.error() == CodecError::kOutOfRange) {
      ++counters_.limits[static_cast<std::size_t>(LimitVerdict::kRate)];
      automaton_.on_range_reject(now_ms);
    } else {
      count_codec_error(meta.error(), now_ms);
    }
    return;
  }
  if (!zones_[id_zone].stream.in_order(meta->counter, settings_.silence_ms, now_ms)) {
    ++counters_.sequence_errors;
    reject(id_zone);
  } else if (judge_command(command, now_ms)) {
    zones_[id_zone].report.last_accepted_counter = meta->counter;
  } else {
    reject(id_zone);
  }
}

bool Electronics::judge_command(const ZoneCommand& command, std::int64_t now_ms) noexcept {
  Zone& zone = zones_[command.zone];
  const bool enabled = automaton_.mode() == MachineMode::kEnabled;
  const LimitVerdict verdict = enabled ? zone.limits.judge(command, zone.position, now_ms)
                                       : zone.limits.judge_echo(command.echo_time_ms, now_ms);
  if (verdict != LimitVerdict::kOk) {
    ++counters_.limits[static_cast<std::size_t>(verdict)];
    if (verdict != LimitVerdict::kStaleEcho) automaton_.on_range_reject(now_ms);
    return false;
  }
  automaton_.on_good_command(command.zone, is_neutral(command, settings_.neutral_rate), now_ms);
  if (enabled) {
    zone.limits.accept(command, now_ms);
    watchdog_.accept(command, now_ms);
    ++counters_.commands_accepted;
  } else {
    ++counters_.commands_bumpless;
  }
  return true;
}

void Electronics::follow_automaton(std::int64_t now_ms) noexcept {
  if (automaton_.session() != session_) {
    if (session_ != 0) previous_session_ = session_;
    session_ = automaton_.session();
    for (Zone& zone : zones_) zone.stream.check.reset();
  }
  if (automaton_.mode() != last_mode_) {
    // Whatever was asked before counts no more, and rates start again from zero.
    last_mode_ = automaton_.mode();
    watchdog_.clear();
    for (Zone& zone : zones_) zone.limits.reset(now_ms);
  }
}

void Electronics::receive(std::int64_t now_ms) noexcept {
  constexpr double kMsPerS = 1e3;
  const auto period_ms = std::llround(kMsPerS * settings_.zones.period_s);
  take_all(settings_.lock_step ? now_ms + period_ms : now_ms);
}

void Electronics::take_all(std::int64_t now_ms) noexcept {
  CanFrame frame;
  while ((receive_status_ = port_->receive(frame)) == SocketStatus::kOk) {
    handle(frame, now_ms);
    follow_automaton(now_ms);
  }
}

void Electronics::sense() noexcept {
  state_ = plant_->sense();
  for (int z = 0; z < kNumZones; ++z) {
    for (int i = 0; i < kMaxZoneJoints; ++i) {
      const int joint = slots_[z][i];
      if (joint < 0) continue;
      zones_[z].position[i] = state_.position[joint];
      zones_[z].rate[i] = state_.rate[joint];
    }
  }
}

double Electronics::wheel_share(std::int64_t now_ms) const noexcept {
  double travel_m_s = 0.0;
  for (const Wheel& wheel : wheels_) {
    const ZoneCommand* command = watchdog_.in_force(wheel.slot.zone, now_ms);
    if (command == nullptr || !command->active[wheel.slot.index]) continue;
    travel_m_s += wheel.way_per_rad_m * command->rate[wheel.slot.index] / kNumWheels;
  }
  return settings_.travel.share_of(travel_m_s, state_.base[kBasePitch], state_.base[kBaseRoll]);
}

double Electronics::swing_share(std::int64_t now_ms) const noexcept {
  const ZoneCommand* command = watchdog_.in_force(turn_.zone, now_ms);
  if (command == nullptr) return 1.0;
  const double asked = std::abs(command->rate[turn_.index]);
  const auto of = [this](std::array<double, kMaxZoneJoints> Zone::* what, JointSlot slot) {
    return (zones_[slot.zone].*what)[slot.index];
  };
  const auto pick = [&](std::array<double, kMaxZoneJoints> Zone::* what) {
    return ReachingJoints{of(what, boom_), of(what, dipper_), of(what, tele_), of(what, ee_pitch_)};
  };
  const double limit = settings_.slew.at(pick(&Zone::position), pick(&Zone::rate),
                                         tilt_of(state_.base[kBasePitch], state_.base[kBaseRoll]));
  return asked > limit ? limit / asked : 1.0;
}

void Electronics::act(std::int64_t now_ms) noexcept {
  const bool enabled = automaton_.mode() == MachineMode::kEnabled;
  const double of_wheels = wheel_share(now_ms), of_swing = swing_share(now_ms);
  for (int z = 0; z < kNumZones; ++z) {
    Zone& zone = zones_[z];
    const ZoneOutput& output =
        zone.controller.update(enabled ? watchdog_.in_force(z, now_ms) : nullptr, zone.position,
                               zone.rate, of_wheels, of_swing);
    for (int i = 0; i < kMaxZoneJoints; ++i) {
      const int joint = slots_[z][i];
      if (joint < 0) continue;
      input_.spool[joint] = output.spool[i];
      input_.wheel_rate[joint] = output.wheel_rate[i];
      input_.braked[joint] = output.brake[i];
    }
  }
  input_.motion_released = enabled;
  plant_->act(input_);
}

void Electronics::tick(std::int64_t now_ms) noexcept {
  take_all(now_ms);
  const SelfCheck check{
      .sensors_valid = state_.sensors_valid,
      .base_pose_valid = state_.base_pose_valid,
      .valves_neutral = std::all_of(zones_.begin(), zones_.end(),
                                    [](const Zone& z) { return z.controller.neutral(); }),
      .estop_chain_open = chain_open_};
  automaton_.step(check, now_ms);
  follow_automaton(now_ms);
  act(now_ms);
  sense();

  const StatusReport status{automaton_.mode(),
                            static_cast<std::uint16_t>(automaton_.fault_bits() |
                                                       (settings_.lock_step ? kInfoLockStep : 0)),
                            automaton_.challenge(), automaton_.session()};
  std::array<ZoneReport, kNumZones> reports;
  for (int z = 0; z < kNumZones; ++z) reports[z] = zones_[z].report;
  publisher_.publish(*port_, {.plant = &state_,
                              .input = &input_,
                              .status = &status,
                              .zones = &reports,
                              .chain_open = chain_open_,
                              .estop_cause = estop_cause_,
                              .sample_time_ms = static_cast<std::uint32_t>(now_ms)});
}

}  // namespace wex::can
