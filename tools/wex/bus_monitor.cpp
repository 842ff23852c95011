#include "tools/wex/bus_monitor.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "hw_interface/socketcan/bus_statistics.hpp"

namespace wex::app {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::uint32_t kExtended = 1U << 31;  // above every 29-bit id

template <typename Message>
Result<can::ReceivedMeta, can::CodecError> check_as(const can::CanFrame& frame,
                                                    std::uint32_t session) {
  Message message;
  return can::decode(frame, session, message);
}

Result<can::ReceivedMeta, can::CodecError> check(const can::CanFrame& frame,
                                                 std::uint32_t session) {
  switch (can::kind_of(frame)) {
    case can::MessageKind::kEStopState:
      return check_as<can::EStopState>(frame, 0);
    case can::MessageKind::kHostStop:
      return check_as<can::HostStop>(frame, 0);
    case can::MessageKind::kOperatorCommand:
      return check_as<can::OperatorCommand>(frame, 0);
    case can::MessageKind::kHostHeartbeat:
      return check_as<can::HostHeartbeat>(frame, 0);
    case can::MessageKind::kZoneCommand:
      return check_as<can::ZoneCommand>(frame, session);
    case can::MessageKind::kZoneFeedback:
      return check_as<can::ZoneFeedback>(frame, 0);
    case can::MessageKind::kZonePressure:
      return check_as<can::ZonePressure>(frame, 0);
    case can::MessageKind::kImu:
      return check_as<can::Imu>(frame, 0);
    case can::MessageKind::kBasePose:
      return check_as<can::BasePose>(frame, 0);
    case can::MessageKind::kZoneStatus:
      return check_as<can::ZoneStatus>(frame, 0);
    case can::MessageKind::kLockStep:
      return check_as<can::LockStep>(frame, 0);
    case can::MessageKind::kUnknown:
      break;
  }
  return tl::unexpected(can::CodecError::kUnknownId);
}

/// describe() without the id and the name, which have columns of their own.
std::string values_of(const can::CanFrame& frame, std::uint32_t session) {
  const std::string text = can::describe(frame, session);
  const std::size_t counter = text.find('#');
  return counter == std::string::npos ? text : text.substr(counter);
}

double age_ms(std::int64_t now_ns, std::int64_t last_ns) {
  return 1e-6 * static_cast<double>(now_ns - last_ns);
}

std::string id_text(const can::CanFrame& frame) {
  char text[16];
  std::snprintf(text, sizeof(text), frame.extended ? "0x%08X" : "0x%03X", frame.id);
  return text;
}

}  // namespace

std::uint32_t BusMonitor::session_of(const can::CanFrame& frame) const {
  return can::kind_of(frame) == can::MessageKind::kZoneCommand ? session_ : 0;
}

void BusMonitor::roll(std::int64_t now_ns) {
  if (second_begin_ns_ == 0) second_begin_ns_ = now_ns;
  const std::int64_t passed_ns = now_ns - second_begin_ns_;
  if (passed_ns < kSecond_ns) return;
  // More than a second may have passed without a frame: then the mean over all of it counts.
  const double duration_s = 1e-9 * static_cast<double>(passed_ns);
  const auto close = [duration_s](Rate& rate) {
    rate.last_second = rate.sum / duration_s;
    rate.sum = 0.0;
  };
  for (auto& [id, entry] : entries_) close(entry.rate);
  close(load_);
  close(frame_rate_);
  second_begin_ns_ = now_ns;
}

void BusMonitor::take(const can::CanFrame& frame, std::int64_t now_ns) {
  roll(now_ns);
  if (frame.error) {  // the controller's own report, not a frame of the bus
    ++error_frames_;
    return;
  }
  ++frames_;
  frame_rate_.sum += 1.0;
  load_.sum += can::bus_time_s(frame);
  Entry& entry = entries_[frame.extended ? frame.id | kExtended : frame.id];
  entry.last = frame;
  entry.last_ns = now_ns;
  ++entry.frames;
  entry.rate.sum += 1.0;
  if (can::kind_of(frame) == can::MessageKind::kUnknown) ++foreign_;
  const auto checked = check(frame, session_of(frame));
  if (checked) {
    (void)entry.sequence.update(checked->counter);
    can::ZoneStatus status;
    if (can::decode(frame, 0, status)) session_ = status.session;
  } else if (checked.error() == can::CodecError::kBadCrc) {
    ++entry.crc_errors;
  } else {
    ++entry.refused;
  }
}

std::string BusMonitor::table(std::int64_t now_ns, std::uint32_t dropped, std::size_t max_width) {
  roll(now_ns);
  std::string text;
  const auto add = [&](std::string line) {
    if (max_width > 0 && line.size() > max_width) line.resize(max_width);
    text += line + "\n";
  };
  char line[200];
  std::snprintf(line, sizeof(line),
                "bus load %.0f %%, %.0f frames/s, %ld frames, dropped %u, error frames %ld, "
                "unknown ids %ld",
                100.0 * load_.last_second, frame_rate_.last_second, frames_, dropped, error_frames_,
                foreign_);
  add(line);
  std::snprintf(line, sizeof(line), "%-10s %-16s %8s %8s %6s %6s %8s  %s", "id", "message",
                "rate 1/s", "age ms", "lost", "CRC", "refused", "last values");
  add(line);
  for (const auto& [id, entry] : entries_) {
    std::snprintf(line, sizeof(line), "%-10s %-16s %8.1f %8.0f %6ld %6ld %8ld  ",
                  id_text(entry.last).c_str(), can::name_of(entry.last), entry.rate.last_second,
                  age_ms(now_ns, entry.last_ns), entry.sequence.lost_frames(), entry.crc_errors,
                  entry.refused);
    add(line + values_of(entry.last, session_of(entry.last)));
  }
  return text;
}

std::string BusMonitor::json(std::int64_t now_ns, std::uint32_t dropped) {
  roll(now_ns);
  nlohmann::ordered_json json;
  json["load"] = load_.last_second;
  json["frames_per_s"] = frame_rate_.last_second;
  json["frames"] = frames_;
  json["dropped"] = dropped;
  json["error_frames"] = error_frames_;
  json["unknown_ids"] = foreign_;
  json["messages"] = nlohmann::ordered_json::array();
  for (const auto& [id, entry] : entries_) {
    json["messages"].push_back({{"id", id_text(entry.last)},
                                {"name", can::name_of(entry.last)},
                                {"frames", entry.frames},
                                {"rate_per_s", entry.rate.last_second},
                                {"age_ms", age_ms(now_ns, entry.last_ns)},
                                {"lost", entry.sequence.lost_frames()},
                                {"crc_errors", entry.crc_errors},
                                {"refused", entry.refused},
                                {"values", values_of(entry.last, session_of(entry.last))}});
  }
  return json.dump() + "\n";
}

}  // namespace wex::app
