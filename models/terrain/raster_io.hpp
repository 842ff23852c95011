#pragma once

#include <filesystem>

#include "models/terrain/terrain_map.hpp"
#include "models/types/result.hpp"

namespace wex {

/// An elevation raster in the frame of its file.
struct Raster {
  Grid elevation;                                          ///< origin_m is relative to map_origin_m
  Eigen::Vector2d map_origin_m = Eigen::Vector2d::Zero();  ///< integer metres near the map's centre
};

/// Reads ESRI ASCII grids, GeoTIFF and whatever else GDAL reads; nodata becomes NaN.
///   errors  kBadInput, one sentence naming the file (and line where there is one): missing file,
///           truncated grid, letters, NaN or negative cell size, a header larger than the file,
///           rotated or non-square cells, a CRS in degrees (says how to reproject)
[[nodiscard]] Result<Raster> read_raster(const std::filesystem::path& file);

/// Writes an ESRI ASCII grid (whole file or nothing: written beside and renamed).
[[nodiscard]] Result<void> write_esri_ascii(const Raster& raster,
                                            const std::filesystem::path& file);

}  // namespace wex
