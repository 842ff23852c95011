#include "tools/bench/can_bench_parts.hpp"

#include <algorithm>
#include <initializer_list>

namespace wex {
namespace {

bool wanted(const CanBenchSetting& setting, const std::string& test) {
  return setting.only.empty() ||
         std::find(setting.only.begin(), setting.only.end(), test) != setting.only.end();
}

constexpr const char* kCountSurvivors =
    "/^#/ || !NF { next } FNR == NR { ++files; next } { ++left; without += !/  # ./ } "
    "END { printf \"%d files, %d survivors recorded, %d of them without a reason\\n\", files, "
    "left, "
    "without; exit without > 0 }";

class Parts {
 public:
  explicit Parts(const CanBenchSetting& setting)
      : tests_((setting.build / "tests/hw_interface").string()),
        source_(setting.source.string()),
        setting_(setting) {}

  /// A test program below tests/hw_interface, or some of its tests.
  void add(const char* test, const char* what, const char* gate, const char* program,
           const char* filter = "*") {
    add({test,
         what,
         gate,
         CanBenchOutput::kGoogleTest,
         {tests_ + "/" + program, std::string("--gtest_filter=") + filter},
         {},
         300});
  }
  /// If it is wanted.
  void add(CanBenchPart part) {
    if (part.output == CanBenchOutput::kFigures || wanted(setting_, part.test)) {
      parts_.push_back(std::move(part));
    }
  }
  [[nodiscard]] const std::string& tests() const { return tests_; }
  [[nodiscard]] const std::string& source() const { return source_; }
  [[nodiscard]] std::vector<CanBenchPart> take() { return std::move(parts_); }

 private:
  std::string tests_, source_;
  const CanBenchSetting& setting_;
  std::vector<CanBenchPart> parts_;
};

/// Faults on a real bus: one boot of User-Mode Linux for all of them, with real-time priority.
void add_on_the_bus(Parts& parts, const CanBenchSetting& setting,
                    std::initializer_list<const char*> tests, int timeout_s) {
  CanBenchPart part;
  part.what = "faults of a real kernel's bus";
  part.output = CanBenchOutput::kFigures;
  part.command = {parts.source() + "/tools/with_vcan", "--faults", "--",
                  (setting.build / "tools/bench/can_faults").string()};
  if (setting.full) part.command.push_back("--full");
  for (const char* test : tests) {
    if (!wanted(setting, test)) continue;
    part.command.push_back(test);
    if (!part.test.empty()) part.test.push_back(' ');
    part.test.append(test);
  }
  if (part.test.empty()) return;
  part.environment = {"WITH_VCAN_TIMEOUT=" + std::to_string(timeout_s)};
  if (setting.real_time) part.environment.push_back("WITH_VCAN_RT=20");
  part.timeout_s = timeout_s + 30;
  parts.add(std::move(part));
}

}  // namespace

std::vector<CanBenchPart> can_bench_parts(const CanBenchSetting& setting) {
  const bool full = setting.full;
  Parts parts(setting);
  const std::string oracle = parts.source() + "/tests/hw_interface/socketcan/codec_oracle.py";
  parts.add({"T1",
             "codec against python cantools, random frames",
             ">= 100,000, 0 mismatches",
             CanBenchOutput::kScript,
             {"env", "PYTHONDONTWRITEBYTECODE=1", "/usr/bin/python3", oracle,
              parts.tests() + "/socketcan/codec_oracle", full ? "200000" : "50000"},
             {},
             900});
  parts.add({"T1",
             "time to pack, unpack, encode, decode a frame, longest of all messages",
             "printed",
             CanBenchOutput::kScript,
             {parts.tests() + "/socketcan/codec_times"},
             {},
             60});
  parts.add("T2", "every signal at and beyond its ends, NaN, infinities", "0 wraps",
            "socketcan/codec_range_test");
  parts.add("T3", "a million random frames into the decoder", "none accepted beyond chance",
            "socketcan/codec_fuzz_test");
  parts.add("T3", "a million random frames into both receivers, some with a right CRC",
            "0 enabled, 0 commands used", "socketcan/receiver_fuzz_test");
  parts.add("T4", "all 1- to 3-bit flips", "all detected", "socketcan/protection_bit_flip_test");
  parts.add("T5", "counter: repeat, skip, reorder, wrap, restart", "verdict table exact",
            "socketcan/protection_test", "SequenceCheck.*");
  if (!full) {
    add_on_the_bus(parts, setting,
                   {"T6", "T7", "T8", "T9", "T10", "T11", "T12", "T13", "T15", "T17", "T18", "T22"},
                   330);
  } else {
    add_on_the_bus(parts, setting, {"T6"}, 600);
    add_on_the_bus(parts, setting, {"T7", "T8", "T9", "T10"}, 500);
    add_on_the_bus(parts, setting, {"T11", "T12"}, 900);
    add_on_the_bus(parts, setting, {"T13"}, 2700);
    add_on_the_bus(parts, setting, {"T15", "T17", "T22"}, 300);
    add_on_the_bus(parts, setting, {"T18"}, 2000);
    parts.add({"T18",
               "a drive over the bus in real time, not in lock step",
               "no fault, stands at its end",
               CanBenchOutput::kGoogleTest,
               {parts.source() + "/tools/with_vcan", "--",
                (setting.build / "tests/end_to_end/can_real_time_test").string()},
               {"WITH_VCAN_RT=20", "WITH_VCAN_TIMEOUT=280"},
               310});
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
  // Mutation takes hours: here only what it left is counted.
  parts.add({"T21",
             "mutation of the safety files (tools/check/mutate_safety_files)",
             "each survivor with its reason",
             CanBenchOutput::kScript,
             {"awk", kCountSurvivors, parts.source() + "/tools/check/safety_files.txt",
              parts.source() + "/tools/check/surviving_mutants.txt"},
             {},
             10});
  parts.add(
      {"T22",
       "both ends and a stopping signal in three threads under ThreadSanitizer",
       "no data race",
       CanBenchOutput::kGoogleTest,
       {"setarch", "-R", (setting.build / "tests/tools/threads/both_ends_threads_test").string()},
       {},
       120});
  return parts.take();
}

}  // namespace wex
