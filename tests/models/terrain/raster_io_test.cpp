#include "models/terrain/raster_io.hpp"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/models/terrain/terrain_fixtures.hpp"

namespace wex {
namespace {

/// Header of a 4 x 3 grid with cells of 0.5 m.
const std::string kHeader = "ncols 4\nnrows 3\nxllcorner 10\nyllcorner 20\ncellsize 0.5\n";
const std::string kHeights = "1 2 3 4\n5 6 7 8\n9 10 11 12\n";

/// The message a file is refused with; nothing may be printed meanwhile.
std::string refusal(const std::filesystem::path& file) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  const auto raster = read_raster(file);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_FALSE(raster.has_value());
  if (raster) return {};
  EXPECT_EQ(raster.error().code, ErrorCode::kBadInput);
  EXPECT_NE(raster.error().message.find(file.string()), std::string::npos) << "names the file";
  EXPECT_EQ(raster.error().message.find('\n'), std::string::npos) << "one sentence";
  return raster.error().message;
}

#define EXPECT_REFUSED(file, words)                                              \
  do {                                                                           \
    const std::string message = refusal(file);                                   \
    EXPECT_NE(message.find(words), std::string::npos) << "message: " << message; \
  } while (false)

struct TiffOptions {
  int size_x = 8, size_y = 6;
  std::array<double, 6> transform{429558.0, 0.5, 0.0, 5150659.0, 0.0, -0.5};
  int epsg = 0;
  int bands = 1;
  bool compressed = false;
  std::string unit;
  double nodata = -32768.0;
  std::function<float(int i, int row)> height = [](int i, int row) {
    return static_cast<float>(100 * row + i);
  };
};

std::filesystem::path write_tiff(const std::filesystem::path& file, const TiffOptions& options) {
  GDALAllRegister();
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  char** creation = nullptr;
  if (options.compressed) creation = CSLSetNameValue(creation, "COMPRESS", "DEFLATE");
  GDALDataset* const dataset = driver->Create(file.c_str(), options.size_x, options.size_y,
                                              options.bands, GDT_Float32, creation);
  CSLDestroy(creation);
  std::array<double, 6> transform = options.transform;
  dataset->SetGeoTransform(transform.data());
  if (options.epsg != 0) {
    OGRSpatialReference crs;
    crs.importFromEPSG(options.epsg);
    dataset->SetSpatialRef(&crs);
  }
  for (int band = 1; band <= options.bands; ++band) {
    GDALRasterBand& out = *dataset->GetRasterBand(band);
    out.SetNoDataValue(options.nodata);
    if (!options.unit.empty()) out.SetUnitType(options.unit.c_str());
    std::vector<float> line(options.size_x);
    for (int row = 0; row < options.size_y; ++row) {
      for (int i = 0; i < options.size_x; ++i) line[i] = options.height(i, row);
      EXPECT_EQ(out.RasterIO(GF_Write, 0, row, options.size_x, 1, line.data(), options.size_x, 1,
                             GDT_Float32, 0, 0, nullptr),
                CE_None);
    }
  }
  GDALClose(dataset);
  return file;
}

TEST(EsriAsciiGrid, IsReadFromNorthToSouthAtCellCentres) {
  const ScratchFolder folder("raster");
  const auto raster = read_raster(folder.with("a.asc", kHeader + kHeights));
  ASSERT_TRUE(raster.has_value()) << raster.error().message;
  const Grid& grid = raster->elevation;
  EXPECT_EQ(grid.size_x, 4);
  EXPECT_EQ(grid.size_y, 3);
  EXPECT_EQ(grid.cell_m, 0.5);
  EXPECT_EQ(grid.at(0, 0), 9.0F);  // south-west
  EXPECT_EQ(grid.at(3, 2), 4.0F);  // north-east
  EXPECT_EQ(raster->map_origin_m, Eigen::Vector2d(11.0, 21.0));
  EXPECT_NEAR((grid.origin_m + raster->map_origin_m - Eigen::Vector2d(10.25, 20.25)).norm(), 0.0,
              1e-12);
}

TEST(EsriAsciiGrid, MayStateCellCentresAnyCaseNodataAndNan) {
  const ScratchFolder folder("raster");
  const auto raster = read_raster(
      folder.with("a.asc",
                  "NCOLS 2\r\nNROWS 2\r\nXLLCENTER 10\r\nYLLCENTER -20\r\nCELLSIZE 1\r\n"
                  "nodata_value -1\r\n+1.5 -1\r\nnan 2e-1\r\n"));
  ASSERT_TRUE(raster.has_value()) << raster.error().message;
  EXPECT_EQ(raster->elevation.at(0, 1), 1.5F);
  EXPECT_TRUE(std::isnan(raster->elevation.at(1, 1)));
  EXPECT_TRUE(std::isnan(raster->elevation.at(0, 0)));
  EXPECT_EQ(raster->elevation.at(1, 0), 0.2F);
  EXPECT_EQ(raster->elevation.origin_m + raster->map_origin_m, Eigen::Vector2d(10.0, -20.0));
}

TEST(EsriAsciiGrid, IsKnownByItsFirstWordWhateverItsName) {
  const ScratchFolder folder("raster");
  EXPECT_TRUE(read_raster(folder.with("a.dem.txt", kHeader + kHeights)).has_value());
}

TEST(EsriAsciiGrid, ReadsBackWhatWasWrittenBitForBit) {
  const ScratchFolder folder("raster");
  Raster raster;
  raster.elevation = make_grid(7, 5, 0.1, [](double x, double y) { return std::sin(9 * x + y); });
  raster.elevation.at(3, 2) = kUnknown;
  raster.elevation.at(4, 2) = 1e-7F;
  raster.map_origin_m << 429588.0, 5150629.0;
  raster.elevation.origin_m << -0.3, -0.2;
  ASSERT_TRUE(write_esri_ascii(raster, folder / "a.asc").has_value());
  const auto read = read_raster(folder / "a.asc");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->map_origin_m, raster.map_origin_m);
  EXPECT_NEAR((read->elevation.origin_m - raster.elevation.origin_m).norm(), 0.0, 1e-6);
  EXPECT_EQ(read->elevation.cell_m, 0.1);
  for (std::size_t cell = 0; cell < raster.elevation.values.size(); ++cell) {
    const float expected = raster.elevation.values[cell];
    const float actual = read->elevation.values[cell];
    EXPECT_TRUE(expected == actual || (std::isnan(expected) && std::isnan(actual))) << cell;
  }
}

TEST(EsriAsciiGrid, IsUnderstoodByGdalTheSameWay) {
  const ScratchFolder folder("raster");
  const auto file = folder.with("a.asc", kHeader + kHeights);
  GDALAllRegister();
  GDALDataset* const dataset = GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY);
  ASSERT_NE(dataset, nullptr);
  std::array<double, 6> transform{};
  dataset->GetGeoTransform(transform.data());
  float north_west = 0.0F;
  EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 1, 1, &north_west, 1, 1, GDT_Float32,
                                                0, 0, nullptr),
            CE_None);
  GDALClose(dataset);
  const auto raster = read_raster(file);
  ASSERT_TRUE(raster.has_value());
  EXPECT_EQ(raster->elevation.at(0, 2), north_west);
  EXPECT_NEAR(raster->map_origin_m.x() + raster->elevation.origin_m.x(),
              transform[0] + 0.5 * transform[1], 1e-9);
}

TEST(ReadRaster, RefusesAMissingFile) {
  const ScratchFolder folder("raster");
  EXPECT_REFUSED(folder / "none.asc", "there is no such file");
  EXPECT_REFUSED(folder / "none.tif", "there is no such file");
}

TEST(ReadRaster, RefusesATruncatedGrid) {
  const ScratchFolder folder("raster");
  EXPECT_REFUSED(folder.with("a.asc", kHeader + "1.0 2.0 3.0 4.0\n5.0 6.0 7.0\n"),
                 "line 8: the file ends after 7 of 12 heights");
  EXPECT_REFUSED(folder.with("b.asc", kHeader), "line 6: the file ends after 0 of 12 heights");
  EXPECT_REFUSED(folder.with("c.asc", "ncols 4\nnrows"), "line 2: nrows is ''");
  EXPECT_REFUSED(folder.with("d.asc", ""), "the header has no ncols");
}

TEST(ReadRaster, RefusesLettersInAGridNamingTheLine) {
  const ScratchFolder folder("raster");
  EXPECT_REFUSED(folder.with("a.asc", kHeader + "1 2 3 4\n5 six 7 8\n9 10 11 12\n"),
                 "line 7: found 'six', expected a height");
  EXPECT_REFUSED(folder.with("b.asc", kHeader + "1 2 3 4\n5 6 7 8\n9 10 11 1,2\n"),
                 "line 8: found '1,2'");
  EXPECT_REFUSED(folder.with("c.asc", kHeader + "1 2 3 inf\n5 6 7 8\n9 10 11 12\n"),
                 "line 6: found 'inf'");
  EXPECT_REFUSED(folder.with("d.asc", "ncols four\nnrows 3\n"), "line 1: ncols is 'four'");
  EXPECT_REFUSED(folder.with("e.asc", "ncols 4\nrows 3\n"), "line 2: found 'rows', expected");
}

TEST(ReadRaster, RefusesMoreHeightsThanAnnounced) {
  const ScratchFolder folder("raster");
  EXPECT_REFUSED(folder.with("a.asc", kHeader + kHeights + "13\n"),
                 "line 9: found '13' after the last of 12 heights");
}

TEST(ReadRaster, RefusesCellSizesThatAreNoPositiveNumber) {
  const ScratchFolder folder("raster");
  const auto with_cell = [&](const std::string& cell) {
    return folder.with(
        "a.asc", "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize " + cell + "\n" + kHeights);
  };
  EXPECT_REFUSED(with_cell("nan"), "line 5: cellsize is 'nan', expected a finite number");
  EXPECT_REFUSED(with_cell("inf"), "line 5: cellsize is 'inf'");
  EXPECT_REFUSED(with_cell("-0.1"), "line 5: cellsize is not positive");
  EXPECT_REFUSED(with_cell("0"), "line 5: cellsize is not positive");
  TiffOptions options;
  options.transform = {0.0, std::nan(""), 0.0, 0.0, 0.0, -0.5};
  EXPECT_REFUSED(write_tiff(folder / "nan.tif", options), "not a number");
  options.transform = {0.0, -0.5, 0.0, 0.0, 0.0, -0.5};
  EXPECT_REFUSED(write_tiff(folder / "negative.tif", options), "expected a positive number");
}

TEST(ReadRaster, RefusesHeadersWithMissingDoubleOrOddEntries) {
  const ScratchFolder folder("raster");
  EXPECT_REFUSED(folder.with("a.asc", "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\n" + kHeights),
                 "the header has no cellsize");
  EXPECT_REFUSED(folder.with("b.asc", "ncols 4\nnrows 3\nxllcorner 0\ncellsize 1\n" + kHeights),
                 "neither yllcorner nor yllcenter");
  EXPECT_REFUSED(folder.with("c.asc", "ncols 4\n" + kHeader + kHeights), "ncols is given twice");
  EXPECT_REFUSED(folder.with("d.asc", "ncols 4\n"), "the header has no nrows");
  EXPECT_REFUSED(folder.with("g.asc", "ncols 4.5\nnrows 3\n"), "line 1: ncols is not a positive");
  EXPECT_REFUSED(folder.with("e.asc", "ncols -4\nnrows 3\n"), "line 1: ncols is not a positive");
  EXPECT_REFUSED(folder.with("f.asc", "ncols 4\nnrows 3\nxllcorner nan\nyllcorner 0\ncellsize 1\n"),
                 "line 3: xllcorner is 'nan'");
}

TEST(ReadRaster, RefusesAHeaderThatLiesAboutAGigabyteBeforeTakingTheMemory) {
  const ScratchFolder folder("raster");
  EXPECT_REFUSED(folder.with("a.asc",
                             "ncols 20000\nnrows 20000\nxllcorner 0\nyllcorner 0\n"
                             "cellsize 0.1\n1 2 3\n"),
                 "the header announces 20000 x 20000 cells, more than the file's");
  EXPECT_REFUSED(folder.with("b.asc",
                             "ncols 999999999999999\nnrows 999999999999999\nxllcorner "
                             "0\nyllcorner 0\ncellsize 0.1\n1 2 3\n"),
                 "more than the file's");

  // A TIFF whose image length and strip size are overwritten: 8 x 6 becomes 8 x 40,000,000.
  const auto file = write_tiff(folder / "c.tif", {});
  std::stringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  std::string bytes = text.str();
  const auto patch = [&](unsigned char tag) {
    // Little-endian directory entry: tag, type SHORT, count 1, value.
    const std::string entry{static_cast<char>(tag), 1, 3, 0, 1, 0, 0, 0};
    const std::size_t at = bytes.find(entry);
    ASSERT_NE(at, std::string::npos);
    const std::uint32_t length = 4000000;
    bytes[at + 2] = 4;  // type LONG
    for (int k = 0; k < 4; ++k) bytes[at + 8 + k] = static_cast<char>(length >> (8 * k));
  };
  patch(0x01);  // 257, image length
  patch(0x16);  // 278, rows per strip
  EXPECT_REFUSED(folder.with("c.tif", bytes), "more than the file can hold");
}

TEST(ReadRaster, RefusesDegreesAndSaysHowToReproject) {
  const ScratchFolder folder("raster");
  TiffOptions options;
  options.epsg = 4326;
  options.transform = {7.6, 0.001, 0.0, 47.4, 0.0, -0.001};
  EXPECT_REFUSED(write_tiff(folder / "a.tif", options),
                 "degrees, expected metres; reproject it, for example: gdalwarp -t_srs EPSG:32632 "
                 "-tr 0.1 0.1 -r cubicspline a.tif");
  options.transform = {-70.6, 0.001, 0.0, -33.4, 0.0, -0.001};
  EXPECT_REFUSED(write_tiff(folder / "b.tif", options), "EPSG:32719");

  const auto grid = folder.with("c.asc", kHeader + kHeights);
  static_cast<void>(folder.with(
      "c.prj",
      R"(GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["Degree",0.017453292519943295]])"));
  EXPECT_REFUSED(grid, "degrees, expected metres");
  EXPECT_REFUSED(folder.with("d.asc",
                             "ncols 4\nnrows 3\nxllcorner 7.5\nyllcorner 47\n"
                             "cellsize 0.00028\n" +
                                 kHeights),
                 "look like degrees");
  static_cast<void>(folder.with("e.prj", "no such thing"));
  const auto unknown_crs = folder.with("e.asc", kHeader + kHeights);
  const auto refused = read_raster(unknown_crs);
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().message.find("e.prj: is not a coordinate reference system"),
            std::string::npos);
}

TEST(ReadRaster, RefusesFeet) {
  const ScratchFolder folder("raster");
  TiffOptions options;
  options.epsg = 2263;  // New York Long Island, US survey feet
  EXPECT_REFUSED(write_tiff(folder / "a.tif", options), "coordinates are not metres");
  options.epsg = 26915;
  options.unit = "ft";
  EXPECT_REFUSED(write_tiff(folder / "b.tif", options), "heights are in 'ft'");
}

TEST(ReadRaster, RefusesRotatedAndOblongCells) {
  const ScratchFolder folder("raster");
  TiffOptions options;
  options.transform = {0.0, 0.5, 0.01, 0.0, 0.01, -0.5};
  EXPECT_REFUSED(write_tiff(folder / "a.tif", options), "rotated grid");
  options.transform = {0.0, 0.5, 0.0, 0.0, 0.0, -0.6};
  EXPECT_REFUSED(write_tiff(folder / "b.tif", options), "expected squares");
  EXPECT_REFUSED(
      folder.with("c.asc", "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ndx 1\ndy 2\n" + kHeights),
      "expected squares");
}

TEST(ReadRaster, RefusesAMapWithoutAnyHeight) {
  const ScratchFolder folder("raster");
  const std::string nothing = "-9999 -9999 -9999 -9999\n";
  EXPECT_REFUSED(folder.with("a.asc", kHeader + nothing + nothing + nothing),
                 "all its cells are nodata");
  TiffOptions options;
  options.height = [](int, int) { return -32768.0F; };
  EXPECT_REFUSED(write_tiff(folder / "b.tif", options), "all its cells are nodata");
}

TEST(ReadRaster, RefusesWhatIsNoRasterOrCannotBeRead) {
  const ScratchFolder folder("raster");
  EXPECT_REFUSED(folder.with("a.tif", "not a raster at all"), "is not a raster that GDAL reads");
  std::filesystem::create_directory(folder / "b.asc");
  EXPECT_REFUSED(folder / "b.asc", "is a folder or device, expected a file");
  std::filesystem::create_directory(folder / "c");
  EXPECT_REFUSED(folder / "c", "is not a raster that GDAL reads");
}

TEST(ReadRaster, RefusesATiffThatIsCutOff) {
  const ScratchFolder folder("raster");
  TiffOptions options;
  options.size_x = 300;
  options.size_y = 200;
  options.compressed = true;
  options.height = [](int i, int row) { return std::sin(static_cast<float>(i * 7919 + row)); };
  const auto file = write_tiff(folder / "a.tif", options);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) * 2 / 3);
  EXPECT_REFUSED(file, "a.tif: ");
  options.compressed = false;
  const auto plain = write_tiff(folder / "b.tif", options);
  std::filesystem::resize_file(plain, std::filesystem::file_size(plain) / 2);
  EXPECT_REFUSED(plain, "more than the file can hold");
}

TEST(ReadRaster, RefusesSeveralBands) {
  const ScratchFolder folder("raster");
  TiffOptions options;
  options.bands = 3;
  EXPECT_REFUSED(write_tiff(folder / "a.tif", options), "has 3 bands, expected one");
}

TEST(ReadRaster, ReadsGeoTiffWithLargeCoordinatesPrecisely) {
  const ScratchFolder folder("raster");
  TiffOptions options;
  options.epsg = 26915;
  options.compressed = true;
  options.unit = "metre";
  options.height = [](int i, int row) {
    return i == 2 && row == 1 ? -32768.0F : static_cast<float>(100 * row + i);
  };
  const auto raster = read_raster(write_tiff(folder / "a.tif", options));
  ASSERT_TRUE(raster.has_value()) << raster.error().message;
  const Grid& grid = raster->elevation;
  EXPECT_EQ(grid.at(0, 0), 500.0F);  // last row of the file
  EXPECT_EQ(grid.at(7, 5), 7.0F);
  EXPECT_TRUE(std::isnan(grid.at(2, 4)));
  EXPECT_EQ(raster->map_origin_m, Eigen::Vector2d(429560.0, 5150658.0));
  EXPECT_NEAR((grid.origin_m - Eigen::Vector2d(-1.75, -1.75)).norm(), 0.5, 0.5);
  EXPECT_NEAR(
      (grid.origin_m + raster->map_origin_m - Eigen::Vector2d(429558.25, 5150656.25)).norm(), 0.0,
      1e-9);
}

TEST(ReadRaster, TurnsRastersThatRunFromSouthToNorth) {
  const ScratchFolder folder("raster");
  TiffOptions options;
  options.transform = {100.0, 0.5, 0.0, 200.0, 0.0, 0.5};
  const auto raster = read_raster(write_tiff(folder / "a.tif", options));
  ASSERT_TRUE(raster.has_value()) << raster.error().message;
  EXPECT_EQ(raster->elevation.at(0, 0), 0.0F);
  EXPECT_EQ(raster->elevation.at(0, 5), 500.0F);
  EXPECT_NEAR(raster->map_origin_m.y() + raster->elevation.origin_m.y(), 200.25, 1e-9);
}

TEST(WriteEsriAscii, RefusesAFolderThatIsNotThereAndLeavesNothingBehind) {
  const ScratchFolder folder("raster");
  Raster raster;
  raster.elevation = make_grid(4, 4, 0.1, [](double, double) { return 0.0; });
  const auto written = write_esri_ascii(raster, folder / "none/a.asc");
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().code, ErrorCode::kBadInput);
  EXPECT_NE(written.error().message.find("cannot be written"), std::string::npos);

  std::filesystem::create_directory(folder / "taken.asc");
  std::filesystem::create_directory(folder / "taken.asc/inside");
  EXPECT_FALSE(write_esri_ascii(raster, folder / "taken.asc").has_value());
  int entries = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "")) {
    static_cast<void>(entry);
    ++entries;
  }
  EXPECT_EQ(entries, 1);
}

}  // namespace
}  // namespace wex
