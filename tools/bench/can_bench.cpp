#include "tools/bench/can_bench.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tools/bench/can_bench_parts.hpp"
#include "tools/bench/can_bench_table.hpp"

namespace wex {
namespace {

std::string for_shell(const std::string& word) {
  std::string quoted(1, '\'');
  for (const char c : word) {
    if (c == '\'') {
      quoted.append("'\\''");
    } else {
      quoted.push_back(c);
    }
  }
  quoted.push_back('\'');
  return quoted;
}

struct Ran {
  std::string output;  ///< stdout and stderr
  int exit_code = 127;
};

Ran run(const CanBenchPart& part) {
  std::string line = "env";
  for (const std::string& variable : part.environment) line.append(" ").append(for_shell(variable));
  line.append(" timeout -k 10 ").append(std::to_string(part.timeout_s));
  for (const std::string& word : part.command) line.append(" ").append(for_shell(word));
  line += " 2>&1 </dev/null";
  Ran ran;
  std::FILE* pipe = popen(line.c_str(), "r");
  if (pipe == nullptr) return ran;
  std::array<char, 4096> buffer{};
  while (const std::size_t bytes = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    ran.output.append(buffer.data(), bytes);
  }
  const int status = pclose(pipe);
  if (status >= 0 && WIFEXITED(status)) ran.exit_code = WEXITSTATUS(status);
  return ran;
}

/// Real-time priority, asked for as tools/with_vcan will.
bool real_time_may_be_had() {
  return std::system("chrt -f 20 true 2>/dev/null") == 0;  // NOLINT(cert-env33-c)
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

Result<int> bench_can(const CanBenchOptions& options, std::ostream& out, std::ostream& err) {
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  const std::filesystem::path csv_file =
      options.out / (options.full ? "can_bench_full.csv" : "can_bench.csv");
  const CanBenchSetting setting{
      .full = options.full,
      .real_time = real_time_may_be_had(),
      .only = options.only,
      .build = std::filesystem::read_symlink("/proc/self/exe").parent_path(),
      .source = WEX_SOURCE_DIR};
  const std::vector<CanBenchPart> parts = can_bench_parts(setting);
  if (parts.empty()) {
    return fail(ErrorCode::kBadInput, "--only names no test of the bench; they are T1 to T22");
  }
  std::vector<CanBenchRow> rows;
  if (!options.only.empty()) {
    rows = can_bench_rows_of_csv(text_of(csv_file));
    std::erase_if(rows, [&](const CanBenchRow& row) {
      return std::find(options.only.begin(), options.only.end(), row.test) != options.only.end();
    });
  }
  std::ofstream log(options.out / "log.txt", options.only.empty() ? std::ios::out : std::ios::app);
  if (!log) {
    return fail(ErrorCode::kBadInput, "--out " + options.out.string() + " cannot be written");
  }
  const auto begin = std::chrono::steady_clock::now();
  for (const CanBenchPart& part : parts) {
    const Ran ran = run(part);
    for (const CanBenchRow& row : can_bench_rows(part, ran.output, ran.exit_code)) {
      rows.push_back(row);
    }
    log << "=== " << part.test << " " << part.command.front() << ": exit code " << ran.exit_code
        << "\n"
        << ran.output << std::flush;
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    err << part.test << " done after " << static_cast<int>(passed.count()) << " s" << std::endl;
    std::ofstream(csv_file) << can_bench_csv(rows);  // what is known survives an interruption
  }
  sort_by_test(rows);
  std::ofstream csv(csv_file);
  if (!(csv << can_bench_csv(rows))) {
    return fail(ErrorCode::kBadInput, csv_file.string() + " cannot be written");
  }
  if (!setting.real_time) {
    out << "No right to real-time priority: times are those of a loaded machine, and how late its "
           "processes were is allowed for (stated in the rows).\n";
  }
  out << can_bench_table(rows);
  const bool passed =
      std::all_of(rows.begin(), rows.end(), [](const CanBenchRow& row) { return row.passed; });
  return passed ? 0 : 5;
}

}  // namespace wex
