#pragma once

#include <array>
#include <deque>
#include <functional>

#include "hw_interface/socketcan/frame_port.hpp"

namespace wex::can {

/// A bus within the process, for tests and benches without CAN: two ends, in order, without loss.
/// Waiting at one end runs `on_wait` of that end, where a test lets the other side work or its
/// clock go on; without it waiting returns at once. Not thread-safe. Bounded only by memory.
class FramePipe {
 public:
  class End final : public FramePort {
   public:
    SocketStatus send(const CanFrame& frame) noexcept override;
    SocketStatus receive(CanFrame& frame) noexcept override;
    SocketStatus wait_readable(double timeout_s) noexcept override;
    SocketStatus reopen() noexcept override;  ///< forgets what is unread
    bool purge() noexcept override { return false; }
    [[nodiscard]] std::uint32_t dropped() const noexcept override { return 0; }

    std::function<void(double timeout_s)> on_wait;

   private:
    friend class FramePipe;
    End* peer_ = nullptr;
    std::deque<CanFrame> inbox_;
  };

  FramePipe();
  FramePipe(const FramePipe&) = delete;
  FramePipe& operator=(const FramePipe&) = delete;

  [[nodiscard]] End& host() noexcept { return host_; }
  [[nodiscard]] End& machine() noexcept { return machine_; }

 private:
  End host_, machine_;
};

}  // namespace wex::can
