#include "models/excavator/internal/link_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wex::shapes {
namespace {

constexpr Colour kYellow{{0.93F, 0.70F, 0.10F, 1.0F}}, kGrey{{0.28F, 0.28F, 0.30F, 1.0F}},
    kSteel{{0.45F, 0.46F, 0.48F, 1.0F}}, kRubber{{0.10F, 0.10F, 0.10F, 1.0F}},
    kGlass{{0.35F, 0.55F, 0.68F, 1.0F}};

constexpr double kLongBeam_m = 0.5;  ///< leg and arm links longer than this can touch the ground
constexpr double kShortestBeam_m = 0.05, kTelescopeInside_m = 1.2;
constexpr double kArmHalfThickness_m = 0.14, kLegHalfThickness_m = 0.1, kRodHalfThickness_m = 0.06;
constexpr double kBucketCapsuleRadius_m = 0.1, kBucketCapsuleHalfLength_m = 0.5,
                 kBucketCapsuleHalfSpacing_m = 0.2;

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

/// The shapes of one link.
class LinkShapes {
 public:
  std::vector<Shape> shapes;

  void add_box(const Eigen::Isometry3d& T_link_box, const Eigen::Vector3d& half_m, Colour colour,
               Use use) {
    shapes.push_back({Form::kBox, T_link_box, half_m, colour, use});
  }

  /// Box from one point to another; half_up_m along `up`, half_side_m across.
  void add_beam(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& up,
                double half_up_m, double half_side_m, Colour colour, Use use) {
    const Eigen::Vector3d along = to - from;
    add_box(pose(frame_along(along, up), 0.5 * (from + to)),
            {half_up_m, half_side_m, 0.5 * along.norm()}, colour, use);
  }

  /// Tyre, rim and spokes around the axle.
  void add_wheel(const Eigen::Vector3d& axle, double radius_m, double half_width_m) {
    const Eigen::Isometry3d T_link_wheel =
        pose(frame_along(axle, axle.unitOrthogonal()), Eigen::Vector3d::Zero());
    shapes.push_back(
        {Form::kCylinder, T_link_wheel, {radius_m, half_width_m, 0.0}, kRubber, Use::kLoadBearing});
    shapes.push_back({Form::kCylinder,
                      T_link_wheel,
                      {0.55 * radius_m, half_width_m + 0.01, 0.0},
                      kSteel,
                      Use::kDecoration});
    // One spoke in another colour, so that turning is seen.
    constexpr int kNumSpokes = 3;
    for (int i = 0; i < kNumSpokes; ++i) {
      const Eigen::Isometry3d T_wheel_spoke(
          Eigen::AngleAxisd(std::numbers::pi * i / kNumSpokes, Eigen::Vector3d::UnitZ()));
      const double reach_m = (i == 0 ? 0.85 : 0.5) * radius_m;
      add_box(T_link_wheel * T_wheel_spoke, {reach_m, 0.05, half_width_m + 0.02},
              i == 0 ? kYellow : kGrey, Use::kDecoration);
    }
  }

  /// Chassis: box from the belly up, and the ring the cabin turns on.
  void add_chassis(const MachineModel& machine, double turn_height_m) {
    constexpr double kBodyTop_m = 0.25;
    const double below_m = machine.belly_below_base_m;
    const Eigen::Vector2d centre = 0.5 * (machine.belly_min_m + machine.belly_max_m),
                          half = 0.5 * (machine.belly_max_m - machine.belly_min_m);
    add_box(at(centre.x(), centre.y(), 0.5 * (kBodyTop_m - below_m)),
            {half.x(), half.y(), 0.5 * (kBodyTop_m + below_m)}, kGrey, Use::kBody);
    add_box(at(centre.x(), centre.y(), 0.12), {half.x() + 0.02, half.y() + 0.02, 0.08}, kYellow,
            Use::kDecoration);
    shapes.push_back({Form::kCylinder,
                      at(0.0, 0.0, 0.5 * (kBodyTop_m + turn_height_m)),
                      {0.55, std::max(0.02, 0.5 * (turn_height_m - kBodyTop_m)), 0.0},
                      kSteel,
                      Use::kDecoration});
  }

  /// Upper carriage on the turning joint: cab on the left, boom on the right, engine behind.
  void add_upper_carriage() {
    constexpr Use kSolid = Use::kSolid;
    add_box(at(-0.30, 0.0, 0.12), {1.25, 1.05, 0.12}, kGrey, kSolid);    // deck
    add_box(at(-1.00, 0.0, 0.62), {0.62, 1.05, 0.38}, kYellow, kSolid);  // engine hood
    add_box(at(-1.63, 0.0, 0.45), {0.10, 0.95, 0.30}, kGrey, kSolid);    // counterweight
    add_box(at(0.30, 0.62, 0.50), {0.62, 0.42, 0.28}, kYellow, kSolid);  // cab, lower part
    add_box(at(0.22, 0.62, 1.22), {0.54, 0.40, 0.46}, kGlass, kSolid);   // cab, windows
    add_box(at(0.22, 0.62, 1.71), {0.60, 0.44, 0.04}, kYellow, kSolid);  // roof
    for (const double x : {-0.30, 0.74}) {                               // pillars
      for (const double y : {0.23, 1.01}) {
        add_box(at(x, y, 1.22), {0.035, 0.035, 0.47}, kGrey, Use::kDecoration);
      }
    }
    add_box(at(0.45, -0.28, 0.45), {0.38, 0.22, 0.26}, kYellow, kSolid);  // boom foot
  }

  /// Bucket from where it is mounted to its contact point: two parallel capsules at the contact
  /// point that carry load, plates around what it holds.
  ///   side, down  unit vectors across the bucket and out of its sole
  void add_bucket(const Eigen::Vector3d& p_link_contact, const Eigen::Vector3d& p_link_mount,
                  const Eigen::Vector3d& side, const Eigen::Vector3d& down) {
    const Eigen::Vector3d along = down.cross(side);
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::Vector3d centre = p_link_contact - kBucketCapsuleRadius_m * down +
                                     sign * kBucketCapsuleHalfSpacing_m * along;
      shapes.push_back({Form::kCapsule,
                        pose(frame_along(side, Eigen::Vector3d::UnitX()), centre),
                        {kBucketCapsuleRadius_m, kBucketCapsuleHalfLength_m, 0.0},
                        kSteel,
                        Use::kLoadBearing});
    }
    constexpr double kHalfWidth_m = 0.75, kHalfDepth_m = 0.28, kHalfPlate_m = 0.025;
    const Eigen::Vector3d depth = (p_link_contact - p_link_mount).cross(side).normalized();
    const auto add_plate = [&](const Eigen::Vector3d& offset, double half_up_m,
                               double half_side_m) {
      add_beam(p_link_mount + offset, p_link_contact + offset, depth, half_up_m, half_side_m,
               kSteel, Use::kDecoration);
    };
    add_plate(-kHalfDepth_m * depth, kHalfPlate_m, kHalfWidth_m);
    for (const double sign : {-1.0, 1.0}) {
      add_plate(sign * kHalfWidth_m * side, kHalfDepth_m, kHalfPlate_m);
    }
    add_box(pose(frame_along(depth, side), p_link_mount), {kHalfWidth_m, 0.03, kHalfDepth_m},
            kSteel, Use::kDecoration);
    add_beam(p_link_mount, p_link_contact, depth, kHalfDepth_m + kHalfPlate_m,
             kHalfWidth_m + kHalfPlate_m, kSteel, Use::kHull);
  }
};

/// Walks the tree once.
class ShapeBuilder {
 public:
  explicit ShapeBuilder(const MachineModel& machine)
      : machine_(machine), bodies_(machine.tree.bodies()), links_(bodies_.size()) {}

  std::vector<std::vector<Shape>> build() {
    add_body(0, Eigen::Matrix3d::Identity());
    std::vector<std::vector<Shape>> shapes;
    for (LinkShapes& link : links_) shapes.push_back(std::move(link.shapes));
    return shapes;
  }

 private:
  /// R_base_parent: with all joints at zero.
  void add_body(int index, const Eigen::Matrix3d& R_base_parent) {
    const Eigen::Matrix3d R_base_body = R_base_parent * bodies_[index].T_parent_joint.linear();
    if (const WheeledLeg* leg = leg_of_wheel(index)) {
      const Eigen::Vector3d axle =
          bodies_[index].T_parent_joint.linear().transpose() * leg->axle_carrier;
      links_[index].add_wheel(axle, leg->radius_m, leg->half_width_m);
    }
    add_shapes(index, R_base_body);
    for (const int child : children_of(index)) add_body(child, R_base_body);
  }

  void add_shapes(int index, const Eigen::Matrix3d& R_base_body) {
    LinkShapes& link = links_[index];
    const Joint* joint = actuated(index);
    const bool arm = joint && joint->role == JointRole::kArm;
    if (index == 0) {
      link.add_chassis(machine_, turn_height_m());
    } else if (arm && is_turn(*joint)) {
      link.add_upper_carriage();
    } else {
      const Eigen::Vector3d up = R_base_body.transpose().col(2);
      const std::vector<int> children = children_of(index);
      for (const int child : children) add_beam(index, child, arm, up);
      if (children.empty() && !leg_of_wheel(index)) add_end_rod(index, up);
    }
    if (machine_.arm && machine_.arm->contact_body == index) add_arm_contact(R_base_body, link);
  }

  /// From a link's joint to the next one along the limb.
  void add_beam(int index, int child, bool arm, const Eigen::Vector3d& up) {
    const KinematicTree::Body& source = bodies_[index];
    const Eigen::Vector3d end = bodies_[child].T_parent_joint.translation();
    // A telescope slides out of the link before it.
    const Eigen::Vector3d start =
        (source.prismatic ? -kTelescopeInside_m : 0.0) * source.axis.normalized();
    const double length_m = (end - start).norm();
    if (length_m < kShortestBeam_m || bodies_[child].coordinate < 0) return;
    const bool thin = source.prismatic || length_m < kLongBeam_m;
    const Colour colour = !thin ? kYellow : arm ? kSteel : kGrey;
    const double half_m = (arm ? kArmHalfThickness_m : kLegHalfThickness_m) * (thin ? 0.75 : 1.0);
    const Joint* next = actuated(child);
    const bool touches = length_m >= kLongBeam_m && !(next && next->role == JointRole::kAuxiliary);
    links_[index].add_beam(start, end, up, 1.2 * half_m, half_m, colour,
                           touches ? Use::kBody : Use::kSolid);
  }

  /// Something at a limb's end, a claw: a rod through its centre of mass.
  void add_end_rod(int index, const Eigen::Vector3d& up) {
    const Eigen::Vector3d& com = bodies_[index].p_body_com;
    if (com.norm() < kShortestBeam_m) return;
    links_[index].add_beam(Eigen::Vector3d::Zero(), 1.8 * com, up, kRodHalfThickness_m,
                           kRodHalfThickness_m, kSteel, Use::kSolid);
  }

  void add_arm_contact(const Eigen::Matrix3d& R_base_body, LinkShapes& link) const {
    const Eigen::Vector3d side = R_base_body.transpose().col(1);
    const Eigen::Vector3d down = -R_base_body.transpose().col(2);
    // Mounted at the last joint before it.
    Eigen::Isometry3d T_contact_joint = Eigen::Isometry3d::Identity();
    for (int i = machine_.arm->contact_body; i > 0 && bodies_[i].coordinate < 0;
         i = bodies_[i].parent) {
      T_contact_joint = T_contact_joint * bodies_[i].T_parent_joint.inverse();
    }
    link.add_bucket(machine_.arm->p_body_contact, T_contact_joint.translation(), side, down);
  }

  std::vector<int> children_of(int index) const {
    std::vector<int> children;
    for (int i = index + 1; i < std::ssize(bodies_); ++i) {
      if (bodies_[i].parent == index) children.push_back(i);
    }
    return children;
  }

  const Joint* actuated(int body) const {
    const auto joint = std::find_if(machine_.joints.begin(), machine_.joints.end(),
                                    [&](const Joint& j) { return j.body == body; });
    return joint == machine_.joints.end() ? nullptr : &*joint;
  }

  const WheeledLeg* leg_of_wheel(int body) const {
    const auto leg = std::find_if(machine_.legs.begin(), machine_.legs.end(),
                                  [&](const WheeledLeg& l) { return l.wheel_body == body; });
    return leg == machine_.legs.end() ? nullptr : &*leg;
  }

  bool is_turn(const Joint& joint) const {
    return machine_.arm && !machine_.arm->coordinates.empty() &&
           &joint == &machine_.joints[machine_.arm->coordinates.front() - kNumBaseCoordinates];
  }

  double turn_height_m() const {
    for (const Joint& joint : machine_.joints) {
      if (is_turn(joint)) return bodies_[joint.body].T_parent_joint.translation().z();
    }
    return 0.0;
  }

  const MachineModel& machine_;
  const std::vector<KinematicTree::Body>& bodies_;
  std::vector<LinkShapes> links_;
};

}  // namespace

std::vector<std::vector<Shape>> link_shapes(const MachineModel& machine) {
  return ShapeBuilder(machine).build();
}

}  // namespace wex::shapes
