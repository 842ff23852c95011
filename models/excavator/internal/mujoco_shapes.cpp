#include "models/excavator/internal/mujoco_shapes.hpp"

#include <algorithm>

#include "models/excavator/mujoco_model.hpp"

namespace wex::shapes {
namespace {

// Measured on this machine's single-wheel rig; see models/excavator/README.md.
constexpr double kTyreFriction[3] = {0.9, 0.02, 0.001};
constexpr double kBodyFriction[3] = {0.6, 0.005, 0.0001};
constexpr int kTyreContactDimension = 4;

mjtGeom geom_type(Form form) {
  switch (form) {
    case Form::kCylinder:
      return mjGEOM_CYLINDER;
    case Form::kCapsule:
      return mjGEOM_CAPSULE;
    case Form::kBox:
      break;
  }
  return mjGEOM_BOX;
}

/// Wheel and bucket: their own friction and contact settings win over the ground's.
void make_load_bearing(mjsGeom* geom) {
  geom->group = kLoadBearingGroup;
  geom->condim = kTyreContactDimension;
  geom->priority = 1;
  std::copy(kTyreFriction, kTyreFriction + 3, geom->friction);
}

}  // namespace

void add_geom(mjsBody* body, const Shape& shape) {
  if (shape.use == Use::kHull) return;
  const bool collides = shape.use == Use::kBody || shape.use == Use::kLoadBearing;
  mjsGeom* geom = mjs_addGeom(body, nullptr);
  geom->type = geom_type(shape.form);
  geom->mass = 0.0;
  const Eigen::Quaterniond rotation(shape.T_link_shape.linear());
  geom->quat[0] = rotation.w();
  for (int i = 0; i < 3; ++i) {
    geom->pos[i] = shape.T_link_shape.translation()[i];
    geom->quat[i + 1] = rotation.vec()[i];
    geom->size[i] = shape.size_m[i];
  }
  std::copy(shape.colour.rgba.begin(), shape.colour.rgba.end(), geom->rgba);
  geom->contype = collides ? kMachineContactType : 0;
  geom->conaffinity = collides ? kGroundContactType : 0;
  geom->group = collides ? kBodyGroup : kVisualGroup;
  if (!collides) return;
  geom->condim = 3;
  std::copy(kBodyFriction, kBodyFriction + 3, geom->friction);
  if (shape.use == Use::kLoadBearing) make_load_bearing(geom);
}

}  // namespace wex::shapes
