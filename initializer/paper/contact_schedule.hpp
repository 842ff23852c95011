#pragma once

#include <vector>

#include "models/types/limbs.hpp"

namespace wex {

[[nodiscard]] int num_contacts(const ContactFlags& contacts) noexcept;
/// Contacts of either.
[[nodiscard]] ContactFlags both(const ContactFlags& a, const ContactFlags& b) noexcept;

/// The contacts that lead from one set to another, one change at a time, `from` not among them. All
/// new ones are made first, the arm's before the legs', then old ones broken, the arm's last: in
/// between everything stands (the paper's full contact phase). Empty if nothing changes.
[[nodiscard]] std::vector<ContactFlags> contact_changes(const ContactFlags& from,
                                                        const ContactFlags& to);

}  // namespace wex
