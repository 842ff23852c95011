#include "initializer/search_census.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace wex {

std::vector<std::pair<std::uint64_t, std::string>> SearchCensus::rejections() const {
  std::vector<std::pair<std::uint64_t, std::string>> reasons;
  for (std::size_t i = 1; i < kNumRejections; ++i) {
    if (rejections_[i] > 0)
      reasons.emplace_back(rejections_[i], describe(static_cast<Rejection>(i)));
  }
  for (const auto& other : others_) {
    if (other.first > 0) reasons.push_back(other);
  }
  if (num_blocked_ > 0) reasons.emplace_back(num_blocked_, "near a place where a path failed");
  if (num_unsupported_ > 0) {
    reasons.emplace_back(num_unsupported_, "no wheels and bucket to stand on");
  }
  if (num_askew_ > 0)
    reasons.emplace_back(num_askew_, "heading askew at what must be stepped over");
  std::sort(reasons.rbegin(), reasons.rend());
  return reasons;
}

std::vector<FailedPlace> SearchCensus::failed_places() const {
  constexpr double kSamePlaceM = 0.5;
  std::vector<FailedPlace> places;
  for (const FailedPath& path : failed_paths_) {
    const auto same = std::find_if(places.begin(), places.end(), [&](const FailedPlace& place) {
      return place.last.stepping == path.stepping &&
             std::hypot(place.last.where.x_m - path.where.x_m,
                        place.last.where.y_m - path.where.y_m) < kSamePlaceM;
    });
    if (same == places.end()) {
      places.push_back({path, 1});
    } else {
      *same = {path, same->count + 1};
    }
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const FailedPlace& a, const FailedPlace& b) { return a.count > b.count; });
  return places;
}

std::pair<std::string, int> SearchCensus::commonest_failure() const {
  std::map<std::string, int> counts;
  std::pair<std::string, int> commonest;
  for (const FailedPath& path : failed_paths_) {
    const int count = ++counts[path.why];
    if (count > commonest.second) commonest = {path.why, count};
  }
  return commonest;
}

std::string SearchCensus::sentence() const {
  const auto reasons = rejections();
  std::uint64_t num_rejected = 0;
  for (const auto& reason : reasons) num_rejected += reason.first;

  std::string text = std::to_string(num_rejected) + " of " + std::to_string(num_poses_) +
                     " poses tried were rejected";
  for (std::size_t i = 0; i < reasons.size(); ++i) {
    text += (i == 0 ? ": " : ", ") + reasons[i].second + " " +
            std::to_string(100 * reasons[i].first / num_rejected) + " %";
  }
  if (!failed_paths_.empty()) {
    const auto [why, count] = commonest_failure();
    text += "; " + std::to_string(failed_paths_.size()) +
            " path(s) could not be followed with the whole body, " +
            (failed_paths_.size() == 1 ? "" : "most often (" + std::to_string(count) + ") ") +
            "because " + why;
  }
  return text;
}

}  // namespace wex
