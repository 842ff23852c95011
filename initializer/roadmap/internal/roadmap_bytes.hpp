#pragma once

#include <cstdint>
#include <string>

#include "initializer/roadmap/limb_roadmap.hpp"
#include "models/types/result.hpp"

namespace wex {

/// What a roadmap file was made for: hashes of everything that goes into a roadmap.
struct RoadmapKey {
  std::uint64_t machine = 0;  ///< the machine's two files, and the capsules made of them
  std::uint64_t settings = 0;
  bool operator==(const RoadmapKey&) const = default;
};

/// FNV-1a, continued from `hash`.
[[nodiscard]] std::uint64_t hash_bytes(const std::string& bytes,
                                       std::uint64_t hash = 0xCBF29CE484222325ULL);

/// The file's content: a header (what it is, version, key), the roadmaps, a checksum over both.
/// Little endian, doubles as they are in memory.
[[nodiscard]] std::string to_bytes(const Roadmaps& roadmaps, const RoadmapKey& key);

/// errors  why the bytes are no roadmap of this key, to follow the file's name in a sentence
[[nodiscard]] Result<Roadmaps, std::string> roadmaps_from(const std::string& bytes,
                                                          const RoadmapKey& key);

}  // namespace wex
