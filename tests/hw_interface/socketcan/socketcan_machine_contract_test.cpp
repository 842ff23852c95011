#include <atomic>
#include <cstdlib>
#include <new>

#include "hw_interface/mujoco/simulated_plant.hpp"
#include "tests/hw_interface/test_ground.hpp"
#include "tests/support/host_bench.hpp"
#include "tests/support/machine_io_contract.hpp"
#include "tests/support/scratch_folder.hpp"

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

namespace wex::can {
namespace {

/// A host together with all that it needs: the MuJoCo machine behind its electronics, a pipe.
class CompleteMachine final : public MachineIo {
 public:
  CompleteMachine()
      : plant_(SimulatedPlant::create(bench_machine(), flat_ground(),
                                      standing_on_plane(bench_machine()))
                   .value()),
        far_(bench_machine(), *plant_, pipe_, clock_, true, 1) {
    EXPECT_TRUE(plant_->settle());
    host_ = SocketCanMachine::open_on(pipe_.host(), clock_, bench_machine(), {0.0, 0.0}).value();
    const auto activated = host_->activate();
    EXPECT_TRUE(activated) << activated.error().message;
  }
  MachineState read() noexcept override { return host_->read(); }
  WriteOutcome write(const JointCommand& command) noexcept override {
    return host_->write(command);
  }
  void stop() noexcept override { host_->stop(); }
  void release() noexcept override { host_->release(); }
  MachineHealth health() const noexcept override { return host_->health(); }
  void wait_until(double t_s) override { host_->wait_until(t_s); }
  Lifecycle lifecycle() const noexcept override { return host_->lifecycle(); }
  Result<void> activate() override { return host_->activate(); }
  void deactivate() noexcept override { host_->deactivate(); }

 private:
  ManualClock clock_;
  FramePipe pipe_;
  std::unique_ptr<SimulatedPlant> plant_;
  FarEnd far_;
  std::unique_ptr<SocketCanMachine> host_;
};

const MachineIoSubject kSubject{
    "OnTheBus", [] { return std::make_unique<CompleteMachine>(); },
    std::shared_ptr<const MachineModel>(&bench_machine(), [](const MachineModel*) {})};
INSTANTIATE_TEST_SUITE_P(SocketCanMachine, MachineIoContract, ::testing::Values(kSubject),
                         subject_name);
INSTANTIATE_TEST_SUITE_P(SocketCanMachine, MachineIoMotionContract, ::testing::Values(kSubject),
                         subject_name);

/// Gives prepared frames, takes everything, allocates nothing.
class PreparedPort final : public FramePort {
 public:
  SocketStatus send(const CanFrame&) noexcept override {
    ++sent;
    return SocketStatus::kOk;
  }
  SocketStatus receive(CanFrame& frame) noexcept override {
    if (next == end) return SocketStatus::kWouldBlock;
    frame = frames[next++];
    return SocketStatus::kOk;
  }
  SocketStatus wait_readable(double) noexcept override { return SocketStatus::kOk; }
  SocketStatus reopen() noexcept override { return SocketStatus::kOk; }
  bool purge() noexcept override { return false; }
  std::uint32_t dropped() const noexcept override { return 0; }

  std::vector<CanFrame> frames;
  std::size_t next = 0, end = 0;
  long sent = 0;
};

TEST(SocketCanMachineContract, ControlRateCallsDoNotAllocate) {
  constexpr std::size_t kFramesPerCycle = 20;
  PreparedPort port;
  {
    HostBench bench;
    bench.drive();
    const ScratchFolder folder("prepared");
    const std::string file = folder / "prepared.log";
    ASSERT_TRUE(bench.host->recorder().write(file));
    const auto log = read_candump_log(file);
    ASSERT_TRUE(log) << log.error().message;
    for (const LoggedFrame& logged : *log) {
      const MessageKind kind = kind_of(logged.frame);
      if (kind != MessageKind::kHostHeartbeat && kind != MessageKind::kZoneCommand &&
          kind != MessageKind::kLockStep) {
        port.frames.push_back(logged.frame);
      }
    }
  }
  HostSession session(port, bench_machine(),
                      HostFeedback::create(bench_machine(), {0.0, 0.0}).value(), {});
  JointCommand command;
  command.num_joints = bench_machine().num_joints();
  command.valid_until_s = 1e9;
  const long before = num_allocations;
  EXPECT_GT(before, 0) << "the count must count";
  for (std::int64_t now_ns = 0; port.end + kFramesPerCycle < port.frames.size();
       now_ns += 10'000'000) {
    port.end += kFramesPerCycle;
    if (session.automaton().phase == HostPhase::kInactive) session.request_enable();
    static_cast<void>(session.collect());
    session.cycle(now_ns);
    session.send_lock_step(1);
    session.write(command);
    session.stop();
    session.release();
    static_cast<void>(session.state());
    static_cast<void>(session.health());
  }
  EXPECT_EQ(num_allocations - before, 0);
  EXPECT_GT(port.sent, 100);
  EXPECT_GT(session.link().statistics().frames_received(), 1000);
}

}  // namespace
}  // namespace wex::can
