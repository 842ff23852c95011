#include "models/types/plan.hpp"

#include <algorithm>

#include "models/types/result.hpp"

namespace wex {

WholeBodyNode sample(const std::vector<WholeBodyNode>& nodes, double t_s) {
  WEX_EXPECTS(!nodes.empty());
  if (t_s <= nodes.front().t_s) return nodes.front();
  if (t_s >= nodes.back().t_s) return nodes.back();
  const auto after = std::upper_bound(nodes.begin(), nodes.end(), t_s,
                                      [](double t, const WholeBodyNode& n) { return t < n.t_s; });
  const WholeBodyNode& b = *after;
  const WholeBodyNode& a = *std::prev(after);
  const double u = (t_s - a.t_s) / (b.t_s - a.t_s);
  return {t_s, a.q + u * (b.q - a.q), a.contacts};
}

}  // namespace wex
