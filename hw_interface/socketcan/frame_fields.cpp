#include "hw_interface/socketcan/frame_fields.hpp"

#include <limits>

#include "hw_interface/socketcan/protection.hpp"

namespace wex::can {
namespace {

constexpr int kCrcBytes = 2;

CodecError range_error(const SignalRow& signal) noexcept {
  return signal.choices.empty() ? CodecError::kOutOfRange : CodecError::kBadEnumeration;
}

}  // namespace

std::uint16_t protection_crc(const MessageRow& row, const std::uint8_t* payload,
                             std::uint32_t session) noexcept {
  if (!row.session_bound) session = 0;
  const auto byte = [](std::uint32_t value, int index) {
    return static_cast<std::uint8_t>(value >> (8 * index));
  };
  const std::array<std::uint8_t, 6> unsent{byte(row.data_id, 0), byte(row.data_id, 1),
                                           byte(session, 0),     byte(session, 1),
                                           byte(session, 2),     byte(session, 3)};
  const std::span<const std::uint8_t> sent(payload + kCrcBytes, row.length - kCrcBytes);
  return crc16(unsent, crc16(sent));
}

void FrameWriter::refuse(CodecError error) noexcept {
  if (!refused_) error_ = error;
  refused_ = true;
}

void FrameWriter::integer(int field, std::int64_t value) noexcept {
  const SignalRow& signal = row_->signals[field];
  if (value < signal.raw_min || value > signal.raw_max) return refuse(range_error(signal));
  raw_[field] = value;
}

void FrameWriter::physical(int field, double value) noexcept {
  const auto raw = quantize(row_->signals[field], value);
  if (!raw) return refuse(raw.error());
  raw_[field] = *raw;
}

void FrameWriter::not_available(int field) noexcept {
  raw_[field] = row_->signals[field].not_available;
}

Result<void, CodecError> FrameWriter::finish(SendContext& context, CanFrame& frame) const noexcept {
  if (refused_) return tl::unexpected(error_);
  auto raw = raw_;
  raw[kCounterField] = context.counter++;
  frame = CanFrame{};
  frame.id = row_->id;
  frame.fd = row_->fd;
  frame.length = row_->length;
  row_->pack(raw.data(), frame.data.data());
  const std::uint16_t crc = protection_crc(*row_, frame.data.data(), context.session);
  frame.data[0] = static_cast<std::uint8_t>(crc);
  frame.data[1] = static_cast<std::uint8_t>(crc >> 8);
  return {};
}

Result<FrameReader, CodecError> FrameReader::open(const CanFrame& frame, std::uint32_t session,
                                                  MessageKind kind) noexcept {
  const MessageRow* row = row_of(frame.id);
  if (frame.extended || frame.remote || frame.error || row == nullptr || row->kind != kind) {
    return tl::unexpected(CodecError::kUnknownId);
  }
  if (frame.fd != row->fd) return tl::unexpected(CodecError::kWrongFormat);
  if (frame.length != row->length) return tl::unexpected(CodecError::kWrongLength);
  FrameReader reader(*row);
  row->unpack(frame.data.data(), reader.raw_.data());
  if (reader.raw_[kCrcField] != protection_crc(*row, frame.data.data(), session)) {
    return tl::unexpected(CodecError::kBadCrc);
  }
  return reader;
}

std::int64_t FrameReader::integer(int field) noexcept {
  const SignalRow& signal = row_->signals[field];
  const std::int64_t raw = raw_[field];
  if ((raw < signal.raw_min || raw > signal.raw_max) && !refused_) {
    refused_ = true;
    error_ = range_error(signal);
  }
  return raw;
}

double FrameReader::physical(int field) noexcept {
  return wex::can::physical(row_->signals[field], integer(field));
}

double FrameReader::physical_if_available(int field) noexcept {
  const SignalRow& signal = row_->signals[field];
  if (raw_[field] == signal.not_available) return std::numeric_limits<double>::quiet_NaN();
  return physical(field);
}

Result<ReceivedMeta, CodecError> FrameReader::finish() const noexcept {
  if (refused_) return tl::unexpected(error_);
  return ReceivedMeta{counter()};
}

}  // namespace wex::can
