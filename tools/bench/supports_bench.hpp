#pragma once

#include <ostream>

#include "models/types/result.hpp"

namespace wex {

struct SupportsBenchOptions {
  int seeds = 5;    ///< per ground
  int poses = 400;  ///< per seed
};

/// What supports beyond those of the certificate's graph would be worth: random base poses between
/// start and goal, and the share of them where the machine can stand on four wheels; where it can
/// with a support of the graph (one wheel lifted, or a pair and the bucket ahead or behind); and
/// where it only could on three wheels and the bucket, on a diagonal pair and the bucket, or on
/// the wheels of one side and the bucket, put down anywhere around.
///   errors  those of machine and terrain
[[nodiscard]] Result<void> bench_supports(const SupportsBenchOptions& options, std::ostream& out);

}  // namespace wex
