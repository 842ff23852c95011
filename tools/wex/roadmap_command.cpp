#include "tools/wex/roadmap_command.hpp"

#include <array>
#include <cstdio>

#include "initializer/roadmap/roadmap_statistics.hpp"
#include "models/types/cpu_clock.hpp"
#include "tools/wex/output_folder.hpp"
#include "tools/wex/roadmap_picture.hpp"

namespace wex::app {
namespace {

void print_row(std::ostream& out, const LimbRoadmap& map) {
  const RoadmapStatistics s = statistics(map);
  std::array<char, 200> line{};
  std::snprintf(line.data(), line.size(),
                "%-4s %8d %7d %7.1f %11d %7.1f %% %8.2f   %5.2f..%5.2f  %5.2f..%5.2f  "
                "%5.2f..%5.2f\n",
                std::string(kLimbNames[static_cast<std::size_t>(map.limb)]).c_str(), s.vertices,
                s.edges, s.mean_degree, s.components,
                s.vertices ? 100.0 * s.largest_component / s.vertices : 0.0, s.mean_edge_m,
                s.lowest.x(), s.highest.x(), s.lowest.y(), s.highest.y(), s.lowest.z(),
                s.highest.z());
  out << line.data();
}

}  // namespace

Result<void> run_roadmap(const RoadmapOptions& options, std::ostream& out) {
  const Result<MachineModel> machine = load_machine(options.machine);
  if (!machine) return tl::unexpected(machine.error());
  const Result<OutputFolder> folder = OutputFolder::open(options.out);
  if (!folder) return tl::unexpected(folder.error());
  std::string remark;
  const double start_s = thread_cpu_time_s();
  const Result<Roadmaps> roadmaps =
      load_or_build_roadmaps(*machine, options.settings, options.cache, &remark);
  const double taken_s = thread_cpu_time_s() - start_s;
  if (!roadmaps) return tl::unexpected(roadmaps.error());
  const Result<std::filesystem::path> file =
      roadmap_file(*machine, options.settings, options.cache);
  if (!file) return tl::unexpected(file.error());

  std::array<char, 160> line{};
  std::snprintf(line.data(), line.size(), "%-4s %8s %7s %7s %11s %9s %8s   %s\n", "limb",
                "vertices", "edges", "degree", "components", "largest", "edge m",
                "x m           y m           z m  (contact, base frame)");
  out << line.data();
  for (const LimbRoadmap& map : roadmaps->limbs) print_row(out, map);
  std::snprintf(line.data(), line.size(), "ready after %.3f s of CPU time\n", taken_s);
  out << line.data();
  if (!remark.empty()) out << remark << "\n";
  out << file->string() << "\n";
  for (const RoadmapView view : {RoadmapView::kSide, RoadmapView::kTop}) {
    const std::string name = view == RoadmapView::kSide ? "roadmap_side.png" : "roadmap_top.png";
    const auto drawn = folder->publish(name, [&](const std::filesystem::path& picture) {
      return draw_roadmaps(*machine, *roadmaps, view, picture);
    });
    if (!drawn) return tl::unexpected(drawn.error());
    out << (folder->path() / name).string() << "\n";
  }
  return {};
}

}  // namespace wex::app
