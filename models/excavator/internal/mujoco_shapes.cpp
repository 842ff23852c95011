#include "models/excavator/internal/mujoco_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/excavator/mujoco_model.hpp"

namespace wex::shapes {
namespace {

// Measured on this machine's single-wheel rig; see models/excavator/README.md.
constexpr double kTyreFriction[3] = {0.9, 0.02, 0.001};
constexpr double kBodyFriction[3] = {0.6, 0.005, 0.0001};
constexpr int kTyreContactDimension = 4;
constexpr double kBucketCapsuleRadius_m = 0.1, kBucketCapsuleHalfLength_m = 0.5,
                 kBucketCapsuleHalfSpacing_m = 0.2;

void set_pose(mjsGeom* geom, const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  for (int i = 0; i < 3; ++i) geom->pos[i] = T.translation()[i];
  geom->quat[0] = q.w();
  geom->quat[1] = q.x();
  geom->quat[2] = q.y();
  geom->quat[3] = q.z();
}

mjsGeom* add_geom(mjsBody* body, mjtGeom type, Colour colour, bool collides) {
  mjsGeom* geom = mjs_addGeom(body, nullptr);
  geom->type = type;
  geom->mass = 0.0;
  std::copy(colour.rgba.begin(), colour.rgba.end(), geom->rgba);
  geom->contype = collides ? kMachineContactType : 0;
  geom->conaffinity = collides ? kGroundContactType : 0;
  geom->group = collides ? kBodyGroup : kVisualGroup;
  if (collides) {
    geom->condim = 3;
    std::copy(kBodyFriction, kBodyFriction + 3, geom->friction);
  }
  return geom;
}

/// Wheel and bucket: their own friction and contact settings win over the ground's.
void make_load_bearing(mjsGeom* geom) {
  geom->group = kLoadBearingGroup;
  geom->condim = kTyreContactDimension;
  geom->priority = 1;
  std::copy(kTyreFriction, kTyreFriction + 3, geom->friction);
}

/// Frame whose z is `z` and whose x is as close to `x_hint` as it can be.
Eigen::Matrix3d frame_along(const Eigen::Vector3d& z, const Eigen::Vector3d& x_hint) {
  const Eigen::Vector3d z_unit = z.normalized();
  Eigen::Vector3d x = x_hint - z_unit * z_unit.dot(x_hint);
  if (x.norm() < 1e-6) x = z_unit.unitOrthogonal();
  x.normalize();
  Eigen::Matrix3d R;
  R << x, z_unit.cross(x), z_unit;
  return R;
}

Eigen::Isometry3d pose(const Eigen::Matrix3d& R, const Eigen::Vector3d& p) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = R;
  T.translation() = p;
  return T;
}

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

}  // namespace

mjsGeom* add_box(mjsBody* body, const Eigen::Isometry3d& T_link_box, const Eigen::Vector3d& half_m,
                 Colour colour, bool collides) {
  mjsGeom* geom = add_geom(body, mjGEOM_BOX, colour, collides);
  set_pose(geom, T_link_box);
  for (int i = 0; i < 3; ++i) geom->size[i] = half_m[i];
  return geom;
}

mjsGeom* add_beam(mjsBody* body, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                  const Eigen::Vector3d& up, double half_up_m, double half_side_m, Colour colour,
                  bool collides) {
  const Eigen::Vector3d along = to - from;
  return add_box(body, pose(frame_along(along, up), 0.5 * (from + to)),
                 {half_up_m, half_side_m, 0.5 * along.norm()}, colour, collides);
}

mjsGeom* add_capsule(mjsBody* body, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                     double radius_m, Colour colour, bool collides) {
  mjsGeom* geom = add_geom(body, mjGEOM_CAPSULE, colour, collides);
  const Eigen::Vector3d along = to - from;
  set_pose(geom, pose(frame_along(along, Eigen::Vector3d::UnitX()), 0.5 * (from + to)));
  geom->size[0] = radius_m;
  geom->size[1] = 0.5 * along.norm();
  return geom;
}

void add_wheel(mjsBody* body, const Eigen::Vector3d& axle, double radius_m, double half_width_m) {
  const Eigen::Isometry3d T_link_wheel =
      pose(frame_along(axle, axle.unitOrthogonal()), Eigen::Vector3d::Zero());
  mjsGeom* tyre = add_geom(body, mjGEOM_CYLINDER, kRubber, true);
  set_pose(tyre, T_link_wheel);
  tyre->size[0] = radius_m;
  tyre->size[1] = half_width_m;
  make_load_bearing(tyre);

  mjsGeom* rim = add_geom(body, mjGEOM_CYLINDER, kSteel, false);
  set_pose(rim, T_link_wheel);
  rim->size[0] = 0.55 * radius_m;
  rim->size[1] = half_width_m + 0.01;
  // One spoke in another colour, so that turning is seen.
  constexpr int kNumSpokes = 3;
  for (int i = 0; i < kNumSpokes; ++i) {
    const Eigen::Isometry3d T_wheel_spoke(
        Eigen::AngleAxisd(std::numbers::pi * i / kNumSpokes, Eigen::Vector3d::UnitZ()));
    const double reach_m = (i == 0 ? 0.85 : 0.5) * radius_m;
    add_box(body, T_link_wheel * T_wheel_spoke, {reach_m, 0.05, half_width_m + 0.02},
            i == 0 ? kYellow : kGrey, false);
  }
}

void add_chassis(mjsBody* body, const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m,
                 double belly_below_base_m, double turn_height_m) {
  constexpr double kBodyTop_m = 0.25;
  const Eigen::Vector2d centre = 0.5 * (min_m + max_m), half = 0.5 * (max_m - min_m);
  add_box(body, at(centre.x(), centre.y(), 0.5 * (kBodyTop_m - belly_below_base_m)),
          {half.x(), half.y(), 0.5 * (kBodyTop_m + belly_below_base_m)}, kGrey, true);
  add_box(body, at(centre.x(), centre.y(), 0.12), {half.x() + 0.02, half.y() + 0.02, 0.08}, kYellow,
          false);
  mjsGeom* ring = add_geom(body, mjGEOM_CYLINDER, kSteel, false);
  ring->pos[2] = 0.5 * (kBodyTop_m + turn_height_m);
  ring->size[0] = 0.55;
  ring->size[1] = std::max(0.02, 0.5 * (turn_height_m - kBodyTop_m));
}

void add_upper_carriage(mjsBody* body) {
  add_box(body, at(-0.30, 0.0, 0.12), {1.25, 1.05, 0.12}, kGrey, false);    // deck
  add_box(body, at(-1.00, 0.0, 0.62), {0.62, 1.05, 0.38}, kYellow, false);  // engine hood
  add_box(body, at(-1.63, 0.0, 0.45), {0.10, 0.95, 0.30}, kGrey, false);    // counterweight
  add_box(body, at(0.30, 0.62, 0.50), {0.62, 0.42, 0.28}, kYellow, false);  // cab, lower part
  add_box(body, at(0.22, 0.62, 1.22), {0.54, 0.40, 0.46}, kGlass, false);   // cab, windows
  add_box(body, at(0.22, 0.62, 1.71), {0.60, 0.44, 0.04}, kYellow, false);  // roof
  for (const double x : {-0.30, 0.74}) {                                    // pillars
    for (const double y : {0.23, 1.01}) {
      add_box(body, at(x, y, 1.22), {0.035, 0.035, 0.47}, kGrey, false);
    }
  }
  add_box(body, at(0.45, -0.28, 0.45), {0.38, 0.22, 0.26}, kYellow, false);  // boom foot
}

void add_bucket(mjsBody* body, const Eigen::Vector3d& p_link_contact,
                const Eigen::Vector3d& p_link_mount, const Eigen::Vector3d& side,
                const Eigen::Vector3d& down) {
  const Eigen::Vector3d along = down.cross(side);
  for (const double sign : {-1.0, 1.0}) {
    const Eigen::Vector3d centre =
        p_link_contact - kBucketCapsuleRadius_m * down + sign * kBucketCapsuleHalfSpacing_m * along;
    make_load_bearing(add_capsule(body, centre - kBucketCapsuleHalfLength_m * side,
                                  centre + kBucketCapsuleHalfLength_m * side,
                                  kBucketCapsuleRadius_m, kSteel, true));
  }
  constexpr double kHalfWidth_m = 0.75, kHalfDepth_m = 0.28, kHalfPlate_m = 0.025;
  const Eigen::Vector3d depth = (p_link_contact - p_link_mount).cross(side).normalized();
  const auto add_plate = [&](const Eigen::Vector3d& offset, double half_up_m, double half_side_m) {
    add_beam(body, p_link_mount + offset, p_link_contact + offset, depth, half_up_m, half_side_m,
             kSteel, false);
  };
  add_plate(-kHalfDepth_m * depth, kHalfPlate_m, kHalfWidth_m);
  for (const double sign : {-1.0, 1.0}) {
    add_plate(sign * kHalfWidth_m * side, kHalfDepth_m, kHalfPlate_m);
  }
  add_box(body, pose(frame_along(depth, side), p_link_mount), {kHalfWidth_m, 0.03, kHalfDepth_m},
          kSteel, false);
}

}  // namespace wex::shapes
