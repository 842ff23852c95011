#pragma once

namespace wex {

/// Sampling-based planners over SE(2) (all of OMPL).
enum class PlannerKind { kRrtSharp, kRrtStar, kBitStar, kPrmStar };

}  // namespace wex
