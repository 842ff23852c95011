#include "tools/bench/initializer_bench_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>

#include "tools/bench/drive_bench_table.hpp"

namespace wex {
namespace {

constexpr const char* kHeader =
    "cell,seed,paths,found,first_accepted,accepted,first_s,total_s,first_cost,cost,length_m,"
    "duration_s,"
    "margin_m,lifts,reason\n";

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::vector<const InitializerRow*> rows_of(const std::vector<InitializerRow>& rows,
                                           const std::string& cell) {
  std::vector<const InitializerRow*> own;
  for (const InitializerRow& row : rows) {
    if (row.cell == cell) own.push_back(&row);
  }
  return own;
}

int accepted(const std::vector<const InitializerRow*>& rows) {
  return static_cast<int>(
      std::count_if(rows.begin(), rows.end(), [](const auto* row) { return row->accepted; }));
}

}  // namespace

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], place - static_cast<double>(below));
}

std::string csv_line(const InitializerRow& row) {
  std::string reason = row.reason;
  std::replace(reason.begin(), reason.end(), ',', ';');
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  return row.cell + "," + std::to_string(row.seed) +
         format(",%d,%d,%d,%d,%.4f,%.3f,%.3f,%.3f,%.3f,%.2f,%.3f,%d,", row.paths, row.found,
                row.first_accepted, row.accepted, row.first_s, row.total_s, row.first_cost,
                row.cost, row.length_m, row.duration_s, row.margin_m, row.lifts) +
         reason + "\n";
}

std::optional<InitializerRow> row_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> fields;
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  if (fields.size() == 14) fields.emplace_back();
  if (fields.size() != 15) return std::nullopt;
  InitializerRow row;
  try {
    row.cell = fields[0];
    row.seed = std::stoull(fields[1]);
    row.paths = std::stoi(fields[2]);
    row.found = fields[3] == "1";
    row.first_accepted = fields[4] == "1";
    row.accepted = fields[5] == "1";
    double* const numbers[] = {&row.first_s,  &row.total_s,    &row.first_cost, &row.cost,
                               &row.length_m, &row.duration_s, &row.margin_m};
    for (std::size_t i = 0; i < std::size(numbers); ++i) *numbers[i] = std::stod(fields[6 + i]);
    row.lifts = std::stoi(fields[13]);
    row.reason = fields[14];
  } catch (const std::exception&) {
    return std::nullopt;
  }
  return row;
}

std::string initializer_csv(const std::vector<InitializerRow>& rows) {
  std::string text = kHeader;
  for (const InitializerRow& row : rows) text += csv_line(row);
  return text;
}

std::string initializer_table(const std::vector<InitializerCell>& cells,
                              const std::vector<InitializerRow>& rows) {
  std::string text =
      "cell                    accepted  found  paths   first accepted plan [s]      cost          "
      "path   "
      "duration  lifts  margin\n"
      "                                                 median    95 %     max   first    last     "
      " [m]   "
      "     [s]            [m]\n";
  int pooled = 0, judged = 0;
  for (const InitializerCell& cell : cells) {
    const auto own = rows_of(rows, cell.name);
    if (own.empty()) continue;
    std::vector<double> first_s, first_cost, cost, length_m, duration_s, lifts, margin_m;
    int found = 0, with_path = 0;
    for (const InitializerRow* row : own) {
      found += row->found;
      with_path += row->paths > 0;
      if (!row->accepted) continue;
      first_s.push_back(row->first_s);
      first_cost.push_back(row->first_cost);
      cost.push_back(row->cost);
      length_m.push_back(row->length_m);
      duration_s.push_back(row->duration_s);
      lifts.push_back(row->lifts);
      margin_m.push_back(row->margin_m);
    }
    const int good = accepted(own);
    if (cell.judged) {
      pooled += good;
      judged += static_cast<int>(own.size());
    }
    text +=
        format("%-22s %5d/%-3zu %4d %6d", cell.name.c_str(), good, own.size(), found, with_path);
    if (good > 0) {
      text +=
          format("   %8.3f %7.3f %7.3f  %6.2f  %6.2f  %7.2f  %8.1f  %5.1f  %6.2f",
                 percentile(first_s, 0.5), percentile(first_s, 0.95), percentile(first_s, 1.0),
                 percentile(first_cost, 0.5), percentile(cost, 0.5), percentile(length_m, 0.5),
                 percentile(duration_s, 0.5), percentile(lifts, 0.5), percentile(margin_m, 0.0));
    }
    text += "\n";
  }
  if (judged > 0) {
    const auto [low, high] = wilson_interval(pooled, judged);
    text += format("pooled (judged cells)  %5d/%-4d = %.1f %% (95 %% interval %.1f to %.1f %%)\n",
                   pooled, judged, 100.0 * pooled / judged, 100.0 * low, 100.0 * high);
  }
  std::map<std::string, int> reasons;
  for (const InitializerRow& row : rows) {
    if (!row.accepted)
      ++reasons[row.cell + ", seed " + std::to_string(row.seed) + ": " + row.reason.substr(0, 200)];
  }
  for (const auto& [reason, count] : reasons) text += "  " + reason + "\n";
  return text;
}

bool rates_hold(const std::vector<InitializerCell>& cells,
                const std::vector<InitializerRow>& rows) {
  int pooled = 0, judged = 0;
  bool cells_hold = true;
  for (const InitializerCell& cell : cells) {
    if (!cell.judged) continue;
    const auto own = rows_of(rows, cell.name);
    if (own.empty()) continue;
    const int good = accepted(own);
    pooled += good;
    judged += static_cast<int>(own.size());
    cells_hold = cells_hold && good >= 0.8 * static_cast<double>(own.size());
  }
  return cells_hold && judged > 0 && pooled >= 0.95 * judged;
}

}  // namespace wex
