#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>

#include "models/terrain/terrain_map.hpp"

namespace wex {

inline constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// A grid with cell (i, j) = height(x, y) at the cell's position; origin at (0, 0).
inline Grid make_grid(int size_x, int size_y, double cell_m,
                      const std::function<double(double x, double y)>& height) {
  Grid grid;
  grid.size_x = size_x;
  grid.size_y = size_y;
  grid.cell_m = cell_m;
  for (int j = 0; j < size_y; ++j) {
    for (int i = 0; i < size_x; ++i) {
      grid.values.push_back(static_cast<float>(height(i * cell_m, j * cell_m)));
    }
  }
  return grid;
}

/// A folder of its own for the files of one test, gone afterwards.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("wex_" + name + "_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }
  /// Writes a small file and gives its path.
  [[nodiscard]] std::filesystem::path with(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace wex
