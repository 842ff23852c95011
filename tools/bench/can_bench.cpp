#include "tools/bench/can_bench.hpp"

#include <sys/wait.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>

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

}  // namespace

Result<int> bench_can(const CanBenchOptions& options, std::ostream& out, std::ostream& err) {
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  std::ofstream log(options.out / "log.txt"), csv(options.out / "can_bench.csv");
  if (!log || !csv) {
    return fail(ErrorCode::kBadInput, "--out " + options.out.string() + " cannot be written");
  }
  const std::filesystem::path build = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const auto begin = std::chrono::steady_clock::now();
  std::vector<CanBenchRow> rows;
  for (const CanBenchPart& part : can_bench_parts(options.full, build, WEX_SOURCE_DIR)) {
    const Ran ran = run(part);
    for (const CanBenchRow& row : can_bench_rows(part, ran.output, ran.exit_code)) {
      rows.push_back(row);
    }
    log << "=== " << part.test << " " << part.command.front() << ": exit code " << ran.exit_code
        << "\n"
        << ran.output << std::flush;
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    err << part.test << " done after " << static_cast<int>(passed.count()) << " s" << std::endl;
  }
  csv << can_bench_csv(rows);
  out << can_bench_table(rows);
  bool all_passed = true;
  for (const CanBenchRow& row : rows) all_passed = all_passed && row.passed;
  return all_passed ? 0 : 5;
}

}  // namespace wex
