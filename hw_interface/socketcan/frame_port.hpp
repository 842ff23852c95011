#pragma once

#include <cstdint>

#include "hw_interface/socketcan/can_frame.hpp"

namespace wex::can {

enum class SocketStatus : std::uint8_t {
  kOk,
  kWouldBlock,     ///< nothing to read, or no room to send (ENOBUFS, EAGAIN): try next cycle
  kInterfaceDown,  ///< ENETDOWN
  kGone            ///< ENXIO, ENODEV: the interface was deleted; the port must be reopened
};

/// Where frames go out and come in: a socket (CanSocket), a pipe within the process (FramePipe), or
/// one that does harm on purpose (FaultyPort). One thread; all calls but reopen and purge are
/// allocation-free.
class FramePort {
 public:
  virtual ~FramePort() = default;
  /// kOk means that the frame was taken, not that it was transmitted.
  virtual SocketStatus send(const CanFrame& frame) noexcept = 0;
  /// kOk: `frame` holds the next frame. Never blocks.
  virtual SocketStatus receive(CanFrame& frame) noexcept = 0;
  /// Waits until something can be read, at most timeout_s. kOk or kWouldBlock.
  virtual SocketStatus wait_readable(double timeout_s) noexcept = 0;
  /// Closes and opens again, interface looked up anew; everything unread is lost.
  virtual SocketStatus reopen() noexcept = 0;
  /// Throws away what was taken but not transmitted. False where that is not possible.
  virtual bool purge() noexcept = 0;
  /// Frames lost in the receive queue so far; counted up when the next one is received.
  [[nodiscard]] virtual std::uint32_t dropped() const noexcept = 0;
};

/// CLOCK_MONOTONIC, or a clock of a test. Never a realtime clock: ages must survive its jumps.
class MonotonicClock {
 public:
  virtual ~MonotonicClock() = default;
  [[nodiscard]] virtual std::int64_t now_ns() noexcept = 0;
};

/// CLOCK_MONOTONIC.
class SystemClock final : public MonotonicClock {
 public:
  [[nodiscard]] std::int64_t now_ns() noexcept override;
};

}  // namespace wex::can
