#include "initializer/paper/contact_schedule.hpp"

#include <algorithm>
#include <cstddef>

namespace wex {

int num_contacts(const ContactFlags& contacts) noexcept {
  return static_cast<int>(std::count(contacts.begin(), contacts.end(), true));
}

ContactFlags both(const ContactFlags& a, const ContactFlags& b) noexcept {
  ContactFlags all{};
  for (std::size_t i = 0; i < kNumLimbs; ++i) all[i] = a[i] || b[i];
  return all;
}

std::vector<ContactFlags> contact_changes(const ContactFlags& from, const ContactFlags& to) {
  std::vector<ContactFlags> changes;
  ContactFlags now = from;
  const auto change = [&](std::size_t limb, bool made) {
    if (now[limb] == made || to[limb] != made) return;
    now[limb] = made;
    changes.push_back(now);
  };
  for (std::size_t i = kNumLimbs; i > 0; --i) change(i - 1, true);
  for (std::size_t i = 0; i < kNumLimbs; ++i) change(i, false);
  return changes;
}

}  // namespace wex
