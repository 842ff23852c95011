#pragma once

#include <functional>

#include "hw_interface/socketcan/frame_port.hpp"

namespace wex::can_faults {

/// A port that lets somebody look at every frame; a frame that on_send refuses is lost on the way.
class TapPort final : public can::FramePort {
 public:
  explicit TapPort(can::FramePort& inner) : inner_(inner) {}

  std::function<bool(const can::CanFrame&)> on_send = [](const can::CanFrame&) { return true; };
  std::function<void(const can::CanFrame&)> on_sent = [](const can::CanFrame&) {};
  /// Called before the next frame is asked for, and with it once it is there.
  std::function<void()> before_receive = [] {};
  std::function<void(const can::CanFrame&)> on_received = [](const can::CanFrame&) {};

  can::SocketStatus send(const can::CanFrame& frame) noexcept override {
    if (!on_send(frame)) return can::SocketStatus::kOk;
    const can::SocketStatus status = inner_.send(frame);
    if (status == can::SocketStatus::kOk) on_sent(frame);
    return status;
  }
  can::SocketStatus receive(can::CanFrame& frame) noexcept override {
    before_receive();
    const can::SocketStatus status = inner_.receive(frame);
    if (status == can::SocketStatus::kOk) on_received(frame);
    return status;
  }
  can::SocketStatus wait_readable(double timeout_s) noexcept override {
    return inner_.wait_readable(timeout_s);
  }
  can::SocketStatus reopen() noexcept override { return inner_.reopen(); }
  bool purge() noexcept override { return inner_.purge(); }
  [[nodiscard]] std::uint32_t dropped() const noexcept override { return inner_.dropped(); }

 private:
  can::FramePort& inner_;
};

/// One CAN controller made of two interfaces: data of the one (which carries CAN FD), error frames
/// of the other (slcan, whose driver has true error states). While the other is bus-off nothing
/// passes, though sending succeeds: so does the kernel.
class ControllerPort final : public can::FramePort {
 public:
  ControllerPort(can::FramePort& data, can::FramePort& errors) : data_(data), errors_(errors) {}

  can::SocketStatus send(const can::CanFrame& frame) noexcept override {
    return bus_off_ ? can::SocketStatus::kOk : data_.send(frame);
  }
  can::SocketStatus receive(can::CanFrame& frame) noexcept override {
    while (errors_.receive(frame) == can::SocketStatus::kOk) {
      if (!frame.error) continue;
      if ((frame.id & kBusOff) != 0) bus_off_ = true;
      if ((frame.id & kRestarted) != 0) bus_off_ = false;
      return can::SocketStatus::kOk;
    }
    can::SocketStatus status = data_.receive(frame);
    while (bus_off_ && status == can::SocketStatus::kOk) status = data_.receive(frame);
    return status;
  }
  can::SocketStatus wait_readable(double timeout_s) noexcept override {
    return data_.wait_readable(timeout_s);
  }
  can::SocketStatus reopen() noexcept override { return data_.reopen(); }
  /// A link that went down and up starts error-active; what is wrong is reported anew.
  bool purge() noexcept override {
    if (!errors_.purge()) return false;
    bus_off_ = false;
    return true;
  }
  [[nodiscard]] std::uint32_t dropped() const noexcept override { return data_.dropped(); }

 private:
  static constexpr std::uint32_t kBusOff = 0x40,
                                 kRestarted = 0x100;  // classes of linux/can/error.h
  can::FramePort &data_, &errors_;
  bool bus_off_ = false;
};

}  // namespace wex::can_faults
