#include <atomic>
#include <cstdlib>
#include <new>

#include "hw_interface/mujoco/simulated_machine.hpp"
#include "tests/hw_interface/test_ground.hpp"
#include "tests/support/machine_io_contract.hpp"

namespace {
std::atomic<long> num_allocations{0};
}  // namespace

// Counts what C++ code allocates in this process. Not inlined, or the compiler sees free() meet
// new.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++num_allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace wex {
namespace {

std::shared_ptr<const MachineModel> m545() {
  static const auto machine = std::make_shared<const MachineModel>(load_machine().value());
  return machine;
}

std::unique_ptr<MachineIo> on_flat_ground() {
  return SimulatedMachine::create(*m545(), flat_ground(), standing_on_plane(*m545())).value();
}

const MachineIoSubject kSubject{"Simulated", on_flat_ground, m545()};
INSTANTIATE_TEST_SUITE_P(SimulatedMachine, MachineIoContract, ::testing::Values(kSubject),
                         subject_name);
INSTANTIATE_TEST_SUITE_P(SimulatedMachine, MachineIoMotionContract, ::testing::Values(kSubject),
                         subject_name);

TEST(SimulatedMachineContract, ControlRateCallsDoNotAllocate) {
  const auto io = on_flat_ground();
  JointCommand command;
  command.num_joints = m545()->num_joints();
  command.valid_until_s = 1.0;
  const long before = num_allocations;
  EXPECT_GT(before, 0) << "the count must count";
  MachineState state;
  for (int i = 0; i < 10; ++i) {
    state = io->read();
    io->write(command);
    io->stop();
    io->release();
    static_cast<void>(io->health());
    io->wait_until(state.t_s + 0.01);
  }
  EXPECT_EQ(num_allocations - before, 0);
  EXPECT_GT(state.t_s, 0.0);
}

}  // namespace
}  // namespace wex
