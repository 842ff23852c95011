#include "tools/wex/stepping_marks.hpp"

#include <algorithm>

namespace wex::app {
namespace {

/// Pieces share the point where they meet.
void extend(std::vector<TrackPiece>& track, bool lifted, const Eigen::Vector2d& p) {
  if (track.empty() || track.back().lifted != lifted) {
    if (!track.empty()) track.back().points.push_back(p);
    track.push_back({lifted, {}});
  }
  track.back().points.push_back(p);
}

}  // namespace

SteppingMarks stepping_marks(const MachineModel& machine, const std::vector<WholeBodyNode>& nodes) {
  SteppingMarks marks;
  KinematicTree::Workspace workspace = machine.tree.make_workspace();
  ContactFlags before = kDrivingContacts;
  for (const WholeBodyNode& node : nodes) {
    machine.tree.update(node.q, workspace);
    const auto& contacts = node.contacts;
    const bool lifted =
        !std::all_of(contacts.begin(), contacts.begin() + kNumWheels, [](bool c) { return c; });
    extend(marks.base, lifted, node.q.head<2>());
    for (std::size_t i = 0; i < kNumWheels; ++i) {
      const WheeledLeg& leg = machine.legs[i];
      const Eigen::Vector2d p =
          machine.tree.position(workspace, leg.carrier_body, leg.p_carrier_wheel).head<2>();
      extend(marks.wheels[i], !contacts[i], p);
      if (before[i] && !contacts[i]) marks.lift_offs.push_back(p);
      if (!before[i] && contacts[i]) marks.touch_downs.push_back(p);
    }
    constexpr auto kArm = static_cast<std::size_t>(Limb::kArm);
    if (machine.arm && contacts[kArm] && !before[kArm]) {
      marks.bucket_points.push_back(
          machine.tree.position(workspace, machine.arm->contact_body, machine.arm->p_body_contact)
              .head<2>());
    }
    before = contacts;
  }
  return marks;
}

}  // namespace wex::app
