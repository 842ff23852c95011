#include "hw_interface/mujoco/truth_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "models/excavator/mujoco_model.hpp"

namespace wex {
namespace {

constexpr double kLoaded_n = 1000.0;  ///< 3 % of a wheel's static load: it touches

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

TruthRecorder::TruthRecorder(const MachineModel& machine, const mjModel* model)
    : wheel_of_geom_(static_cast<std::size_t>(model->ngeom), -1) {
  for (int leg = 0; leg < kNumWheels; ++leg) {
    Wheel& wheel = wheels_[leg];
    const WheeledLeg& source = machine.legs[leg];
    wheel.site = mj_name2id(model, mjOBJ_SITE, wheel_site_name(source.limb).c_str());
    wheel.body = model->site_bodyid[wheel.site];
    const int tyre = mj_name2id(model, mjOBJ_JOINT, tyre_joint_name(source.limb).c_str());
    wheel.tyre_qpos = model->jnt_qposadr[tyre];
    const std::string& wheel_joint = machine.joints[source.wheel - kNumBaseCoordinates].name;
    wheel.wheel_dof = model->jnt_dofadr[mj_name2id(model, mjOBJ_JOINT, wheel_joint.c_str())];
    wheel.radius_m = source.radius_m;
    for (int g = 0; g < model->ngeom; ++g) {
      if (model->geom_bodyid[g] == wheel.body) wheel_of_geom_[g] = leg;
    }
  }
}

void TruthRecorder::reset() noexcept {
  side_slip_m_.fill(0.0);
  travel_m_.fill(0.0);
  airborne_s_.fill(0.0);
  body_contact_ = false;
}

void TruthRecorder::Patch::add(const Patch& other) noexcept {
  load_n += other.load_n;
  penetration_m = std::max(penetration_m, other.penetration_m);
  for (int i = 0; i < 3; ++i) moment[i] += other.moment[i];
}

TruthRecorder::Patches TruthRecorder::contacts(const mjModel* model, const mjData* data) noexcept {
  Patches patches;
  for (int c = 0; c < data->ncon; ++c) {
    const mjContact& contact = data->contact[c];
    const int first = contact.geom[0], second = contact.geom[1];
    if (first < 0 || second < 0) continue;
    const bool second_is_machine = model->geom_bodyid[second] != 0;
    const int geom = second_is_machine ? second : first;
    const int leg = wheel_of_geom_[geom];
    if (leg < 0) {
      body_contact_ = body_contact_ || model->geom_group[geom] == kBodyGroup;
      continue;
    }
    mjtNum force[6];
    mj_contactForce(model, data, c, force);
    double vertical_n = 0.0;  // frame rows are the contact's axes, the first from first to second
    for (int axis = 0; axis < 3; ++axis) vertical_n += force[axis] * contact.frame[3 * axis + 2];
    if (!second_is_machine) vertical_n = -vertical_n;
    Patch point{.load_n = vertical_n, .penetration_m = -contact.dist, .moment = {}};
    for (int i = 0; i < 3; ++i) point.moment[i] = vertical_n * contact.pos[i];
    patches[leg].add(point);
  }
  return patches;
}

void TruthRecorder::observe(const mjModel* model, const mjData* data, double dt_s) noexcept {
  const Patches patches = contacts(model, data);
  ++steps_in_period_;
  for (int leg = 0; leg < kNumWheels; ++leg) {
    const Wheel& wheel = wheels_[leg];
    travel_m_[leg] += std::abs(data->qvel[wheel.wheel_dof]) * wheel.radius_m * dt_s;
    period_sum_[leg].add(patches[leg]);
    if (patches[leg].load_n < kLoaded_n) continue;
    // Velocity of the tyre's material in the patch, along the axle (site y).
    mjtNum velocity[6];
    mj_objectVelocity(model, data, mjOBJ_XBODY, wheel.body, velocity, 0);
    const std::array<double, 3> patch = patches[leg].centre();
    const mjtNum* centre = data->xpos + 3 * wheel.body;
    const mjtNum arm[3] = {patch[0] - centre[0], patch[1] - centre[1], patch[2] - centre[2]};
    mjtNum at_patch[3];
    mju_cross(at_patch, velocity, arm);
    mju_addTo3(at_patch, velocity + 3);
    const mjtNum* R = data->site_xmat + 9 * wheel.site;
    const double along_axle = at_patch[0] * R[1] + at_patch[1] * R[4] + at_patch[2] * R[7];
    side_slip_m_[leg] += std::abs(along_axle) * dt_s;
  }
}

void TruthRecorder::end_period(double period_s) noexcept {
  if (steps_in_period_ == 0) return;
  patches_ = period_sum_;
  for (int leg = 0; leg < kNumWheels; ++leg) {
    patches_[leg].load_n /= steps_in_period_;
    for (double& moment : patches_[leg].moment) moment /= steps_in_period_;
    if (patches_[leg].load_n < kLoaded_n) airborne_s_[leg] += period_s;
  }
  period_sum_.fill(Patch{});
  steps_in_period_ = 0;
}

GroundTruth TruthRecorder::truth(const mjData* data) const {
  GroundTruth truth;
  truth.t_s = data->time;
  truth.base_vertical_rate_m_s = data->qvel[2];
  truth.side_slip_m = side_slip_m_;
  truth.wheel_travel_m = travel_m_;
  truth.airborne_s = airborne_s_;
  truth.body_contact = body_contact_;
  // Loaded patches counter-clockwise, and the centre of mass of the whole machine.
  constexpr std::array<Limb, kNumWheels> kCounterClockwise{Limb::kLF, Limb::kLH, Limb::kRH,
                                                           Limb::kRF};
  std::array<Eigen::Vector2d, kNumWheels> corners;
  int num_corners = 0;
  for (const Limb limb : kCounterClockwise) {
    const Patch& patch = patches_[static_cast<int>(limb)];
    if (patch.load_n < kLoaded_n) continue;
    const auto centre = patch.centre();
    corners[num_corners++] = {centre[0], centre[1]};
  }
  const Eigen::Vector2d com(data->subtree_com[0], data->subtree_com[1]);
  double margin_m = num_corners < 3 ? 0.0 : std::numeric_limits<double>::infinity();
  for (int i = 0; i < num_corners && num_corners >= 3; ++i) {
    const Eigen::Vector2d edge = corners[(i + 1) % num_corners] - corners[i];
    margin_m = std::min(margin_m, cross(edge, com - corners[i]) / edge.norm());
  }
  truth.stability_margin_m = margin_m;
  for (int leg = 0; leg < kNumWheels; ++leg) {
    truth.wheel_load_n[leg] = patches_[leg].load_n;
    truth.wheel_penetration_m[leg] = patches_[leg].penetration_m;
    truth.tyre_deflection_m[leg] = data->qpos[wheels_[leg].tyre_qpos];
  }
  return truth;
}

}  // namespace wex
