#include "tools/bench/can_bench_table.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace wex {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

bool starts_with(const std::string& line, const char* begin) { return line.rfind(begin, 0) == 0; }

/// The exit codes that tools/with_vcan and timeout give a meaning to.
std::string reason_of(const std::string& output, int exit_code) {
  if (exit_code == 124) return "out of time";
  const std::vector<std::string> lines = split(output, '\n');
  const std::string last = lines.empty() ? "no output" : lines.back();
  return "exit code " + std::to_string(exit_code) + ", " + last;
}

std::vector<CanBenchRow> figure_rows(const CanBenchPart& part, const std::string& output,
                                     int exit_code) {
  std::vector<CanBenchRow> rows;
  for (const std::string& line : split(output, '\n')) {
    const std::vector<std::string> fields = split(line, '\t');
    if (fields.size() != 6 || fields[0] != "FIGURE") continue;
    rows.push_back({fields[1], fields[2], fields[3], fields[4], fields[5] == "pass"});
  }
  for (const std::string& test : split(part.test, ' ')) {
    const bool there = std::any_of(rows.begin(), rows.end(),
                                   [&](const CanBenchRow& row) { return row.test == test; });
    if (!there) {
      rows.push_back(
          {test, part.what, "not run: " + reason_of(output, exit_code), part.gate, false});
    }
  }
  return rows;
}

/// What a test program says beside GoogleTest's own lines, and how many tests passed.
CanBenchRow google_test_row(const CanBenchPart& part, const std::string& output, int exit_code) {
  CanBenchRow row{part.test, part.what, "", part.gate, false};
  int passed = 0;
  std::string failed;
  for (const std::string& line : split(output, '\n')) {
    if (starts_with(line, "[       OK ]")) {
      ++passed;
    } else if (starts_with(line, "[  FAILED  ]") && line.find(" ms)") != std::string::npos) {
      failed += (failed.empty() ? "failed: " : ", ") + split(line.substr(13), ' ').front();
    } else if (starts_with(line, "[  SKIPPED ]")) {
      failed += (failed.empty() ? "skipped: " : ", ") + line.substr(13);
    } else if (!line.empty() && line[0] != '[' && !starts_with(line, "Running main") &&
               !starts_with(line, "Note: Google Test filter") && failed.empty()) {
      row.figure += line + "; ";
    }
  }
  row.passed = exit_code == 0 && passed > 0 && failed.empty();
  row.figure += std::to_string(passed) + (passed == 1 ? " test passed" : " tests passed");
  if (!failed.empty()) row.figure = failed;
  if (passed == 0 && failed.empty()) row.figure = "not run: " + reason_of(output, exit_code);
  return row;
}

CanBenchRow script_row(const CanBenchPart& part, const std::string& output, int exit_code) {
  const std::vector<std::string> lines = split(output, '\n');
  const bool passed = exit_code == 0 && !lines.empty();
  return {part.test, part.what, passed ? lines.back() : "not run: " + reason_of(output, exit_code),
          part.gate, passed};
}

std::string quoted(std::string text) {
  std::replace(text.begin(), text.end(), '"', '\'');
  return "\"" + text + "\"";
}

/// Breaks at blanks, each line indented.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t width) {
  std::string result, line(indent, ' ');
  for (const std::string& word : split(text, ' ')) {
    if (line.size() > indent && line.size() + 1 + word.size() > width) {
      result += line + "\n";
      line.assign(indent, ' ');
    }
    line += (line.size() > indent ? " " : "") + word;
  }
  return result + line + "\n";
}

}  // namespace

std::vector<CanBenchRow> can_bench_rows(const CanBenchPart& part, const std::string& output,
                                        int exit_code) {
  switch (part.output) {
    case CanBenchOutput::kFigures:
      return figure_rows(part, output, exit_code);
    case CanBenchOutput::kGoogleTest:
      return {google_test_row(part, output, exit_code)};
    case CanBenchOutput::kScript:
      return {script_row(part, output, exit_code)};
  }
  return {};
}

std::string can_bench_table(const std::vector<CanBenchRow>& rows) {
  constexpr std::size_t kIndent = 11, kWidth = 110;
  std::string table;
  int failed = 0;
  for (const CanBenchRow& row : rows) {
    std::string head = row.test + std::string(row.test.size() < 4 ? 4 - row.test.size() : 0, ' ') +
                       (row.passed ? "  pass " : "  FAIL ") + row.what;
    if (!row.gate.empty()) head += "  [" + row.gate + "]";
    table += head + "\n" + wrapped(row.figure, kIndent, kWidth);
    failed += !row.passed;
  }
  return table + std::to_string(rows.size() - static_cast<std::size_t>(failed)) + " passed, " +
         std::to_string(failed) + " failed\n";
}

std::string can_bench_csv(const std::vector<CanBenchRow>& rows) {
  std::string csv = "test,what,figure,gate,verdict\n";
  for (const CanBenchRow& row : rows) {
    csv += row.test + "," + quoted(row.what) + "," + quoted(row.figure) + "," + quoted(row.gate) +
           (row.passed ? ",pass\n" : ",fail\n");
  }
  return csv;
}

std::vector<CanBenchRow> can_bench_rows_of_csv(const std::string& csv) {
  std::vector<CanBenchRow> rows;
  for (const std::string& line : split(csv, '\n')) {
    const std::vector<std::string> fields = split(line, '"');  // none of them contains one
    if (fields.size() != 7 || fields[0].size() < 2) continue;
    rows.push_back({fields[0].substr(0, fields[0].size() - 1), fields[1], fields[3], fields[5],
                    fields[6] == ",pass"});
  }
  return rows;
}

void sort_by_test(std::vector<CanBenchRow>& rows) {
  const auto number = [](const CanBenchRow& row) { return std::atoi(row.test.c_str() + 1); };
  std::stable_sort(rows.begin(), rows.end(), [&](const CanBenchRow& a, const CanBenchRow& b) {
    return number(a) < number(b);
  });
}

}  // namespace wex
