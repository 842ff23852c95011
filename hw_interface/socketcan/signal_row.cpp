#include "hw_interface/socketcan/signal_row.hpp"

#include <algorithm>
#include <cmath>

#include "hw_interface/socketcan/generated/signal_table.hpp"

namespace wex::can {

Result<std::int64_t, CodecError> quantize(const SignalRow& signal, double value) noexcept {
  if (!std::isfinite(value)) return tl::unexpected(CodecError::kNotFinite);
  if (value < signal.minimum || value > signal.maximum) {
    return tl::unexpected(CodecError::kOutOfRange);
  }
  const std::int64_t raw = std::llround(value * signal.denominator / signal.numerator);
  // The generator has checked that the ranges agree; a table gone wrong must not wrap all the same.
  if (raw < signal.raw_min || raw > signal.raw_max) return tl::unexpected(CodecError::kOutOfRange);
  return raw;
}

double physical(const SignalRow& signal, std::int64_t raw) noexcept {
  return static_cast<double>(raw) * signal.numerator / signal.denominator;
}

const MessageRow* row_of(std::uint32_t id) noexcept {
  const auto& rows = generated::kMessages;
  const auto found =
      std::lower_bound(rows.begin(), rows.end(), id,
                       [](const MessageRow& row, std::uint32_t wanted) { return row.id < wanted; });
  return found != rows.end() && found->id == id ? &*found : nullptr;
}

const MessageRow* row_of(MessageKind kind, int zone) noexcept {
  for (const MessageRow& row : generated::kMessages) {
    if (row.kind == kind && row.zone == zone) return &row;
  }
  return nullptr;
}

}  // namespace wex::can
