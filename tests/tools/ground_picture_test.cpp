#include "tools/wex/ground_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace wex::app {
namespace {

Grid slope_along_x(int size, double rise_per_m) {
  Grid grid;
  grid.size_x = grid.size_y = size;
  for (int j = 0; j < size; ++j) {
    for (int i = 0; i < size; ++i) {
      grid.values.push_back(static_cast<float>(rise_per_m * grid.cell_m * i));
    }
  }
  return grid;
}

TEST(ContourPieces, LieOnTheirLevel) {
  const Grid grid = slope_along_x(50, 0.5);  // 0 to 2.45 m over 4.9 m
  const auto pieces = contour_pieces(grid, {0, 0, 50, 50}, 0.3);
  EXPECT_EQ(pieces.size(), 8u * 49u);  // levels 0.3 to 2.4, one piece per row of cells
  for (const auto& [a, b] : pieces) {
    for (const double x : {a.x(), b.x()}) {
      const double level = 0.5 * x / 0.3;
      EXPECT_NEAR(level, std::round(level), 1e-5);
    }
  }
}

TEST(ContourPieces, AvoidUnknownCellsAndFlatGround) {
  Grid grid = slope_along_x(10, 0.0);
  EXPECT_TRUE(contour_pieces(grid, {0, 0, 10, 10}, 0.3).empty());
  grid = slope_along_x(10, 5.0);
  for (float& value : grid.values) value = std::nanf("");
  EXPECT_TRUE(contour_pieces(grid, {0, 0, 10, 10}, 0.3).empty());
}

TEST(GroundPixels, ShowUnknownAndUntraversableGroundApart) {
  Grid grid = slope_along_x(60, 0.0);
  grid.at(30, 30) = std::nanf("");
  const TerrainMap terrain = *TerrainMap::build(std::move(grid));
  const auto pixels = ground_pixels(terrain, {0, 0, 60, 60});
  ASSERT_EQ(pixels.size(), 3600u);
  const auto at = [&](int i, int j) { return pixels[static_cast<std::size_t>((59 - j) * 60 + i)]; };
  EXPECT_TRUE(terrain.traversable_at({1.5, 1.5}));
  EXPECT_FALSE(terrain.traversable_at({0.1, 0.1}));
  EXPECT_NE(at(15, 15), at(30, 30));
  EXPECT_NE(at(15, 15), at(1, 1));
  EXPECT_GT(at(1, 1) >> 16, (at(1, 1) >> 8 & 0xff) * 13 / 10);  // reddish
}

TEST(TintRange, SpansAtLeastHalfAMetre) {
  const auto [lo, hi] = tint_range_m(slope_along_x(10, 0.0), {0, 0, 10, 10});
  EXPECT_NEAR(hi - lo, 0.5, 1e-9);
  const auto [low, high] = height_range_m(slope_along_x(11, 2.0), {0, 0, 11, 11});
  EXPECT_NEAR(low, 0.0, 1e-6);
  EXPECT_NEAR(high, 2.0, 1e-6);
}

TEST(Ticks, AreRoundAndCoverTheRange) {
  EXPECT_EQ(ticks(0.0, 10.0, 5), (std::vector<double>{0.0, 2.0, 4.0, 6.0, 8.0, 10.0}));
  EXPECT_EQ(ticks(-1.2, 1.2, 4), (std::vector<double>{-1.0, 0.0, 1.0}));
  EXPECT_EQ(tick_label(0.25, 0.05), "0.25");
  EXPECT_EQ(tick_label(-0.0, 5.0), "0");
  EXPECT_EQ(tick_label(429600.0, 10.0), "429600");
}

}  // namespace
}  // namespace wex::app
