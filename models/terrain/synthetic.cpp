#include "models/terrain/synthetic.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "models/terrain/internal/gradient_noise.hpp"

namespace wex {

using terrain_internal::GradientNoise;
using terrain_internal::RandomStream;

namespace {

constexpr double kCell_m = 0.1;
constexpr double kDegree = std::numbers::pi / 180.0;

/// Outer size of a map, and the straight line the task is drawn around.
struct Layout {
  double size_x_m = 30.0, size_y_m = 16.0;
  double route_x_m = 15.0;  ///< from start to goal along x, centred
  double route_y_m = 0.0;   ///< from start to goal along y, centred
};

/// What the seed decides about a terrain, apart from the noise.
struct Drawn {
  Task task;
  double skew_rad = 0.0;  ///< of an obstacle, about the map's middle
};

enum Stream : std::uint64_t { kTaskStream = 1, kNoiseStream = 2 };

Drawn draw(const Layout& layout, std::uint64_t seed) {
  constexpr double kOffset_m = 1.0;
  constexpr double kYaw_rad = 10.0 * kDegree;
  constexpr double kSkew_rad = 5.0 * kDegree;
  RandomStream random(seed, kTaskStream);
  const auto pose = [&](double side) {
    const double y_offset = random.uniform(-kOffset_m, kOffset_m);
    const double yaw = random.uniform(-kYaw_rad, kYaw_rad);
    return Pose2{0.5 * layout.size_x_m + 0.5 * side * layout.route_x_m,
                 0.5 * layout.size_y_m + 0.5 * side * layout.route_y_m + y_offset, yaw};
  };
  Drawn drawn;
  drawn.task.start = pose(-1.0);
  drawn.task.goal = pose(1.0);
  drawn.skew_rad = random.uniform(-kSkew_rad, kSkew_rad);
  return drawn;
}

/// Height over the position along and across the obstacle, both from the map's middle.
using Profile = std::function<double(double along_m, double across_m)>;

/// Heights of a profile turned by `skew_rad` about the map's middle, to the millimetre (so that
/// files stay small and round-off between platforms disappears).
Raster rasterise(const Layout& layout, double skew_rad, const Profile& profile) {
  Raster raster;
  Grid& grid = raster.elevation;
  grid.cell_m = kCell_m;
  grid.size_x = static_cast<int>(std::lround(layout.size_x_m / kCell_m));
  grid.size_y = static_cast<int>(std::lround(layout.size_y_m / kCell_m));
  grid.values.resize(static_cast<std::size_t>(grid.size_x) * grid.size_y);
  const double c = std::cos(skew_rad);
  const double s = std::sin(skew_rad);
  for (int j = 0; j < grid.size_y; ++j) {
    for (int i = 0; i < grid.size_x; ++i) {
      const double x = (i + 0.5) * kCell_m - 0.5 * layout.size_x_m;
      const double y = (j + 0.5) * kCell_m - 0.5 * layout.size_y_m;
      const double height = profile(c * x + s * y, c * y - s * x);
      grid.at(i, j) = static_cast<float>(std::round(height * 1e3) / 1e3);
    }
  }
  // The map frame has its zero at the outer corner; the local one at the middle.
  raster.map_origin_m << std::round(0.5 * layout.size_x_m), std::round(0.5 * layout.size_y_m);
  grid.origin_m = Eigen::Vector2d::Constant(0.5 * kCell_m) - raster.map_origin_m;
  return raster;
}

SyntheticTerrain with_obstacle(const Layout& layout, std::uint64_t seed, const Profile& profile) {
  const Drawn drawn = draw(layout, seed);
  return {rasterise(layout, drawn.skew_rad, profile), drawn.task};
}

SyntheticTerrain without_obstacle(const Layout& layout, std::uint64_t seed,
                                  const Profile& profile) {
  return {rasterise(layout, 0.0, profile), draw(layout, seed).task};
}

constexpr double kPitDepth_m = 2.0;

/// Ground over a pit across the whole map, with a strip of ground across it.
///   strip_width_m  0 for none
Profile pit(double length_m, double strip_width_m) {
  return [=](double along, double across) {
    const bool in_pit = std::abs(along) < 0.5 * length_m;
    const bool on_strip = std::abs(across) < 0.5 * strip_width_m;
    return in_pit && !on_strip ? -kPitDepth_m : 0.0;
  };
}

Profile block(double length_m, double height_m) {
  return [=](double along, double) { return std::abs(along) < 0.5 * length_m ? height_m : 0.0; };
}

SyntheticTerrain make_flat(double, std::uint64_t seed) {
  return without_obstacle({}, seed, [](double, double) { return 0.0; });
}

SyntheticTerrain make_rough(double difficulty, std::uint64_t seed) {
  constexpr int kOctaves = 4;
  constexpr double kLongestWave_m = 9.0;
  constexpr double kGain = 0.4;
  const double amplitude_m = std::lerp(0.25, 2.0, difficulty);
  RandomStream random(seed, kNoiseStream);
  std::vector<GradientNoise> octaves;
  for (int octave = 0; octave < kOctaves; ++octave) {
    octaves.emplace_back(static_cast<std::uint64_t>(random.uniform(0.0, 0x1p53)));
  }
  const Profile noise = [&](double x, double y) {
    double sum = 0.0;
    double weight = 1.0;
    double frequency = 1.0 / kLongestWave_m;
    for (const GradientNoise& octave : octaves) {
      sum += weight * octave.at(frequency * x, frequency * y);
      weight *= kGain;
      frequency *= 2.0;
    }
    return sum;
  };
  // The highest and lowest point of the map become plus and minus the amplitude.
  const Layout layout;
  double lowest = noise(0.0, 0.0);
  double highest = lowest;
  without_obstacle(layout, seed, [&](double x, double y) {
    const double height = noise(x, y);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
    return height;
  });
  return without_obstacle(layout, seed, [&](double x, double y) {
    return amplitude_m * (2.0 * (noise(x, y) - lowest) / (highest - lowest) - 1.0);
  });
}

SyntheticTerrain make_gap(double difficulty, std::uint64_t seed) {
  return with_obstacle({}, seed, pit(std::lerp(1.0, 3.5, difficulty), 0.0));
}

SyntheticTerrain make_step(double difficulty, std::uint64_t seed) {
  constexpr double kBlockLength_m = 8.0;
  return with_obstacle({}, seed, block(kBlockLength_m, std::lerp(0.5, 1.5, difficulty)));
}

SyntheticTerrain make_hole(double, std::uint64_t seed) {
  constexpr double kNeckLength_m = 3.0;
  constexpr double kNeckWidth_m = 1.0;
  // Start and goal stand to either side of the neck's line, so that the way to it bends.
  const Layout layout{36.0, 24.0, 27.0, 8.0};
  return with_obstacle(layout, seed, pit(kNeckLength_m, kNeckWidth_m));
}

SyntheticTerrain make_ramp(double, std::uint64_t seed) {
  constexpr double kLength_m = 8.0;
  constexpr double kRise_m = 2.0;
  return with_obstacle({}, seed, [](double along, double) {
    return kRise_m * std::clamp(along / kLength_m + 0.5, 0.0, 1.0);
  });
}

SyntheticTerrain make_wall(double, std::uint64_t seed) {
  constexpr double kThickness_m = 0.4;
  constexpr double kHeight_m = 0.5;
  return with_obstacle({}, seed, block(kThickness_m, kHeight_m));
}

SyntheticTerrain make_bridge(double, std::uint64_t seed) {
  constexpr double kBridgeLength_m = 2.0;
  constexpr double kBridgeWidth_m = 1.5;
  return with_obstacle({}, seed, pit(kBridgeLength_m, kBridgeWidth_m));
}

SyntheticTerrain make_side_slope(double, std::uint64_t seed) {
  const double gradient = std::tan(15.0 * kDegree);
  return without_obstacle({}, seed, [=](double, double y) { return gradient * y; });
}

struct Kind {
  std::string name;
  SyntheticTerrain (*make)(double difficulty, std::uint64_t seed);
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all{
      {"flat", make_flat}, {"rough", make_rough},   {"gap", make_gap},
      {"step", make_step}, {"hole", make_hole},     {"ramp", make_ramp},
      {"wall", make_wall}, {"bridge", make_bridge}, {"side_slope", make_side_slope}};
  return all;
}

}  // namespace

const std::vector<std::string>& synthetic_kinds() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Kind& kind : kinds()) all.push_back(kind.name);
    return all;
  }();
  return names;
}

Result<SyntheticTerrain> make_synthetic_terrain(const std::string& kind, double difficulty,
                                                std::uint64_t seed) {
  if (!(difficulty >= 0.0 && difficulty <= 1.0)) {
    return fail(ErrorCode::kBadInput, "the difficulty is " + std::to_string(difficulty) +
                                          ", expected a number from 0 to 1");
  }
  for (const Kind& known : kinds()) {
    if (known.name == kind) return known.make(difficulty, seed);
  }
  std::string names;
  for (const std::string& name : synthetic_kinds()) names += (names.empty() ? "" : ", ") + name;
  return fail(ErrorCode::kBadInput,
              "there is no terrain of kind '" + kind + "', expected one of " + names);
}

}  // namespace wex
