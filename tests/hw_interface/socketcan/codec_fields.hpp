#pragma once

#include <array>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "hw_interface/socketcan/codec.hpp"

// Every field of every message under the name that its signal has in wex.dbc, written down a second
// time by hand so that tests do not ask the codec what the codec should do.

namespace wex::can {

inline const std::array<std::vector<std::string>, kNumZones> kZoneJoints{{
    {"LF_HAA", "LF_HFE", "LF_STEER", "LF_WHEEL"},
    {"RF_HAA", "RF_HFE", "RF_STEER", "RF_WHEEL"},
    {"LH_HAA", "LH_HFE", "LH_STEER", "LH_WHEEL", "LH_CLAW"},
    {"RH_HAA", "RH_HFE", "RH_STEER", "RH_WHEEL", "RH_CLAW"},
    {"TURN", "BOOM", "DIPPER", "TELE"},
    {"EE_PITCH", "EE_ROLL", "EE_YAW"},
}};
inline const std::array<std::string, kNumZones> kZoneLabels{"LF", "RF", "LH", "RH", "ARM", "TOOL"};

using AnyMessage = std::variant<ZoneCommand, ZoneFeedback, ZonePressure, ZoneStatus, HostHeartbeat,
                                HostStop, OperatorCommand, EStopState, Imu, BasePose, LockStep>;

/// One field, read and written as a double (exact for every integer of the protocol).
struct Field {
  std::string signal;
  bool is_real;  ///< a double in the message, not an integer, flag or enumeration
  std::function<double()> get;
  std::function<void(double)> set;
};

template <typename T>
Field field(std::string signal, T& value) {
  return {std::move(signal), std::is_floating_point_v<T>,
          [&value] { return static_cast<double>(value); },
          [&value](double wanted) {
            if constexpr (std::is_enum_v<T>) {
              value = static_cast<T>(static_cast<int>(wanted));
            } else {
              value = static_cast<T>(wanted);
            }
          }};
}

inline std::vector<Field> fields(ZoneCommand& m) {
  std::vector<Field> all{field("ValidForMs", m.valid_for_ms), field("EchoTimeMs", m.echo_time_ms)};
  for (std::size_t i = 0; i < kZoneJoints.at(m.zone).size(); ++i) {
    all.push_back(field(kZoneJoints[m.zone][i] + "_Rate", m.rate[i]));
    all.push_back(field(kZoneJoints[m.zone][i] + "_Active", m.active[i]));
  }
  return all;
}

inline std::vector<Field> fields(ZoneFeedback& m) {
  std::vector<Field> all{field("SampleTimeMs", m.sample_time_ms)};
  for (std::size_t i = 0; i < kZoneJoints.at(m.zone).size(); ++i) {
    all.push_back(field(kZoneJoints[m.zone][i] + "_Position", m.position[i]));
    all.push_back(field(kZoneJoints[m.zone][i] + "_Rate", m.rate[i]));
    all.push_back(field(kZoneJoints[m.zone][i] + "_Spool", m.spool[i]));
    all.push_back(field(kZoneJoints[m.zone][i] + "_Quality", m.quality[i]));
  }
  return all;
}

inline std::vector<Field> fields(ZonePressure& m) {
  std::vector<Field> all;
  for (std::size_t i = 0; i < kZoneJoints.at(m.zone).size(); ++i) {
    all.push_back(field(kZoneJoints[m.zone][i] + "_PressureA", m.pressure_a_pa[i]));
    all.push_back(field(kZoneJoints[m.zone][i] + "_PressureB", m.pressure_b_pa[i]));
  }
  return all;
}

inline std::vector<Field> fields(ZoneStatus& m) {
  return {field("Mode", m.mode),
          field("FaultBits", m.fault_bits),
          field("LastAcceptedCounter", m.last_accepted_counter),
          field("RejectedFrames", m.rejected_frames),
          field("Challenge", m.challenge),
          field("Session", m.session),
          field("DbcHash", m.dbc_hash)};
}

inline std::vector<Field> fields(HostHeartbeat& m) {
  return {field("Session", m.session), field("Request", m.request), field("Nonce", m.nonce),
          field("ChallengeEcho", m.challenge_echo), field("DbcHash", m.dbc_hash)};
}

inline std::vector<Field> fields(HostStop& m) {
  return {field("Active", m.active), field("Cause", m.cause)};
}

inline std::vector<Field> fields(OperatorCommand& m) { return {field("Action", m.action)}; }

inline std::vector<Field> fields(EStopState& m) {
  return {field("ChainOpen", m.chain_open), field("Cause", m.cause)};
}

inline void add_vector(std::vector<Field>& all, const std::string& name, Eigen::Vector3d& v) {
  for (int i = 0; i < 3; ++i) all.push_back(field(name + "XYZ"[i], v[i]));
}

inline std::vector<Field> fields(Imu& m) {
  std::vector<Field> all{field("SampleTimeMs", m.sample_time_ms)};
  add_vector(all, "AngularVelocity", m.angular_velocity_rad_s);
  add_vector(all, "Acceleration", m.acceleration_m_s2);
  return all;
}

inline std::vector<Field> fields(BasePose& m) {
  std::vector<Field> all{field("SampleTimeMs", m.sample_time_ms), field("Quality", m.quality),
                         field("Yaw", m.yaw_rad), field("Pitch", m.pitch_rad),
                         field("Roll", m.roll_rad)};
  add_vector(all, "Position", m.p_map_base_m);
  add_vector(all, "Velocity", m.velocity_m_s);
  return all;
}

inline std::vector<Field> fields(LockStep& m) { return {field("RunUntilMs", m.run_until_ms)}; }

/// The returned fields refer to `message`.
inline std::vector<Field> fields(AnyMessage& message) {
  return std::visit([](auto& m) { return fields(m); }, message);
}

/// One message of every name in wex.dbc, by that name. Values all zero; qualities kOk.
inline std::vector<std::pair<std::string, AnyMessage>> every_message() {
  BasePose pose;
  pose.quality = JointQuality::kOk;
  std::vector<std::pair<std::string, AnyMessage>> all{{"HostHeartbeat", HostHeartbeat{}},
                                                      {"HostStop", HostStop{}},
                                                      {"OperatorCommand", OperatorCommand{}},
                                                      {"EStopState", EStopState{}},
                                                      {"Imu", Imu{}},
                                                      {"BasePose", pose},
                                                      {"LockStep", LockStep{}}};
  for (int zone = 0; zone < kNumZones; ++zone) {
    ZoneCommand command;
    ZoneFeedback feedback;
    ZonePressure pressure;
    ZoneStatus status;
    command.zone = feedback.zone = pressure.zone = status.zone = zone;
    all.emplace_back("ZoneCommand" + kZoneLabels[zone], command);
    all.emplace_back("ZoneFeedback" + kZoneLabels[zone], feedback);
    all.emplace_back("ZonePressure" + kZoneLabels[zone], pressure);
    all.emplace_back("ZoneStatus" + kZoneLabels[zone], status);
  }
  return all;
}

inline Result<void, CodecError> encode_any(const AnyMessage& message, SendContext& context,
                                           CanFrame& frame) {
  return std::visit([&](const auto& m) { return encode(m, context, frame); }, message);
}

/// Decodes into the type that `message` holds.
inline Result<ReceivedMeta, CodecError> decode_any(const CanFrame& frame, std::uint32_t session,
                                                   AnyMessage& message) {
  return std::visit([&](auto& m) { return decode(frame, session, m); }, message);
}

}  // namespace wex::can
