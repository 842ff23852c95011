#pragma once

#include <array>
#include <vector>

#include "models/types/plan.hpp"

namespace wex {

/// A limb carries from the one time to the other [s].
struct ContactInterval {
  double from_s = 0.0, to_s = 0.0;
  bool operator==(const ContactInterval&) const = default;
};

/// Unbroken contacts in order of time, indexed by Limb.
using ContactSchedule = std::array<std::vector<ContactInterval>, kNumLimbs>;

/// A node's contacts hold until the next node, those of the last one until nothing.
///   samples  of anything with t_s and contacts, sorted by t_s
template <typename Sample>
[[nodiscard]] ContactSchedule contact_schedule(const std::vector<Sample>& samples) {
  ContactSchedule schedule;
  for (std::size_t limb = 0; limb < kNumLimbs; ++limb) {
    for (std::size_t k = 0; k < samples.size();) {
      std::size_t end = k;
      while (end < samples.size() && samples[end].contacts[limb]) ++end;
      if (end > k) {
        schedule[limb].push_back(
            {samples[k].t_s, end < samples.size() ? samples[end].t_s : samples.back().t_s});
      }
      k = end + 1;
    }
  }
  return schedule;
}

/// How often a limb leaves the ground: of a wheel its lifts, of the arm the supports it gave.
[[nodiscard]] int num_lifts(const std::vector<WholeBodyNode>& nodes, Limb limb);
/// The same, of all four wheels together.
[[nodiscard]] int num_wheel_lifts(const std::vector<WholeBodyNode>& nodes);

}  // namespace wex
