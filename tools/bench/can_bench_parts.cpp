#include "tools/bench/can_bench_parts.hpp"

namespace wex {
namespace {

class Parts {
 public:
  Parts(const std::filesystem::path& build, const std::filesystem::path& source)
      : tests_((build / "tests/hw_interface").string()), source_(source.string()) {}

  /// A test program below tests/hw_interface, or some of its tests.
  void add(const char* test, const char* what, const char* gate, const char* program,
           const char* filter = "*") {
    parts_.push_back({test,
                      what,
                      gate,
                      CanBenchOutput::kGoogleTest,
                      {tests_ + "/" + program, std::string("--gtest_filter=") + filter},
                      {},
                      300});
  }
  void add(CanBenchPart part) { parts_.push_back(std::move(part)); }
  [[nodiscard]] const std::string& tests() const { return tests_; }
  [[nodiscard]] const std::string& source() const { return source_; }
  [[nodiscard]] std::vector<CanBenchPart> take() { return std::move(parts_); }

 private:
  std::string tests_, source_;
  std::vector<CanBenchPart> parts_;
};

/// Faults on a real bus: one boot of User-Mode Linux for all of them, with real-time priority.
CanBenchPart on_the_bus(const std::filesystem::path& build, const std::string& source,
                        const std::string& tests, bool full, int timeout_s) {
  CanBenchPart part;
  part.test = tests;
  part.what = "faults of a real kernel's bus";
  part.output = CanBenchOutput::kFigures;
  part.command = {source + "/tools/with_vcan", "--faults", "--",
                  (build / "tools/bench/can_faults").string()};
  if (full) part.command.push_back("--full");
  std::string test;
  for (const char c : tests + " ") {
    if (c != ' ') {
      test += c;
    } else {
      part.command.push_back(test);
      test.clear();
    }
  }
  part.environment = {"WITH_VCAN_RT=20", "WITH_VCAN_TIMEOUT=" + std::to_string(timeout_s)};
  part.timeout_s = timeout_s + 30;
  return part;
}

}  // namespace

std::vector<CanBenchPart> can_bench_parts(bool full, const std::filesystem::path& build,
                                          const std::filesystem::path& source) {
  Parts parts(build, source);
  const std::string oracle = parts.source() + "/tests/hw_interface/socketcan/codec_oracle.py";
  parts.add({"T1",
             "codec against python cantools, random frames",
             ">= 100,000, 0 mismatches",
             CanBenchOutput::kScript,
             {"env", "PYTHONDONTWRITEBYTECODE=1", "/usr/bin/python3", oracle,
              parts.tests() + "/socketcan/codec_oracle", full ? "500000" : "50000"},
             {},
             900});
  parts.add("T2", "every signal at and beyond its ends, NaN, infinities", "0 wraps",
            "socketcan/codec_range_test");
  parts.add("T3", "a million random frames", "none accepted beyond chance",
            "socketcan/codec_fuzz_test");
  parts.add("T4", "all 1- to 3-bit flips", "all detected", "socketcan/protection_bit_flip_test");
  parts.add("T5", "counter: repeat, skip, reorder, wrap, restart", "verdict table exact",
            "socketcan/protection_test", "SequenceCheck.*");
  if (!full) {
    parts.add(on_the_bus(build, parts.source(), "T6 T7 T8 T9 T10 T11 T12 T13 T15 T17 T18 T22",
                         false, 300));
  } else {
    parts.add(on_the_bus(build, parts.source(), "T6 T7 T8 T9 T10", true, 1200));
    parts.add(on_the_bus(build, parts.source(), "T11 T12", true, 600));
    parts.add(on_the_bus(build, parts.source(), "T13", true, 2700));
    parts.add(on_the_bus(build, parts.source(), "T15 T17 T22", true, 300));
    parts.add(on_the_bus(build, parts.source(), "T18", true, 2000));
  }
  parts.add("T13", "e-stop 1000 times at random phase, without a bus", "<= 10 ms, latched",
            "electronics/electronics_test", "*EStop*");
  parts.add("T14", "enable handshake: every attack", "never enabled",
            "electronics/electronics_handshake_test");
  parts.add("T16", "limits of both sides on the same vectors", ">= 100,000, equal verdicts",
            "electronics/both_limits_test");
  parts.add("T19", "record, then replay twice", "bit-equal", "replay/replay_machine_test",
            "ReplayOfADrive.*");
  parts.add("T20", "contract suite: simulation", "same outcomes",
            "simulated_machine_contract_test");
  parts.add("T20", "contract suite: electronics behind a pipe", "same outcomes",
            "socketcan/socketcan_machine_contract_test");
  parts.add("T20", "contract suite: replay", "same outcomes", "replay/replay_machine_test",
            "*Contract*");
  parts.add({"T20",
             "contract suite: electronics on a real vcan",
             "same outcomes",
             CanBenchOutput::kGoogleTest,
             {parts.source() + "/tools/with_vcan", "--",
              parts.tests() + "/socketcan/socketcan_machine_vcan_test"},
             {"WITH_VCAN_TIMEOUT=200"},
             230});
  if (full) {
    parts.add({"T21",
               "mutation of the protection (all files: tools/check/mutate_safety_files)",
               "survivors listed",
               CanBenchOutput::kScript,
               {parts.source() + "/tools/check/mutate_safety_files", "socketcan/protection"},
               {},
               1800});
  }
  return parts.take();
}

}  // namespace wex
