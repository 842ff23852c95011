#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>

#include "initializer/roadmap/internal/roadmap_bytes.hpp"
#include "initializer/roadmap/limb_roadmap.hpp"

namespace wex {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> read_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  std::string bytes(std::istreambuf_iterator<char>(in), {});
  if (in.bad()) return std::nullopt;
  return bytes;
}

template <typename T>
std::uint64_t hash_value(const T& value, std::uint64_t hash) {
  return hash_bytes(std::string(reinterpret_cast<const char*>(&value), sizeof(T)), hash);
}

/// The machine's files say nearly everything; its capsules also depend on how they are made.
Result<std::uint64_t> machine_hash(const MachineModel& machine, const CollisionModel& collision) {
  std::uint64_t hash = hash_bytes(machine.name);
  for (const fs::path& file : {machine.urdf_path, machine.sidecar_path}) {
    const auto bytes = read_file(file);
    if (!bytes) {
      return fail(ErrorCode::kBadInput, file.string() +
                                            ": cannot be read again, but a roadmap is "
                                            "kept under its content's hash");
    }
    hash = hash_bytes(*bytes, hash_value(bytes->size(), hash));
  }
  for (const CollisionModel::Capsule& capsule : collision.capsules()) {
    hash = hash_value(capsule.body, hash);
    for (const Eigen::Vector3d& end : {capsule.p_body_a, capsule.p_body_b}) {
      for (const double x : end) hash = hash_value(x, hash);
    }
    hash = hash_value(capsule.radius_m, hash);
  }
  for (const CollisionModel::Pair& pair : collision.pairs()) {
    hash = hash_value(pair.second, hash_value(pair.first, hash));
  }
  return hash;
}

std::uint64_t settings_hash(const RoadmapSettings& s) {
  std::uint64_t hash = hash_value(s.leg_vertices, hash_bytes("settings"));
  for (const int value : {s.arm_vertices, s.neighbours, s.joint_neighbours}) {
    hash = hash_value(value, hash);
  }
  for (const double value : {s.max_leg_edge_m, s.max_arm_edge_m, s.self_collision_m}) {
    hash = hash_value(value, hash);
  }
  return hash_value(s.seed, hash);
}

Result<RoadmapKey> key_of(const MachineModel& machine, const CollisionModel& collision,
                          const RoadmapSettings& settings) {
  const Result<std::uint64_t> machine_part = machine_hash(machine, collision);
  if (!machine_part) return tl::unexpected(machine_part.error());
  return RoadmapKey{*machine_part, settings_hash(settings)};
}

/// Empty if the system names no place.
fs::path default_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache && *cache) return fs::path(cache) / "wex";
  const char* home = std::getenv("HOME");
  if (home && *home) return fs::path(home) / ".cache" / "wex";
  return {};
}

fs::path file_in(const fs::path& folder, const MachineModel& machine, const RoadmapKey& key) {
  std::array<char, 64> hash{};
  std::snprintf(hash.data(), hash.size(), "%016llx",
                static_cast<unsigned long long>(hash_value(key, hash_bytes("file"))));
  return folder / ("roadmaps_" + machine.name + "_" + hash.data() + ".bin");
}

/// Whole or not at all: under another name first, then renamed.
///   returns  the system's reason, empty if it went well
std::string write_whole(const fs::path& file, const std::string& bytes) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) return error.message();
  const fs::path partial = file.string() + ".partial." + std::to_string(::getpid());
  std::FILE* out = std::fopen(partial.c_str(), "wb");
  if (!out) return std::generic_category().message(errno);
  bool good = std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size();
  good = std::fflush(out) == 0 && good;
  std::string reason = good ? "" : std::generic_category().message(errno);
  std::fclose(out);
  if (good) {
    fs::rename(partial, file, error);
    if (!error) return "";
    reason = error.message();
  }
  fs::remove(partial, error);
  return reason;
}

}  // namespace

Result<fs::path> roadmap_file(const MachineModel& machine, const RoadmapSettings& settings,
                              const fs::path& folder) {
  const Result<RoadmapKey> key = key_of(machine, CollisionModel::build(machine), settings);
  if (!key) return tl::unexpected(key.error());
  return file_in(folder.empty() ? default_folder() : folder, machine, *key);
}

Result<Roadmaps> load_or_build_roadmaps(const MachineModel& machine,
                                        const RoadmapSettings& settings, const fs::path& folder,
                                        std::string* remark) {
  const auto tell = [&](const std::string& text) {
    if (remark) *remark += (remark->empty() ? "" : "; ") + text;
  };
  if (remark) remark->clear();
  const CollisionModel collision = CollisionModel::build(machine);
  const Result<RoadmapKey> key = key_of(machine, collision, settings);
  if (!key) return tl::unexpected(key.error());
  const fs::path place = folder.empty() ? default_folder() : folder;
  if (place.empty()) {
    tell("roadmaps are not kept: neither XDG_CACHE_HOME nor HOME is set");
    return build_roadmaps(machine, collision, settings);
  }
  const fs::path file = file_in(place, machine, *key);
  if (const auto bytes = read_file(file)) {
    Result<Roadmaps, std::string> read = roadmaps_from(*bytes, *key);
    if (read) return std::move(*read);
    tell(file.string() + " " + read.error() + ", so the roadmaps were built again");
  }
  Roadmaps roadmaps = build_roadmaps(machine, collision, settings);
  const std::string reason = write_whole(file, to_bytes(roadmaps, *key));
  if (!reason.empty()) {
    const std::string text = file.string() + ": cannot be written: " + reason;
    if (!folder.empty()) return fail(ErrorCode::kBadInput, text);
    tell(text);
  }
  return roadmaps;
}

}  // namespace wex
