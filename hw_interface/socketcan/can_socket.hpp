#pragma once

#include <cstdint>
#include <string>

#include "hw_interface/socketcan/can_frame.hpp"
#include "hw_interface/socketcan/frame_port.hpp"
#include "models/types/result.hpp"

namespace wex::can {

/// A raw CAN FD socket on one interface: non-blocking, error frames on, own frames of this socket
/// not received, 29-bit and remote frames filtered out by the kernel, smallest send buffer (honest
/// back-pressure), large receive buffer, overflow counter, kernel time stamps. Move-only resource;
/// send and receive are noexcept and allocation-free.
class CanSocket final : public FramePort {
 public:
  /// errors  kBadInput: no such interface, or the kernel has no CAN (one sentence with the remedy)
  [[nodiscard]] static Result<CanSocket> open(const std::string& interface_name);
  CanSocket(CanSocket&& other) noexcept;
  CanSocket& operator=(CanSocket&& other) noexcept;
  CanSocket(const CanSocket&) = delete;
  CanSocket& operator=(const CanSocket&) = delete;
  ~CanSocket() override;

  SocketStatus send(const CanFrame& frame) noexcept override;
  SocketStatus receive(CanFrame& frame) noexcept override;
  SocketStatus wait_readable(double timeout_s) noexcept override;
  /// kGone while the interface does not exist.
  SocketStatus reopen() noexcept override;
  /// Takes the link down and up, which empties every transmit queue of the interface. Needs
  /// CAP_NET_ADMIN; false without it. Other programs on the interface see it go down as well.
  bool purge() noexcept override;
  [[nodiscard]] std::uint32_t dropped() const noexcept override { return dropped_; }
  /// Whether the interface takes CAN FD frames (else it was set up for classic CAN).
  [[nodiscard]] bool takes_fd_frames() const noexcept;
  [[nodiscard]] std::uint32_t dropped_by_kernel() const noexcept { return dropped_; }
  [[nodiscard]] const std::string& interface_name() const noexcept { return interface_name_; }

 private:
  CanSocket(int descriptor, std::string interface_name) noexcept;
  SocketStatus status_of(int error_number) noexcept;

  int descriptor_ = -1;
  bool gone_ = false;  ///< the kernel says so once only, to whichever call comes first
  std::string interface_name_;
  std::uint32_t dropped_ = 0;         ///< of all sockets opened so far
  std::uint32_t dropped_before_ = 0;  ///< of those closed again
};

}  // namespace wex::can
