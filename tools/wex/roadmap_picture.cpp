#include "tools/wex/roadmap_picture.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "initializer/roadmap/roadmap_statistics.hpp"
#include "models/excavator/collision_model.hpp"
#include "tools/wex/canvas.hpp"

namespace wex::app {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr Color kWhite{1.0, 1.0, 1.0}, kInk{0.25, 0.25, 0.25}, kGrid{0.88, 0.88, 0.88};
constexpr Color kMachine{0.55, 0.55, 0.58, 0.35};
constexpr std::array<Color, kNumLimbs> kLimbColors{{{0.00, 0.45, 0.70, 1.0},
                                                    {0.84, 0.37, 0.00, 1.0},
                                                    {0.00, 0.62, 0.45, 1.0},
                                                    {0.80, 0.47, 0.65, 1.0},
                                                    {0.35, 0.35, 0.70, 1.0}}};
constexpr double kScale_px_m = 60.0, kBorder_px = 60.0, kTitle_px = 60.0, kText_px = 13.0;
constexpr double kBorder_m = 0.8;
constexpr double kLegEdgeAlpha = 0.35, kArmEdgeAlpha = 0.06;
constexpr double kLegDot_px = 2.0, kArmDot_px = 1.3;

class RoadmapPicture {
 public:
  RoadmapPicture(const MachineModel& machine, const Roadmaps& roadmaps, RoadmapView view)
      : machine_(machine), roadmaps_(roadmaps), view_(view) {
    lo_ = Eigen::Vector2d::Constant(-1.0);
    hi_ = Eigen::Vector2d::Constant(1.0);
    for (const LimbRoadmap& map : roadmaps.limbs) {
      const RoadmapStatistics s = statistics(map);
      lo_ = lo_.cwiseMin(flat(s.lowest));
      hi_ = hi_.cwiseMax(flat(s.highest));
    }
    lo_ -= Eigen::Vector2d::Constant(kBorder_m);
    hi_ += Eigen::Vector2d::Constant(kBorder_m);
    size_px_ = kScale_px_m * (hi_ - lo_);
  }

  Result<void> draw(const std::filesystem::path& file) {
    Canvas canvas(static_cast<int>(size_px_.x() + 2.0 * kBorder_px),
                  static_cast<int>(size_px_.y() + 2.0 * kBorder_px + kTitle_px));
    canvas.fill({0.0, 0.0, 1e5, 1e5}, kWhite);
    draw_axes(canvas);
    draw_machine(canvas);
    // The arm's thousands first, so that they do not hide the legs'.
    for (auto map = roadmaps_.limbs.rbegin(); map != roadmaps_.limbs.rend(); ++map) {
      draw_limb(canvas, *map);
    }
    draw_title(canvas);
    return canvas.write_png(file);
  }

 private:
  Eigen::Vector2d flat(const Eigen::Vector3d& p_base) const {
    return {p_base.x(), view_ == RoadmapView::kSide ? p_base.z() : p_base.y()};
  }
  Eigen::Vector2d pixel(const Eigen::Vector2d& p) const {
    return {kBorder_px + kScale_px_m * (p.x() - lo_.x()),
            kBorder_px + kTitle_px + kScale_px_m * (hi_.y() - p.y())};
  }

  void draw_axes(Canvas& canvas) const {
    for (double x = std::ceil(lo_.x()); x <= hi_.x(); x += 1.0) {
      canvas.line({pixel({x, lo_.y()}), pixel({x, hi_.y()})}, {kGrid, 1.0});
      canvas.text(pixel({x, lo_.y()}) + Eigen::Vector2d(0.0, 18.0), tick_label(x, 1.0), kText_px,
                  Align::kCentre, kInk);
    }
    for (double y = std::ceil(lo_.y()); y <= hi_.y(); y += 1.0) {
      canvas.line({pixel({lo_.x(), y}), pixel({hi_.x(), y})}, {kGrid, 1.0});
      canvas.text(pixel({lo_.x(), y}) + Eigen::Vector2d(-8.0, 4.0), tick_label(y, 1.0), kText_px,
                  Align::kRight, kInk);
    }
    canvas.text(pixel({hi_.x(), lo_.y()}) + Eigen::Vector2d(0.0, 38.0), "x of the base [m]",
                kText_px, Align::kRight, kInk);
    canvas.text(pixel({lo_.x(), hi_.y()}) + Eigen::Vector2d(-40.0, 0.0),
                view_ == RoadmapView::kSide ? "z of the base [m]" : "y of the base [m]", kText_px,
                Align::kRight, kInk, std::numbers::pi / 2.0);
  }

  void draw_machine(Canvas& canvas) const {
    KinematicTree::Workspace w = machine_.tree.make_workspace();
    Eigen::VectorXd q = Eigen::VectorXd::Zero(machine_.num_coordinates());
    q.tail(machine_.num_joints()) = machine_.default_posture();
    machine_.tree.update(q, w);
    const CollisionModel collision = CollisionModel::build(machine_);
    for (const CollisionModel::Capsule& capsule : collision.capsules()) {
      const Eigen::Isometry3d& T = w.T_world_body[capsule.body];
      canvas.polygon(
          outline(flat(T * capsule.p_body_a), flat(T * capsule.p_body_b), capsule.radius_m),
          kMachine);
    }
  }

  /// A capsule's shadow: two half circles.
  Points outline(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double radius_m) const {
    constexpr int kPieces = 10;
    const Eigen::Vector2d along = b - a;
    const double angle = std::atan2(along.y(), along.x());
    Points points;
    for (const bool end : {true, false}) {
      for (int i = 0; i <= kPieces; ++i) {
        const double turn =
            angle + std::numbers::pi * ((end ? -0.5 : 0.5) + static_cast<double>(i) / kPieces);
        points.push_back(
            pixel((end ? b : a) + radius_m * Eigen::Vector2d(std::cos(turn), std::sin(turn))));
      }
    }
    return points;
  }

  void draw_limb(Canvas& canvas, const LimbRoadmap& map) const {
    const bool arm = map.limb == Limb::kArm;
    const Color color = kLimbColors[static_cast<std::size_t>(map.limb)];
    Color faint = color;
    faint.alpha = arm ? kArmEdgeAlpha : kLegEdgeAlpha;
    for (const LimbRoadmap::Edge& edge : map.edges) {
      canvas.line({pixel(flat(map.p_base_contact.col(edge.a))),
                   pixel(flat(map.p_base_contact.col(edge.b)))},
                  {faint, 0.8});
    }
    const double dot = arm ? kArmDot_px : kLegDot_px;
    for (int v = 0; v < map.num_vertices(); ++v) {
      const Eigen::Vector2d p = pixel(flat(map.p_base_contact.col(v)));
      canvas.fill({p.x() - dot, p.y() - dot, 2.0 * dot, 2.0 * dot}, color);
    }
  }

  void draw_title(Canvas& canvas) const {
    canvas.text({kBorder_px, 28.0},
                "Limb roadmaps of the " + machine_.name + " in the base frame, " +
                    (view_ == RoadmapView::kSide ? "from its right" : "from above"),
                16.0, Align::kLeft, kInk, 0.0, true);
    double x = kBorder_px;
    for (const LimbRoadmap& map : roadmaps_.limbs) {
      const std::size_t limb = static_cast<std::size_t>(map.limb);
      canvas.fill({x, 43.0, 10.0, 10.0}, kLimbColors[limb]);
      const std::string label = std::string(kLimbNames[limb]) + ": " +
                                std::to_string(map.num_vertices()) + " vertices, " +
                                std::to_string(map.edges.size()) + " edges";
      canvas.text({x + 15.0, 53.0}, label, kText_px, Align::kLeft, kInk);
      x += 205.0;
    }
  }

  const MachineModel& machine_;
  const Roadmaps& roadmaps_;
  RoadmapView view_;
  Eigen::Vector2d lo_, hi_, size_px_;
};

}  // namespace

Result<void> draw_roadmaps(const MachineModel& machine, const Roadmaps& roadmaps, RoadmapView view,
                           const std::filesystem::path& file) {
  return RoadmapPicture(machine, roadmaps, view).draw(file);
}

}  // namespace wex::app
