#include "tools/wex/overview_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "models/types/contact_schedule.hpp"
#include "tools/wex/ground_picture.hpp"
#include "tools/wex/stepping_marks.hpp"

namespace wex::app {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr Color kBlack{0.0, 0.0, 0.0}, kWhite{1.0, 1.0, 1.0}, kGrey{0.35, 0.35, 0.35};
constexpr Color kPlanned{0.35, 0.65, 1.0}, kRefined{0.0, 0.0, 0.0}, kDriven{0.85, 0.05, 0.45};
constexpr Color kStart{0.05, 0.50, 0.15}, kGoal{0.80, 0.35, 0.00};
constexpr Color kSteppingBase{1.0, 0.62, 0.10}, kLifted{0.85, 0.25, 0.0}, kBucket{0.55, 0.1, 0.6};
constexpr Color kTrack{0.15, 0.15, 0.15, 0.65}, kFailed{0.75, 0.0, 0.15};
constexpr double kText = 13.0;
constexpr std::size_t kMaxFailedPlaces = 6;  // named; the others are drawn without a number

Points base_path(const std::vector<WholeBodyNode>& nodes) {
  Points path;
  for (const WholeBodyNode& node : nodes) path.emplace_back(node.q.head<2>());
  return path;
}

Points driven_path(const std::vector<DriveSample>& samples) {
  Points path;
  for (const DriveSample& s : samples) path.emplace_back(s.base.head<2>());
  return path;
}

/// Cells around everything that happens, with a border; the whole map if that is not much more.
MapWindow window_around(const Points& points, const Grid& grid) {
  constexpr double kBorderM = 8.0;
  Eigen::Vector2d lo = points.front(), hi = points.front();
  for (const Eigen::Vector2d& p : points) {
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  }
  const Eigen::Vector2d half =
      0.5 * Eigen::Vector2d::Constant((hi - lo).maxCoeff()) + Eigen::Vector2d::Constant(kBorderM);
  const Eigen::Vector2d centre = 0.5 * (lo + hi);
  const auto cell = [&](double value, double origin, int size) {
    return std::clamp(static_cast<int>(std::lround((value - origin) / grid.cell_m)), 0, size);
  };
  return {cell(centre.x() - half.x(), grid.origin_m.x(), grid.size_x),
          cell(centre.y() - half.y(), grid.origin_m.y(), grid.size_y),
          cell(centre.x() + half.x(), grid.origin_m.x(), grid.size_x),
          cell(centre.y() + half.y(), grid.origin_m.y(), grid.size_y)};
}

class Overview {
 public:
  Overview(const RunReport& report, const TerrainMap& terrain, const MachineModel& machine)
      : report_(report),
        terrain_(terrain),
        machine_(machine),
        start_{local(report.task_map.start)},
        goal_{local(report.task_map.goal)},
        window_(window_around(everything(), terrain.elevation())),
        scale_px_m_(scale(terrain.elevation(), window_)),
        box_{kLeft, kTop, width_m() * scale_px_m_, height_m() * scale_px_m_},
        canvas_(static_cast<int>(kLeft + box_.width + kRight),
                static_cast<int>(kTop + std::max(box_.height, kLegendHeight) + kBottom +
                                 failures_height(report))) {
    if (report.plan && !report.drive && num_wheel_lifts(report.plan->nodes) > 0) {
      marks_ = stepping_marks(machine, report.plan->nodes);
    }
    if (report.search) failed_ = report.search->failed_places();
  }

  Result<void> draw(const std::filesystem::path& file) {
    draw_title();
    canvas_.image(box_, ground_pixels(terrain_, window_), window_.i1 - window_.i0,
                  window_.j1 - window_.j0);
    canvas_.clip(box_);
    draw_contours();
    draw_paths();
    draw_machine_outline(start_, kStart);
    draw_machine_outline(goal_, kGoal);
    draw_failures();
    draw_arrow(start_, kStart, "start");
    draw_arrow(goal_, kGoal, "goal");
    draw_scale_bar();
    canvas_.unclip();
    draw_axes();
    draw_legend();
    list_failures();
    return canvas_.write_png(file);
  }

 private:
  static constexpr double kLeft = 96.0, kTop = 44.0, kRight = 250.0, kBottom = 58.0;
  static constexpr double kLegendHeight = 420.0;
  static constexpr double kLine = 20.0;

  static double failures_height(const RunReport& report) {
    if (!report.search) return 0.0;
    return kLine * (2.0 + static_cast<double>(
                              std::min(report.search->failed_places().size(), kMaxFailedPlaces)));
  }

  Pose2 local(const Pose2& pose) const { return local_pose(pose, report_.map_origin_m); }
  static Pose2 local_pose(const Pose2& pose, const Eigen::Vector2d& origin) {
    return {pose.x_m - origin.x(), pose.y_m - origin.y(), pose.yaw_rad};
  }
  static double scale(const Grid& grid, const MapWindow& window) {
    constexpr double kMaxWidthPx = 1100.0, kMaxHeightPx = 850.0;
    return std::min(kMaxWidthPx / ((window.i1 - window.i0) * grid.cell_m),
                    kMaxHeightPx / ((window.j1 - window.j0) * grid.cell_m));
  }
  double width_m() const { return (window_.i1 - window_.i0) * terrain_.elevation().cell_m; }
  double height_m() const { return (window_.j1 - window_.j0) * terrain_.elevation().cell_m; }
  Eigen::Vector2d lower_left_m() const {
    // Samples are drawn as cells around them.
    const Grid& g = terrain_.elevation();
    return g.origin_m + g.cell_m * Eigen::Vector2d(window_.i0 - 0.5, window_.j0 - 0.5);
  }
  Eigen::Vector2d px(const Eigen::Vector2d& p_m) const {
    const Eigen::Vector2d d = scale_px_m_ * (p_m - lower_left_m());
    return {box_.x + d.x(), box_.y + box_.height - d.y()};
  }
  Points px(Points points) const {
    for (Eigen::Vector2d& p : points) p = px(p);
    return points;
  }

  Points everything() const {
    Points points{{start_.x_m, start_.y_m}, {goal_.x_m, goal_.y_m}};
    const auto append = [&points](const Points& more) {
      points.insert(points.end(), more.begin(), more.end());
    };
    if (report_.plan) append(base_path(report_.plan->nodes));
    if (report_.drive) append(driven_path(report_.drive->samples));
    if (report_.search) {
      for (const FailedPath& path : report_.search->failed_paths()) {
        points.emplace_back(path.where.x_m, path.where.y_m);
      }
    }
    return points;
  }

  void draw_title() {
    const std::string outcome = report_.failure ? "failed" : "success";
    canvas_.text({kLeft, 26.0},
                 report_.options.map.filename().string() + ", seed " +
                     std::to_string(report_.options.seed) + ": " + outcome,
                 17.0, Align::kLeft, kBlack, 0.0, true);
  }

  void draw_contours() {
    const auto [lo, hi] = height_range_m(terrain_.elevation(), window_);
    contour_step_m_ = hi - lo < 1.0 ? 0.1 : hi - lo < 2.5 ? 0.25 : hi - lo < 6.0 ? 0.5 : 1.0;
    for (const auto& [a, b] : contour_pieces(terrain_.fitted_height(), window_, contour_step_m_)) {
      canvas_.line({px(a), px(b)}, {{0.25, 0.20, 0.15, 0.35}, 0.7});
    }
  }

  void draw_paths() {
    if (report_.drive) {
      for (int i = 0; i < kNumWheels; ++i) {
        Points track;
        for (const DriveSample& s : report_.drive->samples) track.push_back(s.wheel_m[i]);
        canvas_.line(px(track), {kTrack, 1.3});
      }
    }
    if (report_.plan) {
      canvas_.line(px(base_path(report_.plan->nodes)), {kWhite, 9.5});
      canvas_.line(px(base_path(report_.plan->nodes)), {kPlanned, 7.5});
    }
    if (marks_) draw_steps();
    if (report_.drive) {
      canvas_.line(px(driven_path(report_.drive->samples)), {kDriven, 3.0});
    }
    if (report_.refined) {
      canvas_.line(px(base_path(report_.refined->nodes)), {kRefined, 1.2, 4.0});
    }
  }

  void draw_steps() {
    for (const TrackPiece& piece : marks_->base) {
      if (piece.lifted) canvas_.line(px(piece.points), {kSteppingBase, 7.5});
    }
    for (const auto& wheel : marks_->wheels) {
      for (const TrackPiece& piece : wheel) {
        canvas_.line(px(piece.points), piece.lifted ? kLiftedStroke : Stroke{kTrack, 1.3});
      }
    }
    for (const Eigen::Vector2d& p : marks_->lift_offs) foothold(px(p), false);
    for (const Eigen::Vector2d& p : marks_->touch_downs) foothold(px(p), true);
    for (const Eigen::Vector2d& p : marks_->bucket_points) bucket(px(p));
  }

  void foothold(const Eigen::Vector2d& at, bool filled) {
    constexpr double kSize = 8.0;
    const Box box{at.x() - 0.5 * kSize, at.y() - 0.5 * kSize, kSize, kSize};
    canvas_.fill(box, filled ? kLifted : kWhite);
    canvas_.outline(box, {kLifted, 1.5});
  }

  void bucket(const Eigen::Vector2d& at) {
    constexpr double kSize = 8.0;
    const auto diamond = [&](double size) {
      return Points{at + Eigen::Vector2d(size, 0.0), at + Eigen::Vector2d(0.0, size),
                    at - Eigen::Vector2d(size, 0.0), at - Eigen::Vector2d(0.0, size)};
    };
    canvas_.polygon(diamond(kSize + 1.5), kWhite);
    canvas_.polygon(diamond(kSize), kBucket);
  }

  void cross(const Eigen::Vector2d& at, bool stepping) {
    constexpr double kSize = 8.0;
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::Vector2d arm(kSize, sign * kSize);
      canvas_.line({at - arm, at + arm}, {kWhite, 5.5});
      canvas_.line({at - arm, at + arm}, {stepping ? kFailed : kPlanned, 3.0});
    }
  }

  /// Where paths that the search found could not be followed.
  void draw_failures() {
    for (std::size_t k = failed_.size(); k-- > 0;) {
      const Eigen::Vector2d at =
          px(Eigen::Vector2d(failed_[k].last.where.x_m, failed_[k].last.where.y_m));
      cross(at, failed_[k].last.stepping);
      if (k < kMaxFailedPlaces) {
        halo_text(at + Eigen::Vector2d(0.0, -13.0), std::to_string(k + 1), kFailed);
      }
    }
  }

  /// What was turned down, below the map.
  void list_failures() {
    if (!report_.search) return;
    double y = kTop + std::max(box_.height, kLegendHeight) + kBottom + 10.0;
    const auto line = [&](const std::string& text) {
      canvas_.text({20.0, y}, text, kText);
      y += kLine;
    };
    std::string poses = "rejected of " + std::to_string(report_.search->num_poses()) + " poses: ";
    std::size_t named = 0;
    for (const auto& [count, reason] : report_.search->rejections()) {
      if (named == 4) break;
      poses += (named++ > 0 ? ", " : "") + reason + " " + std::to_string(count);
    }
    line(named > 0 ? poses : "no pose was rejected");
    for (std::size_t k = 0; k < std::min(failed_.size(), kMaxFailedPlaces); ++k) {
      line(std::to_string(k + 1) + "  " + std::to_string(failed_[k].count) +
           (failed_[k].last.stepping ? " stepping" : " driving") +
           " path(s) found no way through here: " + failed_[k].last.why);
    }
  }

  /// Chassis and wheels of the default stance, so that the scale of the machine is seen.
  void draw_machine_outline(const Pose2& pose, const Color& color) {
    const Eigen::Rotation2Dd turn(pose.yaw_rad);
    const Eigen::Vector2d centre(pose.x_m, pose.y_m);
    const auto rectangle = [&](const Eigen::Vector2d& lo, const Eigen::Vector2d& hi) {
      Points corners{lo, {hi.x(), lo.y()}, hi, {lo.x(), hi.y()}, lo};
      for (Eigen::Vector2d& corner : corners) corner = centre + turn * corner;
      canvas_.line(px(corners), {color, 1.5});
    };
    rectangle(machine_.belly_min_m, machine_.belly_max_m);
    Eigen::VectorXd q = Eigen::VectorXd::Zero(machine_.num_coordinates());
    q.tail(machine_.num_joints()) = machine_.transport_posture();
    KinematicTree::Workspace workspace = machine_.tree.make_workspace();
    machine_.tree.update(q, workspace);
    for (const WheeledLeg& leg : machine_.legs) {
      const Eigen::Vector2d wheel =
          machine_.tree.position(workspace, leg.carrier_body, leg.p_carrier_wheel).head<2>();
      const Eigen::Vector2d half(leg.radius_m, leg.half_width_m);
      rectangle(wheel - half, wheel + half);
    }
  }

  void draw_arrow(const Pose2& pose, const Color& color, const char* label) {
    constexpr double kLengthM = 3.0;
    const Eigen::Vector2d at(pose.x_m, pose.y_m);
    const Eigen::Vector2d ahead(std::cos(pose.yaw_rad), std::sin(pose.yaw_rad));
    const Eigen::Vector2d tail = px(at), tip = px(Eigen::Vector2d(at + kLengthM * ahead));
    const Eigen::Vector2d along = (tip - tail).normalized(), across(-along.y(), along.x());
    const auto shape = [&](double grow, const Color& c) {
      canvas_.line({tail, tip - 10.0 * along}, {c, 3.5 + 2.0 * grow});
      canvas_.polygon(
          {tip + (1.5 * grow) * along, tip - (14.0 + grow) * along + (7.0 + grow) * across,
           tip - (14.0 + grow) * along - (7.0 + grow) * across},
          c);
    };
    shape(1.2, kWhite);
    shape(0.0, color);
    // Beside the chassis, opposite to where the arrow points.
    const double aside_px = scale_px_m_ * machine_.belly_max_m.norm() + 12.0;
    halo_text(
        tail + Eigen::Vector2d(0.0, std::sin(pose.yaw_rad) < 0.0 ? -aside_px : aside_px + 8.0),
        label, color);
  }

  void halo_text(const Eigen::Vector2d& at, const std::string& text, const Color& color) {
    for (const Eigen::Vector2d& shift :
         {Eigen::Vector2d(1.2, 0.0), {-1.2, 0.0}, {0.0, 1.2}, {0.0, -1.2}}) {
      canvas_.text(at + shift, text, kText + 1.0, Align::kCentre, kWhite, 0.0, true);
    }
    canvas_.text(at, text, kText + 1.0, Align::kCentre, color, 0.0, true);
  }

  void draw_scale_bar() {
    const double length_m = width_m() > 60.0 ? 10.0 : width_m() > 20.0 ? 5.0 : 2.0;
    const double length_px = length_m * scale_px_m_;
    const Eigen::Vector2d at(box_.x + 20.0, box_.y + box_.height - 18.0);
    canvas_.fill({at.x() - 8.0, at.y() - 24.0, length_px + 16.0, 34.0}, {1.0, 1.0, 1.0, 0.8});
    canvas_.fill({at.x(), at.y(), 0.5 * length_px, 5.0}, kBlack);
    canvas_.outline({at.x(), at.y(), length_px, 5.0}, {kBlack, 1.0});
    canvas_.text({at.x() + 0.5 * length_px, at.y() - 6.0},
                 std::to_string(static_cast<int>(length_m)) + " m", kText, Align::kCentre);
  }

  void draw_axes() {
    canvas_.outline(box_, {kBlack, 1.0});
    const Eigen::Vector2d lo = lower_left_m() + report_.map_origin_m;
    const Eigen::Vector2d hi = lo + Eigen::Vector2d(width_m(), height_m());
    const auto labels = [&](double from, double to, int count, const auto& place) {
      const std::vector<double> values = ticks(from, to, count);
      const double step = values.size() > 1 ? values[1] - values[0] : 1.0;
      for (const double value : values) place(value, tick_label(value, step));
    };
    const double bottom = box_.y + box_.height;
    labels(lo.x(), hi.x(), 8, [&](double x, const std::string& label) {
      const double at = box_.x + (x - lo.x()) * scale_px_m_;
      canvas_.line({{at, bottom}, {at, bottom + 5.0}}, {kBlack, 1.0});
      canvas_.text({at, bottom + 19.0}, label, kText, Align::kCentre);
    });
    labels(lo.y(), hi.y(), 6, [&](double y, const std::string& label) {
      const double at = bottom - (y - lo.y()) * scale_px_m_;
      canvas_.line({{box_.x - 5.0, at}, {box_.x, at}}, {kBlack, 1.0});
      canvas_.text({box_.x - 8.0, at + 4.5}, label, kText, Align::kRight);
    });
    canvas_.text({box_.x + 0.5 * box_.width, bottom + 42.0}, "x, map frame (m)", kText,
                 Align::kCentre);
    canvas_.text({20.0, box_.y + 0.5 * box_.height}, "y, map frame (m)", kText, Align::kCentre,
                 kBlack, 0.5 * std::numbers::pi);
  }

  void draw_legend() {
    const double x = box_.x + box_.width + 22.0;
    double y = kTop + 10.0;
    const auto entry = [&](const std::string& text, const auto& symbol) {
      symbol(y);
      canvas_.text({x + 42.0, y + 4.5}, text, kText);
      y += 24.0;
    };
    const auto stroke = [&](const Stroke& s) {
      return [this, x, s](double at) { canvas_.line({{x, at}, {x + 32.0, at}}, s); };
    };
    const Stroke planned{kPlanned, 7.5};
    if (report_.plan) entry("planned path", stroke(planned));
    if (report_.refined) entry("refined path", stroke({kRefined, 1.2, 4.0}));
    if (report_.drive) {
      entry("driven path", stroke({kDriven, 3.0}));
      entry("wheel tracks", stroke({kTrack, 1.3}));
    }
    if (marks_) {
      entry("base, with wheels lifted", stroke({kSteppingBase, 7.5}));
      entry("wheel tracks", stroke({kTrack, 1.3}));
      entry("wheel in the air", stroke(kLiftedStroke));
      entry("lifted off, put down", [this, x](double at) {
        foothold({x + 8.0, at}, false);
        foothold({x + 24.0, at}, true);
      });
      entry("bucket put down", [this, x](double at) { bucket({x + 16.0, at}); });
    }
    const auto failed = [&](bool stepping, const char* text) {
      if (std::none_of(failed_.begin(), failed_.end(),
                       [&](const FailedPlace& place) { return place.last.stepping == stepping; })) {
        return;
      }
      entry(text, [this, x, stepping](double at) { cross({x + 16.0, at}, stepping); });
    };
    failed(true, "no way through, stepping");
    failed(false, "no way through, driving");
    const auto patch = [&](const Color& c) {
      return [this, x, c](double at) {
        canvas_.fill({x + 4.0, at - 8.0, 24.0, 16.0}, c);
        canvas_.outline({x + 4.0, at - 8.0, 24.0, 16.0}, {kGrey, 0.7});
      };
    };
    entry("not traversable", patch({0.79, 0.45, 0.37}));
    entry("unknown", patch({0.55, 0.55, 0.58}));
    char text[64];
    std::snprintf(text, sizeof(text), "contours every %g m", contour_step_m_);
    entry(text, stroke({{0.25, 0.20, 0.15, 0.6}, 0.7}));
    draw_height_scale({x + 4.0, y + 26.0, 24.0, 150.0});
  }

  void draw_height_scale(const Box& bar) {
    const auto [lo, hi] = tint_range_m(terrain_.elevation(), window_);
    canvas_.text({bar.x, bar.y - 12.0}, "height (m)", kText);
    constexpr int kSteps = 50;
    for (int k = 0; k < kSteps; ++k) {
      const double share = (k + 0.5) / kSteps;
      canvas_.fill({bar.x, bar.y + bar.height * k / kSteps, bar.width, bar.height / kSteps + 1.0},
                   height_tint(1.0 - share, 0.0, 1.0));
    }
    canvas_.outline(bar, {kGrey, 0.7});
    char text[32];
    for (const auto& [value, share] : {std::pair{hi, 0.0}, {0.5 * (lo + hi), 0.5}, {lo, 1.0}}) {
      std::snprintf(text, sizeof(text), "%.2f", value);
      canvas_.text({bar.x + bar.width + 8.0, bar.y + share * bar.height + 4.5}, text, kText);
    }
  }

  const RunReport& report_;
  const TerrainMap& terrain_;
  const MachineModel& machine_;
  static constexpr Stroke kLiftedStroke{kLifted, 1.8, 5.0};
  std::optional<SteppingMarks> marks_;
  std::vector<FailedPlace> failed_;
  Pose2 start_, goal_;
  MapWindow window_;
  double scale_px_m_;
  Box box_;
  Canvas canvas_;
  double contour_step_m_ = 1.0;
};

}  // namespace

Result<void> draw_overview(const RunReport& report, const TerrainMap& terrain,
                           const MachineModel& machine, const std::filesystem::path& file) {
  return Overview(report, terrain, machine).draw(file);
}

}  // namespace wex::app
