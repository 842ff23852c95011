#include "tools/check/check_command.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>

namespace wex::check {
namespace {

constexpr int kViolations = 5;

const char* name_of(MotionKind kind) {
  switch (kind) {
    case MotionKind::kPlan:
      return "plan";
    case MotionKind::kRefined:
      return "refined";
    case MotionKind::kExecuted:
      break;
  }
  return "executed";
}

Result<MotionKind> parse_kind(const std::string& text) {
  for (const MotionKind kind : {MotionKind::kPlan, MotionKind::kRefined, MotionKind::kExecuted}) {
    if (text == name_of(kind)) return kind;
  }
  return fail(ErrorCode::kBadInput, "'" + text + "' is none of plan, refined, executed");
}

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[240];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

const char* mark_of(const Finding& finding) {
  if (!finding.binding || !finding.observed) return "";
  return finding.violations > 0 ? "FAILS" : "ok";
}

nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

}  // namespace

std::string check_table(const CheckReport& report, bool all) {
  std::string text = format("%-32s %10s %-6s %13s  %8s %9s %9s  %-22s %s\n", "rule", "worst",
                            "unit", "limit", "t s", "x m", "y m", "of", "");
  for (const Finding& f : report.findings) {
    if (!f.observed && !all) continue;
    const std::string limit =
        !f.binding ? "-" : format("%s %.3g", f.at_least ? "at least" : "at most", f.limit);
    const std::string place =
        f.observed ? format("%8.2f %9.2f %9.2f  %-22s", f.t_s, f.x_m, f.y_m, f.subject.c_str())
                   : std::string("  (nothing is subject to it)");
    text +=
        format("%-32s %10s %-6s %13s  ", f.rule.c_str(),
               f.observed ? format("%.4f", f.worst).c_str() : "-", f.unit.c_str(), limit.c_str()) +
        place + " " + mark_of(f) +
        (f.violations > 0 ? format(" (%d postures)", f.violations) : std::string()) + "\n";
  }
  text +=
      format("%s %s: %d rows, %d postures, %.2f s\n", name_of(report.kind),
             report.accepted ? "accepted" : "refused", report.rows, report.postures, report.cpu_s);
  return text;
}

std::string check_json(const CheckReport& report) {
  nlohmann::json rules = nlohmann::json::array();
  for (const Finding& f : report.findings) {
    nlohmann::json rule{{"rule", f.rule},
                        {"unit", f.unit},
                        {"worst", nullptr},
                        {"limit", f.binding ? number(f.limit) : nlohmann::json(nullptr)},
                        {"tolerance", f.tolerance},
                        {"limit_is", f.at_least ? "least" : "most"},
                        {"violations", f.violations},
                        {"ok", f.violations == 0}};
    if (f.observed) {
      rule["worst"] = number(f.worst);
      rule["at"] = {{"t", f.t_s}, {"x", f.x_m}, {"y", f.y_m}, {"of", f.subject}};
    }
    rules.push_back(std::move(rule));
  }
  return nlohmann::json{{"schema", "wex-check-1"},     {"what", name_of(report.kind)},
                        {"accepted", report.accepted}, {"verdict", report.verdict()},
                        {"rows", report.rows},         {"postures", report.postures},
                        {"cpu_s", report.cpu_s},       {"rules", std::move(rules)}}
             .dump(2) +
         "\n";
}

Result<int> run_check(const CheckOptions& options, std::ostream& out) {
  const Result<MotionKind> kind = parse_kind(options.what);
  if (!kind) return tl::unexpected(kind.error());
  const Result<CheckReport> report = check_plan(options.folder, options.map, *kind);
  if (!report) return tl::unexpected(report.error());
  if (!options.json.empty()) {
    std::ofstream stream(options.json, std::ios::binary);
    if (!(stream << check_json(*report)) || !stream.flush()) {
      return fail(ErrorCode::kBadInput, options.json.string() + ": cannot be written");
    }
  }
  out << check_table(*report, options.all);
  if (!report->accepted) out << report->verdict() << "\n";
  return report->accepted ? 0 : kViolations;
}

}  // namespace wex::check
