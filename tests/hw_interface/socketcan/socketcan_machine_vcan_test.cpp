#include <atomic>
#include <thread>

#include "hw_interface/electronics/electronics.hpp"
#include "hw_interface/socketcan/can_socket.hpp"
#include "hw_interface/socketcan/socketcan_machine.hpp"
#include "tests/support/fake_plant.hpp"
#include "tests/support/machine_io_contract.hpp"

// The contract of every machine on a real CAN bus: the electronics in a thread of their own, with
// their own socket, in lock step (tools/with_vcan).

namespace wex::can {
namespace {

constexpr const char* kInterface = "vcan0";

const MachineModel& m545() {
  static const MachineModel machine = load_machine().value();
  return machine;
}

/// Electronics and a plant on vcan0 until it is destroyed.
class MachineThread {
 public:
  MachineThread() : thread_([this] { live(); }) {}
  ~MachineThread() {
    ended_ = true;
    thread_.join();
  }

 private:
  static constexpr double kFreeAfter_s = 1.0;

  void live() {
    auto socket = CanSocket::open(kInterface);
    ASSERT_TRUE(socket) << socket.error().message;
    FakePlant plant(m545());
    SeededRandom random(3);
    ElectronicsSettings settings;
    settings.lock_step = true;
    const auto electronics = Electronics::create(m545(), plant, *socket, random, settings).value();
    SystemClock clock;
    std::int64_t now_ms = 0, word_ns = clock.now_ns();
    while (!ended_) {
      electronics->receive(now_ms);
      if (const auto until = electronics->take_lock_step()) {
        word_ns = clock.now_ns();
        while (static_cast<std::int32_t>(*until - static_cast<std::uint32_t>(now_ms)) >= 10) {
          electronics->tick(now_ms += 10);
        }
      } else if (1e-9 * static_cast<double>(clock.now_ns() - word_ns) > kFreeAfter_s) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        electronics->tick(now_ms += 10);
      } else {
        socket->wait_readable(0.01);
      }
    }
  }

  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

class MachineOnVcan final : public MachineIo {
 public:
  MachineOnVcan() {
    auto opened = SocketCanMachine::open(kInterface, m545(), {0.0, 0.0});
    EXPECT_TRUE(opened) << opened.error().message;
    host_ = std::move(opened.value());
    EXPECT_TRUE(host_->lock_step());
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
  MachineThread machine_;
  std::unique_ptr<SocketCanMachine> host_;
};

const MachineIoSubject kSubject{
    "OnVcan", [] { return std::make_unique<MachineOnVcan>(); },
    std::shared_ptr<const MachineModel>(&m545(), [](const MachineModel*) {})};
INSTANTIATE_TEST_SUITE_P(SocketCanMachine, MachineIoContract, ::testing::Values(kSubject),
                         subject_name);
INSTANTIATE_TEST_SUITE_P(SocketCanMachine, MachineIoMotionContract, ::testing::Values(kSubject),
                         subject_name);

TEST(SocketCanMachineOnVcan, SaysThatNoMachineIsHeard) {
  SocketCanSettings settings;
  settings.connect_patience_s = 0.2;
  const auto machine = SocketCanMachine::open(kInterface, m545(), {0.0, 0.0}, settings);
  ASSERT_FALSE(machine);
  EXPECT_NE(machine.error().message.find("no machine is heard"), std::string::npos);
}

}  // namespace
}  // namespace wex::can
