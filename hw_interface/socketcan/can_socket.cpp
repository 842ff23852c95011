#include "hw_interface/socketcan/can_socket.hpp"

#include <errno.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/net_tstamp.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace wex::can {
namespace {

constexpr int kReceiveBufferBytes = 4 * 1024 * 1024;  // about 10,000 frames; the default holds 278

/// A closed descriptor keeps errno, so that the caller can still tell why.
void close_quietly(int descriptor) noexcept {
  const int kept = errno;
  ::close(descriptor);
  errno = kept;
}

template <typename Value>
bool set_option(int descriptor, int level, int name, const Value& value) noexcept {
  return ::setsockopt(descriptor, level, name, &value, sizeof(value)) == 0;
}

/// Names the interface; a name that is too long names none.
ifreq request_for(const std::string& interface_name) noexcept {
  ifreq request{};
  if (interface_name.size() < sizeof(request.ifr_name)) {
    std::memcpy(request.ifr_name, interface_name.data(), interface_name.size());
  }
  return request;
}

/// Everything a bus socket needs; -1 and errno if the kernel refuses.
int open_descriptor(const std::string& interface_name) noexcept {
  const int descriptor = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (descriptor < 0) return -1;

  // The smallest send buffer there is: what a stalled bus has accepted goes out when it recovers,
  // even after this process has ended, so it must be few frames.
  set_option(descriptor, SOL_SOCKET, SO_SNDBUF, 1);
  if (!set_option(descriptor, SOL_SOCKET, SO_RCVBUFFORCE, kReceiveBufferBytes)) {
    set_option(descriptor, SOL_SOCKET, SO_RCVBUF, kReceiveBufferBytes);  // up to rmem_max
  }
  set_option(descriptor, SOL_SOCKET, SO_RXQ_OVFL, 1);
  set_option(descriptor, SOL_SOCKET, SO_TIMESTAMPING,
             SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE);
  set_option(descriptor, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, 1);
  // Lost arbitration is everyday life on a bus, not an error.
  const can_err_mask_t errors = CAN_ERR_MASK & ~static_cast<can_err_mask_t>(CAN_ERR_LOSTARB);
  set_option(descriptor, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors);
  // Any 11-bit data frame. Without both flags in the mask, 29-bit and remote frames would pass too.
  const can_filter standard_data{0, CAN_EFF_FLAG | CAN_RTR_FLAG};
  set_option(descriptor, SOL_CAN_RAW, CAN_RAW_FILTER, standard_data);

  ifreq request = request_for(interface_name);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  if (::ioctl(descriptor, SIOCGIFINDEX, &request) != 0) {
    close_quietly(descriptor);
    return -1;
  }
  address.can_ifindex = request.ifr_ifindex;
  if (::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    close_quietly(descriptor);
    return -1;
  }
  return descriptor;
}

}  // namespace

CanSocket::CanSocket(int descriptor, std::string interface_name) noexcept
    : descriptor_(descriptor), interface_name_(std::move(interface_name)) {}

CanSocket::CanSocket(CanSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      gone_(other.gone_),
      interface_name_(std::move(other.interface_name_)),
      dropped_(other.dropped_),
      dropped_before_(other.dropped_before_) {}

CanSocket& CanSocket::operator=(CanSocket&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(gone_, other.gone_);
  std::swap(interface_name_, other.interface_name_);
  std::swap(dropped_, other.dropped_);
  std::swap(dropped_before_, other.dropped_before_);
  return *this;
}

CanSocket::~CanSocket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<CanSocket> CanSocket::open(const std::string& interface_name) {
  const int descriptor = open_descriptor(interface_name);
  if (descriptor >= 0) return CanSocket(descriptor, interface_name);
  const int error_number = errno;
  if (error_number == EAFNOSUPPORT || error_number == EPROTONOSUPPORT) {
    return fail(
        ErrorCode::kBadInput,
        "this kernel has no CAN: load the modules can, can-raw and the adapter's driver, or "
        "run the command through tools/with_vcan");
  }
  if (error_number == ENODEV) {
    return fail(ErrorCode::kBadInput,
                "there is no network interface '" + interface_name +
                    "': 'ip -details link show type can' lists them, or run the command through "
                    "tools/with_vcan");
  }
  return fail(ErrorCode::kBadInput, "the CAN interface '" + interface_name +
                                        "' cannot be opened: " + std::strerror(error_number));
}

SocketStatus CanSocket::status_of(int error_number) noexcept {
  switch (error_number) {
    case ENETDOWN:
      return SocketStatus::kInterfaceDown;
    case ENXIO:
    case ENODEV:
    case EBADF:
      return SocketStatus::kGone;
    default:  // EAGAIN, ENOBUFS, EINTR, and what else a driver may think of: the next cycle tries
      return SocketStatus::kWouldBlock;
  }
}

SocketStatus CanSocket::send(const CanFrame& frame) noexcept {
  if (descriptor_ < 0) return SocketStatus::kGone;
  canfd_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) |
               (frame.remote ? CAN_RTR_FLAG : 0U) | (frame.error ? CAN_ERR_FLAG : 0U);
  raw.len = frame.length;
  // The bit rate switch is what makes room for 64 bytes; CANFD_FDF says FD on newer kernels.
  raw.flags = frame.fd ? CANFD_BRS | CANFD_FDF : 0;
  std::memcpy(raw.data, frame.data.data(), std::min<std::size_t>(frame.length, CANFD_MAX_DLEN));
  const std::size_t bytes = frame.fd ? CANFD_MTU : CAN_MTU;
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (::send(descriptor_, &raw, bytes, MSG_DONTWAIT) == static_cast<ssize_t>(bytes)) {
      return SocketStatus::kOk;
    }
    // The first call after a link went down and up again reports the past: ask once more.
    const int error_number = errno;
    int pending = 0;
    socklen_t size = sizeof(pending);
    ::getsockopt(descriptor_, SOL_SOCKET, SO_ERROR, &pending, &size);
    if (error_number != ENETDOWN || attempt == 1) {
      const SocketStatus status = status_of(error_number);
      gone_ = gone_ || status == SocketStatus::kGone;
      return status;
    }
  }
  return SocketStatus::kInterfaceDown;
}

SocketStatus CanSocket::receive(CanFrame& frame) noexcept {
  if (descriptor_ < 0) return SocketStatus::kGone;
  canfd_frame raw{};
  iovec buffer{&raw, sizeof(raw)};
  alignas(cmsghdr) char control[256];
  msghdr message{};
  message.msg_iov = &buffer;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof(control);
  const ssize_t bytes = ::recvmsg(descriptor_, &message, MSG_DONTWAIT);
  if (bytes < 0) {
    const SocketStatus status = status_of(errno);
    return status == SocketStatus::kWouldBlock && gone_ ? SocketStatus::kGone : status;
  }
  if (bytes != CAN_MTU && bytes != CANFD_MTU) return SocketStatus::kWouldBlock;

  frame = CanFrame{};
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.error = (raw.can_id & CAN_ERR_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended || frame.error ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.fd = bytes == CANFD_MTU;
  frame.length = std::min<std::uint8_t>(raw.len, frame.fd ? CANFD_MAX_DLEN : CAN_MAX_DLEN);
  std::memcpy(frame.data.data(), raw.data, frame.length);
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr;
       part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET) continue;
    if (part->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t dropped_here = 0;
      std::memcpy(&dropped_here, CMSG_DATA(part), sizeof(dropped_here));
      dropped_ = dropped_before_ + dropped_here;
    } else if (part->cmsg_type == SCM_TIMESTAMPING) {
      timespec stamp{};  // the first of three: software
      std::memcpy(&stamp, CMSG_DATA(part), sizeof(stamp));
      frame.kernel_time_ns = std::int64_t{stamp.tv_sec} * 1'000'000'000 + stamp.tv_nsec;
    }
  }
  return SocketStatus::kOk;
}

SocketStatus CanSocket::wait_readable(double timeout_s) noexcept {
  pollfd entry{descriptor_, POLLIN, 0};
  const double timeout_ns = std::clamp(timeout_s, 0.0, 3600.0) * 1e9;
  const auto whole_s = static_cast<time_t>(timeout_ns / 1e9);
  const timespec timeout{whole_s,
                         static_cast<long>(timeout_ns - static_cast<double>(whole_s) * 1e9)};
  // A negative descriptor (interface gone) is ignored by poll: then this only waits.
  return ::ppoll(&entry, 1, &timeout, nullptr) == 1 ? SocketStatus::kOk : SocketStatus::kWouldBlock;
}

SocketStatus CanSocket::reopen() noexcept {
  if (descriptor_ >= 0) ::close(descriptor_);
  dropped_before_ = dropped_;
  gone_ = false;
  descriptor_ = open_descriptor(interface_name_);
  return descriptor_ >= 0 ? SocketStatus::kOk : SocketStatus::kGone;
}

bool CanSocket::purge() noexcept {
  if (descriptor_ < 0) return false;
  ifreq request = request_for(interface_name_);
  if (::ioctl(descriptor_, SIOCGIFFLAGS, &request) != 0) return false;
  ifreq down = request;
  down.ifr_flags = static_cast<short>(request.ifr_flags & ~IFF_UP);
  if (::ioctl(descriptor_, SIOCSIFFLAGS, &down) != 0) return false;
  request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP);
  return ::ioctl(descriptor_, SIOCSIFFLAGS, &request) == 0;
}

bool CanSocket::takes_fd_frames() const noexcept {
  ifreq request = request_for(interface_name_);
  return ::ioctl(descriptor_, SIOCGIFMTU, &request) == 0 && request.ifr_mtu >= int{CANFD_MTU};
}

}  // namespace wex::can
