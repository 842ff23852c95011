#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "initializer/internal/se2_search.hpp"
#include "initializer/stepping/certificate.hpp"

namespace wex {

/// `more`, which begins where `sequence` ends, appended to it.
void append_sequence(CertifiedSequence& sequence, const CertifiedSequence& more);

/// A random tree whose nodes are four-wheel states and whose edges are certified sequences: what it
/// reaches is a plan by construction. Slower than a certificate of the right path, but needs no
/// luck with the heading of a path that was searched without contacts. One thread; all randomness
/// comes from the seed.
class CertifiedTree {
 public:
  /// certifier must outlive it.
  CertifiedTree(const Certifier& certifier, const Pose2& start, const Pose2& goal,
                const SearchSettings& settings, std::uint64_t seed);

  /// One sample: a new node, or none. The sequence to the goal once an edge reaches it.
  [[nodiscard]] std::optional<CertifiedSequence> grow();
  [[nodiscard]] std::size_t size() const noexcept { return nodes_.size(); }
  [[nodiscard]] int iterations() const noexcept { return num_samples_; }

 private:
  struct Node {
    Pose2 pose;
    std::optional<BaseCoordinates> base;
    int parent = -1;
    CertifiedSequence edge;  ///< from the parent to here
  };
  [[nodiscard]] Pose2 sample();
  [[nodiscard]] double uniform(double low, double high);
  [[nodiscard]] int nearest(const Pose2& pose) const;
  /// The admitted part of the Reeds-Shepp curve, at most `max_length_m` long; reaches says whether
  /// that is all of it.
  [[nodiscard]] DrivePath admitted_part(const Pose2& from, const Pose2& to, double max_length_m,
                                        bool& reaches) const;
  [[nodiscard]] std::optional<int> extend(int from, const Pose2& to, double max_length_m,
                                          bool must_reach);
  [[nodiscard]] CertifiedSequence sequence_to(int node) const;

  const Certifier* certifier_;
  Pose2 goal_;
  SearchSettings settings_;
  std::mt19937_64 generator_;
  std::vector<Node> nodes_;
  int num_samples_ = 0;
};

}  // namespace wex
