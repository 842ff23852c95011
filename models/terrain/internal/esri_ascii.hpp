#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "models/types/result.hpp"

namespace wex::terrain_internal {

/// Bounds of what is read: a map of 8 x 8 km at 1 m, or 800 x 800 m at 0.1 m.
inline constexpr double kMaxCells = 64e6;

/// A north-up raster as a file states it, before any judgement on it.
struct RasterFile {
  long long columns = 0, rows = 0;
  double cell_x_m = 0.0, cell_y_m = 0.0;  ///< east and north extent of a cell, as stated
  double west_center_m = 0.0;             ///< x of the first column's cell centres
  double south_center_m = 0.0;            ///< y of the southernmost row's cell centres
  std::vector<float> values;              ///< rows from south to north; NaN = unknown
};

/// True if the text starts like an ESRI ASCII grid.
[[nodiscard]] bool looks_like_esri_ascii(std::string_view text);

/// Parses an ESRI ASCII grid strictly: GDAL's own reader takes letters and truncated files for
/// zeros. Keys in any case and order; xllcorner or xllcenter; cellsize or dx and dy; "nan" and
/// NODATA_value (default -9999) are unknown.
///   errors  kBadInput, one sentence naming the file and the line
[[nodiscard]] Result<RasterFile> parse_esri_ascii(std::string_view text,
                                                  const std::filesystem::path& file);

/// The text of an ESRI ASCII grid; shortest digits that read back as the same number.
[[nodiscard]] std::string format_esri_ascii(const RasterFile& raster);

}  // namespace wex::terrain_internal
