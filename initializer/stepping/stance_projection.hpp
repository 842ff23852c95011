#pragma once

#include "initializer/stepping/certificate.hpp"
#include "initializer/stepping/stance_check.hpp"

namespace wex {

/// Is there any base height, pitch and support in which the machine can be at a pose? The layered
/// graph's questions with plain clearances, so never stricter than the graph. No allocation.
[[nodiscard]] Certifier::Admission project_stance(const StanceCheck& check,
                                                  const PlanSettings& plan,
                                                  const CertificateSettings& settings,
                                                  const Pose2& pose, double curvature_1_m) noexcept;

}  // namespace wex
