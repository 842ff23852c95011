#include "tools/wex/bus_report.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace wex::app {
namespace {

using Json = nlohmann::ordered_json;

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json messages_json(const can::BusStatistics& statistics) {
  Json json = Json::object();
  for (int i = 0; i < can::kNumMessageKinds; ++i) {
    const auto kind = static_cast<can::MessageKind>(i);
    const can::BusStatistics::Message& message = statistics.of(kind);
    if (message.sent == 0 && message.received == 0 && message.lost == 0) continue;
    json[can::name_of(kind)] = {
        {"sent", message.sent}, {"received", message.received}, {"lost", message.lost}};
  }
  return json;
}

Json latency_json(const can::LatencyHistogram& histogram) {
  constexpr double kMedian = 0.5, kTail = 0.99;
  Json json{{"p50", histogram.percentile_ms(kMedian)},
            {"p99", histogram.percentile_ms(kTail)},
            {"max", histogram.max_ms()}};
  json["upper_edges"] = can::LatencyHistogram::kEdges_ms;
  json["counts"] = histogram.bins();
  return json;
}

}  // namespace

const char* name_of(can::HostPhase phase) noexcept {
  switch (phase) {
    case can::HostPhase::kUnconfigured:
      return "not heard completely";
    case can::HostPhase::kInactive:
      return "inactive";
    case can::HostPhase::kAsking:
      return "asking to be enabled";
    case can::HostPhase::kProving:
      return "proving to be bumpless";
    case can::HostPhase::kActive:
      return "active";
    case can::HostPhase::kHold:
      return "hold";
    case can::HostPhase::kFault:
      return "fault";
    case can::HostPhase::kEStop:
      break;
  }
  return "e-stop";
}

BusReport bus_report(const std::string& interface_name, bool lock_step,
                     const can::SocketCanMachine& machine) {
  BusReport report;
  report.interface_name = interface_name;
  report.lock_step = lock_step;
  report.end_state = name_of(machine.phase());
  if (machine.cause() != can::HostCause::kNone) report.cause = can::describe(machine.cause());
  report.statistics = machine.statistics();
  return report;
}

Json bus_json(const BusReport& report) {
  const can::BusStatistics& s = report.statistics;
  return {{"interface", report.interface_name},
          {"pace", report.lock_step ? "lock step" : "real time"},
          {"end_state", report.end_state},
          {"cause", text_or_null(report.cause)},
          {"log", text_or_null(report.log)},
          {"load", s.bus_load},
          {"max_load", s.max_bus_load},
          {"load_machine_time",
           report.machine_s > 0.0 ? Json(s.busy_s / report.machine_s) : Json(nullptr)},
          {"messages", messages_json(s)},
          {"frames_sent", s.frames_sent()},
          {"frames_received", s.frames_received()},
          {"frames_lost", s.frames_lost()},
          {"repeated", s.repeated},
          {"wrong_sequence", s.wrong_sequence},
          {"crc_errors", s.crc_errors},
          {"malformed", s.malformed},
          {"unknown_ids", s.unknown},
          {"own_ids", s.own_ids},
          {"error_frames", s.error_frames},
          {"receive_overflows", s.receive_overflows},
          {"not_taken", s.not_taken},
          {"stalls", s.stalls},
          {"purges", s.purges},
          {"reopens", s.reopens},
          {"false_holds", s.holds},
          {"faults", s.faults},
          {"rates_limited", s.rates_limited},
          {"refused_by_codec", s.refused_by_codec},
          {"max_feedback_age_s", s.max_feedback_age_s},
          {"max_status_age_s", s.max_status_age_s},
          {"command_to_report_ms", latency_json(s.command_to_report)}};
}

}  // namespace wex::app
