#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "hw_interface/socketcan/codec.hpp"
#include "hw_interface/socketcan/frame_port.hpp"

namespace wex::can {

/// What happens to frames of one direction; probabilities per frame, independent.
struct FrameFaults {
  double loss = 0.0;
  double duplicate = 0.0;
  double corrupt = 0.0;                  ///< one to three bits of the payload are flipped
  double reorder = 0.0;                  ///< overtaken by those that follow within reorder_s
  double delay_s = 0.0, jitter_s = 0.0;  ///< uniform in delay +- jitter
  double reorder_s = 0.015;
};

struct FaultCounters {
  long lost = 0, duplicated = 0, corrupted = 0, reordered = 0, frozen = 0;
  long replayed_after_stall = 0;  ///< old frames that went out when a stall ended
};

/// A port that does harm on purpose, around one that works: the seed decides, so a run can be
/// repeated. Frames are dated by the clock that is given. For tests and benches.
class FaultyPort final : public FramePort {
 public:
  enum class Interface : std::uint8_t { kUp, kDown, kGone };

  /// Both must live longer.
  FaultyPort(FramePort& inner, MonotonicClock& clock, std::uint64_t seed);

  void set_sending(const FrameFaults& faults) noexcept { sending_ = faults; }
  void set_receiving(const FrameFaults& faults) noexcept { receiving_ = faults; }
  /// The bus takes nothing: a few frames still fit into the send queue, then it is full. What is in
  /// the queue goes out when the stall ends, as a real one does.
  void set_stalled(bool stalled) noexcept;
  /// kGone asks for reopen() once the interface is back.
  void set_interface(Interface state) noexcept;
  /// The joint's sensor says no more: the position of this moment, with quality kStale.
  void freeze_joint(std::optional<JointSlot> slot) noexcept;
  void set_purge_possible(bool possible) noexcept { purge_possible_ = possible; }
  /// Counts as frames dropped by the kernel.
  void add_dropped(std::uint32_t frames) noexcept { dropped_ += frames; }

  [[nodiscard]] const FaultCounters& counters() const noexcept { return counters_; }
  [[nodiscard]] long reopens() const noexcept { return reopens_; }

  SocketStatus send(const CanFrame& frame) noexcept override;
  SocketStatus receive(CanFrame& frame) noexcept override;
  SocketStatus wait_readable(double timeout_s) noexcept override;
  SocketStatus reopen() noexcept override;
  bool purge() noexcept override;
  [[nodiscard]] std::uint32_t dropped() const noexcept override;

 private:
  struct Waiting {
    std::int64_t due_ns = 0;
    std::uint64_t number = 0;  ///< keeps the order of frames that are due together
    CanFrame frame;
  };
  using Queue = std::vector<Waiting>;  ///< a heap, earliest first
  static constexpr std::size_t kMaxWaiting = 8192;
  static constexpr std::size_t kSendQueueFrames = 5;  ///< what the smallest send buffer holds

  [[nodiscard]] double uniform() noexcept;  ///< in [0, 1)
  [[nodiscard]] bool happens(double probability) noexcept { return uniform() < probability; }
  void enqueue(const CanFrame& frame, const FrameFaults& faults, Queue& queue) noexcept;
  void push(const CanFrame& frame, double delay_s, Queue& queue) noexcept;
  static bool take_due(Queue& queue, std::int64_t now_ns, CanFrame& frame) noexcept;
  void corrupt(CanFrame& frame) noexcept;
  void freeze(CanFrame& frame) noexcept;
  SocketStatus deliver() noexcept;
  SocketStatus pull() noexcept;

  FramePort* inner_;
  MonotonicClock* clock_;
  std::mt19937_64 random_;
  FrameFaults sending_, receiving_;
  FaultCounters counters_;
  Queue outbox_, inbox_;
  std::vector<CanFrame> stalled_frames_;
  bool stalled_ = false, purge_possible_ = false, needs_reopen_ = false, told_ = false;
  Interface interface_ = Interface::kUp;
  std::optional<JointSlot> frozen_slot_;
  std::optional<double> frozen_position_;
  std::uint64_t number_ = 0;
  std::uint32_t dropped_ = 0;
  long reopens_ = 0;
};

}  // namespace wex::can
