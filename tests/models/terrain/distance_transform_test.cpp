#include "models/terrain/internal/distance_transform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace wex::terrain_internal {
namespace {

std::vector<std::uint8_t> random_mask(int cells, double share, unsigned seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution marked(share);
  std::vector<std::uint8_t> mask(cells);
  for (auto& cell : mask) cell = marked(random) ? 1 : 0;
  return mask;
}

double squared_by_search(const std::vector<std::uint8_t>& mask, int size_x, int i, int j) {
  double best = std::numeric_limits<double>::infinity();
  for (int cell = 0; cell < static_cast<int>(mask.size()); ++cell) {
    if (mask[cell] == 0) continue;
    const double dx = cell % size_x - i;
    const double dy = cell / size_x - j;
    best = std::min(best, dx * dx + dy * dy);
  }
  return best;
}

class DistanceTransformOfRandomMasks : public testing::TestWithParam<double> {};

TEST_P(DistanceTransformOfRandomMasks, EqualsAnExhaustiveSearch) {
  constexpr int kSizeX = 37;
  constexpr int kSizeY = 23;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto mask = random_mask(kSizeX * kSizeY, GetParam(), seed);
    const DistanceTransform transform = transform_distance(mask, kSizeX, kSizeY);
    for (int j = 0; j < kSizeY; ++j) {
      for (int i = 0; i < kSizeX; ++i) {
        const int cell = j * kSizeX + i;
        const double expected = squared_by_search(mask, kSizeX, i, j);
        ASSERT_EQ(transform.squared_cells[cell], expected) << "seed " << seed;
        const int nearest = transform.nearest[cell];
        if (nearest < 0) {
          ASSERT_EQ(expected, std::numeric_limits<double>::infinity());
          continue;
        }
        ASSERT_EQ(mask[nearest], 1);
        ASSERT_EQ(std::pow(nearest % kSizeX - i, 2) + std::pow(nearest / kSizeX - j, 2), expected);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(SparseToDense, DistanceTransformOfRandomMasks,
                         testing::Values(0.0, 0.002, 0.02, 0.3, 0.97, 1.0));

TEST(SignedDistance, IsMeasuredToTheBorderBetweenCells) {
  // A row of cells with the third and fourth outside, in a map too tall to matter.
  constexpr int kSizeX = 10;
  constexpr int kSizeY = 41;
  std::vector<std::uint8_t> inside(kSizeX * kSizeY, 1);
  for (int j = 0; j < kSizeY; ++j) inside[j * kSizeX + 2] = inside[j * kSizeX + 3] = 0;
  const auto distance = signed_distance(inside, kSizeX, kSizeY, 0.1);
  const std::vector<float> expected{0.05F, 0.05F, -0.05F, -0.05F, 0.05F,
                                    0.15F, 0.25F, 0.25F,  0.15F,  0.05F};
  for (int i = 0; i < kSizeX; ++i) {
    EXPECT_NEAR(distance[20 * kSizeX + i], expected[i], 1e-6) << i;
  }
}

TEST(SignedDistance, TakesTheGroundBeyondTheMapAsOutside) {
  const std::vector<std::uint8_t> inside(9 * 9, 1);
  const auto distance = signed_distance(inside, 9, 9, 0.5);
  EXPECT_NEAR(distance[0], 0.25, 1e-6);
  EXPECT_NEAR(distance[4 * 9 + 4], 2.25, 1e-6);
}

TEST(SignedDistance, OfAMapWithoutInsideIsMinusItsDiagonal) {
  const auto distance = signed_distance(std::vector<std::uint8_t>(12, 0), 3, 4, 2.0);
  for (const float value : distance) EXPECT_FLOAT_EQ(value, -10.0F);
}

}  // namespace
}  // namespace wex::terrain_internal
