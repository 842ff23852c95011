#pragma once

#include <filesystem>
#include <ostream>
#include <string>

#include "initializer/roadmap/limb_roadmap.hpp"
#include "models/types/result.hpp"

namespace wex::app {

/// What the user asks of `wex roadmap`.
struct RoadmapOptions {
  std::string machine = "m545";
  RoadmapSettings settings;
  std::filesystem::path cache;                ///< folder; empty: the default one
  std::filesystem::path out = "out/roadmap";  ///< folder of the pictures
};

/// Loads the limb roadmaps or builds and keeps them, prints what they are and draws them:
/// roadmap_side.png and roadmap_top.png.
///   errors  kBadInput: machine, cache folder, output folder
[[nodiscard]] Result<void> run_roadmap(const RoadmapOptions& options, std::ostream& out);

}  // namespace wex::app
