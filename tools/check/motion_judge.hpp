#pragma once

#include "tools/check/checked_ground.hpp"
#include "tools/check/checked_machine.hpp"
#include "tools/check/motion.hpp"
#include "tools/check/rules.hpp"

namespace wex::check {

/// Takes the machine along a motion and observes every rule but those of its two ends. Rows are
/// joined by straight lines, looked at every centimetre that base, a wheel or the bucket moves.
///   motion   at least two rows, joints in the machine's order (contract)
///   returns  postures looked at
int judge_motion(CheckedMachine& machine, CheckedGround& ground, const Motion& motion,
                 Findings& findings);

}  // namespace wex::check
