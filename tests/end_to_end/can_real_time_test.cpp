// A drive over a real bus whose clock waits for nobody, judged by the machine's own log. Inside
// User-Mode Linux planner, control loop and simulated machine share one core, of which the kernel
// below takes 50 ms away whenever it was used up for a second (while the plan is made): the machine
// may hold then, for a moment.
#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "models/terrain/raster_io.hpp"
#include "models/terrain/synthetic.hpp"
#include "tests/support/machine_log_file.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace wex {
namespace {

using test::MachineLogFile;
using test::Process;

TEST(CanRealTime, DrivesAndStopsWithoutAFault) {
  const ScratchFolder folder("can_real_time");
  const auto terrain = make_synthetic_terrain("flat", 0.0, 1);
  ASSERT_TRUE(terrain.has_value());
  const std::string map = folder / "map.asc", log = folder / "machine.csv";
  ASSERT_TRUE(write_esri_ascii(terrain->raster, map).has_value());
  Process machine(WEX_PROGRAM, {"machine", map, "--can", "vcan0", "--start", "8,8,0", "--log", log},
                  folder / "machine.txt");
  ASSERT_TRUE(test::wait_for(60.0, [&] {
    return machine.output().find("real time") != std::string::npos;
  })) << machine.output();
  Process host(WEX_PROGRAM,
               {"run", map, "--can", "vcan0", "--goal", "12,8.2,0.05", "--iterations", "300",
                "--frames", "0", "--quiet", "--out", folder / "run"},
               folder / "run.txt");
  const int code = host.wait(150.0);
  machine.send(SIGTERM);
  ASSERT_EQ(machine.wait(20.0), 0) << machine.output();
  std::ifstream stream(folder / "run/result.json");
  const nlohmann::json report = nlohmann::json::parse(stream, nullptr, false);
  ASSERT_TRUE(report.is_object() && report.contains("goal_error_m")) << host.output();
  std::printf("exit code %d, held %d times without being asked to, goal error %.3f m\n", code,
              report["bus"]["false_holds"].get<int>(), report["goal_error_m"].get<double>());
  EXPECT_EQ(report["bus"]["pace"], "real time");
  EXPECT_EQ(report["bus"]["faults"], 0) << report["bus"]["cause"];
  EXPECT_EQ(code, 0) << host.output();

  const MachineLogFile truth(log);
  EXPECT_FALSE(truth.ever("fault"));
  EXPECT_FALSE(truth.ever("estop"));
  const std::size_t last = truth.size() - 1;
  EXPECT_GT(truth.number("base_x", last), 9.0) << "it drove";
  EXPECT_EQ(truth.text("brakes", last), "1");
  EXPECT_LE(truth.ms_until_zero("moving", truth.last_accepted(last), last), 150.0);
  EXPECT_LE(truth.ms_until_zero("travelling", truth.last_accepted(last), last), 150.0);
  EXPECT_NEAR(truth.number("base_x", last), 12.0, 0.3);
  EXPECT_NEAR(truth.number("base_y", last), 8.2, 0.3);
}

}  // namespace
}  // namespace wex
