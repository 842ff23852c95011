#pragma once

#include <cstdint>
#include <string>

#include "hw_interface/socketcan/can_frame.hpp"
#include "models/types/result.hpp"

namespace wex::can {

enum class SocketStatus : std::uint8_t {
  kOk,
  kWouldBlock,     ///< nothing to read, or no room to send (ENOBUFS, EAGAIN): try next cycle
  kInterfaceDown,  ///< ENETDOWN
  kGone            ///< ENXIO, ENODEV: the interface was deleted; the socket must be reopened
};

/// A raw CAN FD socket on one interface: non-blocking, error frames on, own frames of this socket
/// not received, smallest send buffer (honest back-pressure), large receive buffer, overflow
/// counter, kernel time stamps. Move-only resource; send and receive are noexcept and
/// allocation-free.
class CanSocket {
 public:
  /// errors  kBadInput: no such interface, or the kernel has no CAN (one sentence with the remedy)
  [[nodiscard]] static Result<CanSocket> open(const std::string& interface_name);
  CanSocket(CanSocket&& other) noexcept;
  CanSocket& operator=(CanSocket&& other) noexcept;
  CanSocket(const CanSocket&) = delete;
  CanSocket& operator=(const CanSocket&) = delete;
  ~CanSocket();

  SocketStatus send(const CanFrame& frame) noexcept;
  /// kOk: `frame` holds the next frame.
  SocketStatus receive(CanFrame& frame) noexcept;
  /// Waits until something can be read, at most timeout_s. kOk or kWouldBlock.
  SocketStatus wait_readable(double timeout_s) noexcept;
  [[nodiscard]] std::uint32_t dropped_by_kernel() const noexcept {
    return dropped_;
  }  ///< SO_RXQ_OVFL
  [[nodiscard]] const std::string& interface_name() const noexcept { return interface_name_; }

 private:
  CanSocket(int descriptor, std::string interface_name) noexcept;
  int descriptor_ = -1;
  std::string interface_name_;
  std::uint32_t dropped_ = 0;
};

}  // namespace wex::can
