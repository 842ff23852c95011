#include "models/terrain/raster_io.hpp"

#include <cpl_error.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <mutex>
#include <string>

#include "models/terrain/internal/atomic_file.hpp"
#include "models/terrain/internal/esri_ascii.hpp"

namespace wex {

using terrain_internal::RasterFile;

namespace {

/// Keeps GDAL from printing while it lives, and what GDAL had to say last.
class QuietGdal {
 public:
  QuietGdal() {
    static std::once_flag registered;
    std::call_once(registered, [] { GDALAllRegister(); });
    CPLPushErrorHandler(CPLQuietErrorHandler);
    CPLErrorReset();
  }
  ~QuietGdal() {
    CPLErrorReset();
    CPLPopErrorHandler();
  }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;

  [[nodiscard]] static std::string last_words() {
    std::string words = CPLGetLastErrorMsg();
    for (char& c : words) {
      if (c == '\n') c = ' ';
    }
    return words.empty() ? "no reason given" : words;
  }
};

tl::unexpected<Error> refuse(const std::filesystem::path& file, const std::string& reason) {
  return fail(ErrorCode::kBadInput, file.string() + ": " + reason);
}

std::string reprojection_hint(const std::string& file, const std::string& target_crs) {
  return "reproject it, for example: gdalwarp -t_srs " + target_crs +
         " -tr 0.1 0.1 -r cubicspline " + file + " metric.tif";
}

/// EPSG code of the UTM zone around a place in degrees.
std::string utm_zone_at(double longitude_deg, double latitude_deg) {
  if (!(std::abs(longitude_deg) <= 180.0) || !(std::abs(latitude_deg) <= 90.0)) {
    return "EPSG:32632";
  }
  const int zone = std::min(60, static_cast<int>((longitude_deg + 180.0) / 6.0) + 1);
  return "EPSG:" + std::to_string((latitude_deg >= 0.0 ? 32600 : 32700) + zone);
}

/// Refuses coordinates that are not metres.
///   center  of the raster, in its own coordinates
Result<void> check_crs(const OGRSpatialReference* crs, const Eigen::Vector2d& center, double cell,
                       const std::filesystem::path& file) {
  constexpr double kSmallestMetricCell = 0.01;
  const std::string name = file.filename().string();
  const std::string hint = reprojection_hint(name, utm_zone_at(center.x(), center.y()));
  if (crs == nullptr || crs->IsEmpty()) {
    if (cell < kSmallestMetricCell && std::abs(center.x()) <= 360.0 &&
        std::abs(center.y()) <= 90.0) {
      return refuse(file, "its coordinates look like degrees, expected metres; " + hint);
    }
    return {};
  }
  if (crs->IsGeographic() != 0) {
    return refuse(file, "its coordinates are degrees, expected metres; " + hint);
  }
  if (std::abs(crs->GetLinearUnits() - 1.0) > 1e-9) {
    return refuse(file, "its coordinates are not metres; " +
                            reprojection_hint(name, "EPSG:326NN with the UTM zone NN"));
  }
  return {};
}

/// From the file's statements to the raster of the library, with a local origin near its centre.
Result<Raster> checked_raster(RasterFile stated, const OGRSpatialReference* crs,
                              const std::filesystem::path& file) {
  if (!(stated.cell_x_m > 0.0) || !(stated.cell_y_m > 0.0) || !std::isfinite(stated.cell_x_m) ||
      !std::isfinite(stated.cell_y_m)) {
    return refuse(file, "its cell size is " + std::to_string(stated.cell_x_m) + " x " +
                            std::to_string(stated.cell_y_m) + ", expected a positive number");
  }
  if (!std::isfinite(stated.west_center_m) || !std::isfinite(stated.south_center_m)) {
    return refuse(file, "its position is not a finite number");
  }
  const Eigen::Vector2d first_center(stated.west_center_m, stated.south_center_m);
  const Eigen::Vector2d extent(static_cast<double>(stated.columns - 1) * stated.cell_x_m,
                               static_cast<double>(stated.rows - 1) * stated.cell_y_m);
  const Eigen::Vector2d center = first_center + 0.5 * extent;
  if (const auto metric = check_crs(crs, center, stated.cell_x_m, file); !metric) {
    return tl::unexpected<Error>(metric.error());
  }
  constexpr double kLargestStretch = 1e-4;  // half a cell over 5000 cells
  if (std::abs(stated.cell_x_m - stated.cell_y_m) > kLargestStretch * stated.cell_x_m) {
    return refuse(file, "its cells are " + std::to_string(stated.cell_x_m) + " x " +
                            std::to_string(stated.cell_y_m) +
                            " m, expected squares; resample it, for example: gdalwarp -tr 0.1 0.1 "
                            "-r cubicspline " +
                            file.filename().string() + " square.tif");
  }
  bool any_known = false;
  for (const float height : stated.values) any_known = any_known || !std::isnan(height);
  if (!any_known) return refuse(file, "all its cells are nodata, expected some heights");

  Raster raster;
  raster.map_origin_m = center.array().round();
  raster.elevation.size_x = static_cast<int>(stated.columns);
  raster.elevation.size_y = static_cast<int>(stated.rows);
  raster.elevation.cell_m = stated.cell_x_m;
  raster.elevation.origin_m = first_center - raster.map_origin_m;
  raster.elevation.values = std::move(stated.values);
  return raster;
}

/// The CRS file that may lie beside an ESRI ASCII grid.
Result<OGRSpatialReference> read_prj_beside(const std::filesystem::path& file) {
  OGRSpatialReference crs;
  std::error_code status;
  for (const char* const extension : {".prj", ".PRJ"}) {
    std::filesystem::path beside = file;
    beside.replace_extension(extension);
    if (!std::filesystem::exists(beside, status)) continue;
    const auto text = terrain_internal::read_whole_file(beside);
    if (!text) return tl::unexpected<Error>(text.error());
    const std::unique_ptr<char*, decltype(&CSLDestroy)> lines(
        CSLTokenizeString2(text->c_str(), "\r\n", 0), &CSLDestroy);
    if (crs.importFromESRI(lines.get()) != OGRERR_NONE) {
      return refuse(beside, "is not a coordinate reference system that GDAL understands");
    }
    break;
  }
  return crs;
}

/// Size of the data as the header states it, against the file: a header that lies is found out
/// before any memory is asked for.
Result<void> check_size(GDALDataset& dataset, GDALRasterBand& band,
                        const std::filesystem::path& file) {
  const double cells = static_cast<double>(band.GetXSize()) * band.GetYSize();
  const std::string size =
      std::to_string(band.GetXSize()) + " x " + std::to_string(band.GetYSize());
  if (cells > terrain_internal::kMaxCells) {
    return refuse(file, "its header announces " + size +
                            " cells, more than the 64 million that are read; cut out the part to "
                            "drive over");
  }
  const bool is_tiff = std::string(GDALGetDriverShortName(dataset.GetDriver())) == "GTiff";
  const bool is_compressed = dataset.GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE") != nullptr;
  constexpr double kBestCompression = 1100.0;  // deflate cannot do better than 1032
  const double smallest_bytes = cells * GDALGetDataTypeSizeBytes(band.GetRasterDataType()) /
                                (is_compressed ? kBestCompression : 1.0);
  std::error_code status;
  const auto bytes = static_cast<double>(std::filesystem::file_size(file, status));
  if (is_tiff && !status && smallest_bytes > bytes) {
    return refuse(file, "its header announces " + size +
                            " cells, more than the file can hold: the file is cut off or its "
                            "header wrong");
  }
  return {};
}

/// Reads the one band, rows from south to north.
Result<std::vector<float>> read_values(GDALRasterBand& band, bool north_up,
                                       const std::filesystem::path& file) {
  const int columns = band.GetXSize();
  const int rows = band.GetYSize();
  int has_nodata = 0;
  const double nodata = band.GetNoDataValue(&has_nodata);
  int has_scale = 0;
  int has_offset = 0;
  const double stated_scale = band.GetScale(&has_scale);
  const double stated_offset = band.GetOffset(&has_offset);
  const double scale = has_scale != 0 ? stated_scale : 1.0;
  const double offset = has_offset != 0 ? stated_offset : 0.0;

  std::vector<float> values(static_cast<std::size_t>(columns) * rows);
  std::vector<double> line(columns);
  for (int row = 0; row < rows; ++row) {
    if (band.RasterIO(GF_Read, 0, row, columns, 1, line.data(), columns, 1, GDT_Float64, 0, 0,
                      nullptr) != CE_None) {
      return refuse(file, "row " + std::to_string(row + 1) + " of " + std::to_string(rows) +
                              " cannot be read, the file is cut off or damaged (" +
                              QuietGdal::last_words() + ")");
    }
    float* const out =
        values.data() + static_cast<std::size_t>(north_up ? rows - 1 - row : row) * columns;
    for (int i = 0; i < columns; ++i) {
      // Nodata of float bands is compared as float: GDAL keeps it as the nearest double.
      const bool unknown =
          !std::isfinite(line[i]) ||
          (has_nodata != 0 && static_cast<float>(line[i]) == static_cast<float>(nodata));
      out[i] = unknown ? std::numeric_limits<float>::quiet_NaN()
                       : static_cast<float>(scale * line[i] + offset);
    }
  }
  return values;
}

Result<Raster> read_with_gdal(const std::filesystem::path& file) {
  const std::unique_ptr<GDALDataset> dataset(
      GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  if (!dataset) {
    return refuse(file, "is not a raster that GDAL reads (" + QuietGdal::last_words() + ")");
  }
  if (dataset->GetRasterCount() != 1) {
    return refuse(file, "has " + std::to_string(dataset->GetRasterCount()) +
                            " bands, expected one of heights (pick it with gdal_translate -b)");
  }
  std::array<double, 6> transform{};
  if (dataset->GetGeoTransform(transform.data()) != CE_None) {
    return refuse(file, "states no cell size (no geotransform)");
  }
  for (const double entry : transform) {
    if (!std::isfinite(entry)) return refuse(file, "its cell size or position is not a number");
  }
  if (transform[2] != 0.0 || transform[4] != 0.0) {
    return refuse(file,
                  "its rows do not run west to east (rotated grid); make it north-up with "
                  "gdalwarp " +
                      file.filename().string() + " north_up.tif");
  }
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  const std::string height_unit = band.GetUnitType();
  if (!height_unit.empty() && height_unit != "m" && height_unit != "metre" &&
      height_unit != "meter" && height_unit != "meters" && height_unit != "metres") {
    return refuse(file, "its heights are in '" + height_unit + "', expected metres");
  }
  if (const auto fits = check_size(*dataset, band, file); !fits) {
    return tl::unexpected<Error>(fits.error());
  }

  const bool north_up = transform[5] < 0.0;
  RasterFile stated;
  stated.columns = band.GetXSize();
  stated.rows = band.GetYSize();
  stated.cell_x_m = transform[1];
  stated.cell_y_m = std::abs(transform[5]);
  // The transform gives the outer corner of the first cell of the first row.
  stated.west_center_m = transform[0] + 0.5 * transform[1];
  const double first_row_center = transform[3] + 0.5 * transform[5];
  stated.south_center_m =
      north_up ? first_row_center - static_cast<double>(stated.rows - 1) * stated.cell_y_m
               : first_row_center;
  Result<std::vector<float>> values = read_values(band, north_up, file);
  if (!values) return tl::unexpected<Error>(values.error());
  stated.values = std::move(*values);
  return checked_raster(std::move(stated), dataset->GetSpatialRef(), file);
}

/// The first bytes of a file; empty for what is not a regular file.
std::string first_bytes(const std::filesystem::path& file) {
  std::string head(256, '\0');
  std::error_code status;
  if (!std::filesystem::is_regular_file(file, status)) return {};
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"),
                                                           &std::fclose);
  if (!in) return {};
  head.resize(std::fread(head.data(), 1, head.size(), in.get()));
  return head;
}

}  // namespace

Result<Raster> read_raster(const std::filesystem::path& file) {
  std::error_code status;
  if (!std::filesystem::exists(file, status)) return refuse(file, "there is no such file");

  const QuietGdal quiet;
  const std::string extension = file.extension().string();
  if (extension == ".asc" || extension == ".ASC" ||
      terrain_internal::looks_like_esri_ascii(first_bytes(file))) {
    const auto text = terrain_internal::read_whole_file(file);
    if (!text) return tl::unexpected<Error>(text.error());
    auto stated = terrain_internal::parse_esri_ascii(*text, file);
    if (!stated) return tl::unexpected<Error>(stated.error());
    const auto crs = read_prj_beside(file);
    if (!crs) return tl::unexpected<Error>(crs.error());
    return checked_raster(std::move(*stated), &*crs, file);
  }
  return read_with_gdal(file);
}

Result<void> write_esri_ascii(const Raster& raster, const std::filesystem::path& file) {
  const Grid& grid = raster.elevation;
  WEX_EXPECTS(grid.values.size() == static_cast<std::size_t>(grid.size_x) * grid.size_y);
  RasterFile stated;
  stated.columns = grid.size_x;
  stated.rows = grid.size_y;
  stated.cell_x_m = stated.cell_y_m = grid.cell_m;
  stated.west_center_m = raster.map_origin_m.x() + grid.origin_m.x();
  stated.south_center_m = raster.map_origin_m.y() + grid.origin_m.y();
  stated.values = grid.values;
  return terrain_internal::write_whole_file(file, terrain_internal::format_esri_ascii(stated));
}

}  // namespace wex
