#include "models/terrain/internal/esri_ascii.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <type_traits>

namespace wex::terrain_internal {
namespace {

constexpr float kDefaultNodata = -9999.0F;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

/// Words of a text, with the line each stands on.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  /// The next word; empty at the end of the text.
  std::string_view next() {
    while (position_ < text_.size() && is_space(text_[position_])) {
      if (text_[position_] == '\n') ++line_;
      ++position_;
    }
    const std::size_t start = position_;
    while (position_ < text_.size() && !is_space(text_[position_])) ++position_;
    return text_.substr(start, position_ - start);
  }
  [[nodiscard]] int line() const { return line_; }  ///< of the word given last

 private:
  std::string_view text_;
  std::size_t position_ = 0;
  int line_ = 1;
};

/// A number that takes the whole word; no value otherwise.
template <typename Number>
std::optional<Number> parse_number(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return number;
}

/// A word as it may be shown in a message.
std::string in_quotes(std::string_view word) {
  constexpr std::size_t kLongest = 24;
  std::string shown = "'";
  for (const char c : word.substr(0, kLongest)) {
    shown += std::isprint(static_cast<unsigned char>(c)) != 0 ? c : '?';
  }
  return shown + (word.size() > kLongest ? "...'" : "'");
}

tl::unexpected<Error> refuse(const std::filesystem::path& file, int line,
                             const std::string& reason) {
  return fail(ErrorCode::kBadInput,
              file.string() + ": line " + std::to_string(line) + ": " + reason);
}

struct HeaderEntry {
  double value = 0.0;
  int line = 0;
};
using Header = std::map<std::string, HeaderEntry, std::less<>>;

bool is_key(std::string_view lower_word) {
  constexpr std::array<std::string_view, 10> kKeys{
      "ncols",     "nrows",    "xllcorner", "yllcorner", "xllcenter",
      "yllcenter", "cellsize", "dx",        "dy",        "nodata_value"};
  return std::find(kKeys.begin(), kKeys.end(), lower_word) != kKeys.end();
}

/// Reads "key value" pairs up to the first number that stands where a key would; `words` is left
/// before it.
Result<Header> read_header(Words& words, const std::filesystem::path& file) {
  Header header;
  while (true) {
    const Words before = words;
    const std::string key = lower_case(words.next());
    if (key.empty() || (!is_key(key) && (key == "nan" || parse_number<double>(key)))) {
      words = before;
      return header;
    }
    const int line = words.line();
    if (!is_key(key)) {
      return refuse(file, line,
                    "found " + in_quotes(key) +
                        ", expected a header key (ncols, nrows, xllcorner, "
                        "yllcorner, cellsize, NODATA_value) or a height");
    }
    const std::string_view word = words.next();
    const auto value = parse_number<double>(word);
    const bool may_be_nan = key == "nodata_value";
    if (!value || (!std::isfinite(*value) && !may_be_nan)) {
      return refuse(file, line, key + " is " + in_quotes(word) + ", expected a finite number");
    }
    if (!header.emplace(key, HeaderEntry{*value, line}).second) {
      return refuse(file, line, key + " is given twice");
    }
  }
}

/// Number of columns or rows.
Result<long long> cell_count(const Header& header, std::string_view key,
                             const std::filesystem::path& file) {
  const auto entry = header.find(key);
  if (entry == header.end()) {
    return fail(ErrorCode::kBadInput, file.string() + ": the header has no " + std::string(key));
  }
  const auto [value, line] = entry->second;
  if (value < 1.0 || value > 1e15 || value != std::floor(value)) {
    return refuse(file, line, std::string(key) + " is not a positive whole number");
  }
  return static_cast<long long>(value);
}

/// Centre of the first column (axis 'x') or of the southernmost row (axis 'y').
Result<double> first_center(const Header& header, char axis, double cell_m,
                            const std::filesystem::path& file) {
  const std::string stem = std::string(1, axis) + "ll";
  if (const auto center = header.find(stem + "center"); center != header.end()) {
    return center->second.value;
  }
  if (const auto corner = header.find(stem + "corner"); corner != header.end()) {
    return corner->second.value + 0.5 * cell_m;
  }
  return fail(ErrorCode::kBadInput,
              file.string() + ": the header has neither " + stem + "corner nor " + stem + "center");
}

Result<double> cell_extent(const Header& header, std::string_view own_key,
                           const std::filesystem::path& file) {
  auto entry = header.find("cellsize");
  if (entry == header.end()) entry = header.find(own_key);
  if (entry == header.end()) {
    return fail(ErrorCode::kBadInput, file.string() + ": the header has no cellsize");
  }
  if (entry->second.value <= 0.0) {
    return refuse(file, entry->second.line, entry->first + " is not positive");
  }
  return entry->second.value;
}

Result<RasterFile> raster_from(const Header& header, std::size_t text_size,
                               const std::filesystem::path& file) {
  const auto columns = cell_count(header, "ncols", file);
  if (!columns) return tl::unexpected<Error>(columns.error());
  const auto rows = cell_count(header, "nrows", file);
  if (!rows) return tl::unexpected<Error>(rows.error());
  const auto cell_x = cell_extent(header, "dx", file);
  if (!cell_x) return tl::unexpected<Error>(cell_x.error());
  const auto cell_y = cell_extent(header, "dy", file);
  if (!cell_y) return tl::unexpected<Error>(cell_y.error());
  const auto west = first_center(header, 'x', *cell_x, file);
  if (!west) return tl::unexpected<Error>(west.error());
  const auto south = first_center(header, 'y', *cell_y, file);
  if (!south) return tl::unexpected<Error>(south.error());

  // Each value takes a digit and a separator: a header that promises more than the file can hold
  // is found out before any memory is asked for.
  const double cells = static_cast<double>(*columns) * static_cast<double>(*rows);
  if (2.0 * cells - 1.0 > static_cast<double>(text_size)) {
    return fail(ErrorCode::kBadInput,
                file.string() + ": the header announces " + std::to_string(*columns) + " x " +
                    std::to_string(*rows) + " cells, more than the file's " +
                    std::to_string(text_size) +
                    " bytes can hold: the file is cut off or its header wrong");
  }
  RasterFile raster;
  raster.columns = *columns;
  raster.rows = *rows;
  raster.cell_x_m = *cell_x;
  raster.cell_y_m = *cell_y;
  raster.west_center_m = *west;
  raster.south_center_m = *south;
  return raster;
}

template <typename Number>
void append_number(std::string& text, Number number) {
  std::array<char, 512> buffer{};  // the smallest double in plain notation has 345 characters
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), number, std::chars_format::fixed);
  text.append(buffer.data(), end.ptr);
}

}  // namespace

bool looks_like_esri_ascii(std::string_view text) {
  const std::string first = lower_case(Words(text.substr(0, 256)).next());
  return first == "ncols" || first == "nrows";
}

Result<RasterFile> parse_esri_ascii(std::string_view text, const std::filesystem::path& file) {
  Words words(text);
  const Result<Header> header = read_header(words, file);
  if (!header) return tl::unexpected<Error>(header.error());
  Result<RasterFile> raster = raster_from(*header, text.size(), file);
  if (!raster) return raster;
  if (static_cast<double>(raster->columns) * static_cast<double>(raster->rows) > kMaxCells) {
    return fail(ErrorCode::kBadInput, file.string() +
                                          ": has more than 64 million cells; cut out "
                                          "the part to drive over");
  }

  float nodata = kDefaultNodata;
  if (const auto entry = header->find("nodata_value"); entry != header->end()) {
    nodata = static_cast<float>(entry->second.value);
  }
  raster->values.resize(static_cast<std::size_t>(raster->columns * raster->rows));
  for (long long row = 0; row < raster->rows; ++row) {
    // The file runs from north to south.
    float* const out = raster->values.data() +
                       static_cast<std::size_t>((raster->rows - 1 - row) * raster->columns);
    for (long long column = 0; column < raster->columns; ++column) {
      const std::string_view word = words.next();
      const auto height = parse_number<float>(word);
      if (height && (std::isfinite(*height) || std::isnan(*height))) {
        out[column] = *height == nodata ? std::numeric_limits<float>::quiet_NaN() : *height;
        continue;
      }
      if (word.empty()) {
        return refuse(file, words.line(),
                      "the file ends after " + std::to_string(row * raster->columns + column) +
                          " of " + std::to_string(raster->columns * raster->rows) +
                          " heights: it is cut off or its header wrong");
      }
      return refuse(file, words.line(),
                    "found " + in_quotes(word) + ", expected a height in metres");
    }
  }
  if (const std::string_view extra = words.next(); !extra.empty()) {
    return refuse(file, words.line(),
                  "found " + in_quotes(extra) + " after the last of " +
                      std::to_string(raster->columns * raster->rows) + " heights");
  }
  return raster;
}

std::string format_esri_ascii(const RasterFile& raster) {
  std::string text;
  text.reserve(raster.values.size() * 8);
  const auto header_line = [&](const char* key, auto value) {
    text += key;
    if constexpr (std::is_integral_v<decltype(value)>) {
      text += std::to_string(value);
    } else {
      append_number(text, value);
    }
    text += '\n';
  };
  header_line("ncols ", raster.columns);
  header_line("nrows ", raster.rows);
  // To the micrometre, so that sums such as 15 + -14.95 do not drag their round-off along
  // (and no minus before a zero).
  const auto to_micrometre = [](double length_m) { return std::round(length_m * 1e6) / 1e6 + 0.0; };
  header_line("xllcorner ", to_micrometre(raster.west_center_m - 0.5 * raster.cell_x_m));
  header_line("yllcorner ", to_micrometre(raster.south_center_m - 0.5 * raster.cell_y_m));
  header_line("cellsize ", raster.cell_x_m);
  header_line("NODATA_value ", static_cast<long long>(kDefaultNodata));
  for (long long row = raster.rows - 1; row >= 0; --row) {
    for (long long column = 0; column < raster.columns; ++column) {
      const float height = raster.values[static_cast<std::size_t>(row * raster.columns + column)];
      if (column > 0) text += ' ';
      append_number(text, std::isnan(height) ? kDefaultNodata : height);
    }
    text += '\n';
  }
  return text;
}

}  // namespace wex::terrain_internal
