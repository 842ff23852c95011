#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "initializer/pose_check.hpp"
#include "models/types/pose.hpp"

namespace wex {

/// A path that a search found and the whole body could not follow.
struct FailedPath {
  Pose2 where;
  std::string why;  ///< part of a sentence
  bool stepping = false;
};

/// Failures close to each other.
struct FailedPlace {
  FailedPath last;
  int count = 0;
};

/// Everything that was turned down during one search, for the sentence that says why there is no
/// plan.
class SearchCensus {
 public:
  void count_pose() noexcept { ++num_poses_; }
  void count_poses(std::uint64_t times) noexcept { num_poses_ += times; }
  void count(Rejection rejection) noexcept { ++rejections_[static_cast<std::size_t>(rejection)]; }
  void count_blocked() noexcept { ++num_blocked_; }
  void count_unsupported() noexcept { ++num_unsupported_; }
  void count_askew() noexcept { ++num_askew_; }
  /// Of a search with reasons of its own; once for each reason (contract).
  void count(std::string reason, std::uint64_t times) {
    others_.emplace_back(times, std::move(reason));
  }
  void add(FailedPath path) { failed_paths_.push_back(std::move(path)); }

  [[nodiscard]] const std::vector<FailedPath>& failed_paths() const noexcept {
    return failed_paths_;
  }
  /// The failures gathered by place (within half a metre) and kind, most frequent first.
  [[nodiscard]] std::vector<FailedPlace> failed_places() const;
  [[nodiscard]] std::uint64_t num_poses() const noexcept { return num_poses_; }
  /// Rejected poses by reason, most frequent first; reasons that never applied are left out.
  [[nodiscard]] std::vector<std::pair<std::uint64_t, std::string>> rejections() const;
  /// "162630 of 273376 poses tried were rejected: ... 56 %, ...; 3 path(s) could not be
  /// followed..."
  [[nodiscard]] std::string sentence() const;

 private:
  [[nodiscard]] std::pair<std::string, int> commonest_failure() const;

  std::uint64_t num_poses_ = 0, num_blocked_ = 0, num_unsupported_ = 0, num_askew_ = 0;
  std::array<std::uint64_t, kNumRejections> rejections_{};
  std::vector<std::pair<std::uint64_t, std::string>> others_;
  std::vector<FailedPath> failed_paths_;
};

}  // namespace wex
