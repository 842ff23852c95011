#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <array>

// Plain shapes of the machine's links: what collides with the ground, and what is only looked at.
// All positions in the link's frame, lengths in m. Geoms carry no mass (the URDF's inertia counts).

namespace wex::shapes {

struct Colour {
  std::array<float, 4> rgba;
};
inline constexpr Colour kYellow{{0.93F, 0.70F, 0.10F, 1.0F}}, kGrey{{0.28F, 0.28F, 0.30F, 1.0F}},
    kSteel{{0.45F, 0.46F, 0.48F, 1.0F}}, kRubber{{0.10F, 0.10F, 0.10F, 1.0F}},
    kGlass{{0.35F, 0.55F, 0.68F, 1.0F}};

/// Box of half sizes around T_link_box.
mjsGeom* add_box(mjsBody* body, const Eigen::Isometry3d& T_link_box, const Eigen::Vector3d& half_m,
                 Colour colour, bool collides);
/// Box beam from one point to another; half_up_m along `up`, half_side_m across.
mjsGeom* add_beam(mjsBody* body, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                  const Eigen::Vector3d& up, double half_up_m, double half_side_m, Colour colour,
                  bool collides);
mjsGeom* add_capsule(mjsBody* body, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                     double radius_m, Colour colour, bool collides);

/// Tyre (the colliding cylinder), rim and spokes around the axle.
void add_wheel(mjsBody* body, const Eigen::Vector3d& axle, double radius_m, double half_width_m);
/// Chassis: colliding box from the belly up, and the ring the cabin turns on.
void add_chassis(mjsBody* body, const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m,
                 double belly_below_base_m, double turn_height_m);
/// Upper carriage on the turning joint: cab on the left, boom on the right, engine behind.
void add_upper_carriage(mjsBody* body);
/// Bucket from where it is mounted to its contact point: two parallel capsules at the contact point
/// that carry load, plates to look at.
///   side, down  unit vectors across the bucket and out of its sole
void add_bucket(mjsBody* body, const Eigen::Vector3d& p_link_contact,
                const Eigen::Vector3d& p_link_mount, const Eigen::Vector3d& side,
                const Eigen::Vector3d& down);

}  // namespace wex::shapes
