#include "hw_interface/socketcan/frame_pipe.hpp"

#include <time.h>

namespace wex::can {

std::int64_t SystemClock::now_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

FramePipe::FramePipe() {
  host_.peer_ = &machine_;
  machine_.peer_ = &host_;
}

SocketStatus FramePipe::End::send(const CanFrame& frame) noexcept {
  peer_->inbox_.push_back(frame);
  return SocketStatus::kOk;
}

SocketStatus FramePipe::End::receive(CanFrame& frame) noexcept {
  if (inbox_.empty()) return SocketStatus::kWouldBlock;
  frame = inbox_.front();
  inbox_.pop_front();
  return SocketStatus::kOk;
}

SocketStatus FramePipe::End::wait_readable(double timeout_s) noexcept {
  if (inbox_.empty() && on_wait) on_wait(timeout_s);
  return inbox_.empty() ? SocketStatus::kWouldBlock : SocketStatus::kOk;
}

SocketStatus FramePipe::End::reopen() noexcept {
  inbox_.clear();
  return SocketStatus::kOk;
}

}  // namespace wex::can
