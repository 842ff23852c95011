#include "tools/wex/timeline_picture.hpp"

#include <algorithm>
#include <cmath>

#include "tools/wex/canvas.hpp"
#include "tools/wex/motion_csv.hpp"

namespace wex::app {
namespace {

constexpr Color kBlack{0.0, 0.0, 0.0}, kGrid{0.88, 0.88, 0.88}, kLimit{0.75, 0.15, 0.10},
    kHold{0.94, 0.94, 0.97};
constexpr Color kBlue{0.10, 0.35, 0.80}, kOrange{0.90, 0.45, 0.00}, kGreen{0.10, 0.50, 0.25};
constexpr double kText = 13.0;
constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kWidth = 1200.0, kLeft = 110.0, kPlotWidth = 850.0;

struct Curve {
  std::string name;
  Color color;
  std::vector<Eigen::Vector2d> points;  ///< (time [s], value)
  bool dots = false;
};

struct Limit {
  double value = 0.0;
  std::string name;  ///< empty: the line speaks for itself
};

struct Panel {
  std::string title;  ///< quantity and unit
  std::vector<Curve> curves;
  std::vector<Limit> limits;
  double least_lo = 0.0, least_hi = 1.0;  ///< range that is shown at least
};

/// Panels stacked over one time axis.
class Timeline {
 public:
  Timeline(double hold_from_s, double end_s, int num_panels)
      : hold_from_s_(hold_from_s),
        end_s_(end_s),
        canvas_(
            static_cast<int>(kWidth),
            static_cast<int>(kTop + kContactsHeight + num_panels * (kPanelHeight + kGap) + 70.0)),
        y_(kTop) {}

  void title(const std::string& text) {
    canvas_.text({kLeft, 28.0}, text, 17.0, Align::kLeft, kBlack, 0.0, true);
  }

  void contacts(const std::vector<DriveSample>& samples) {
    constexpr double kBar = 14.0, kPitch = 22.0;
    const double top = y_;
    time_grid({kLeft, top, kPlotWidth, kPitch * kNumWheels});
    for (int limb = 0; limb < kNumWheels; ++limb) {
      const double y = top + kPitch * limb + 0.5 * (kPitch - kBar);
      canvas_.text({kLeft - 8.0, y + 12.0}, std::string(kLimbNames[limb]), kText, Align::kRight);
      for (std::size_t k = 0; k < samples.size();) {
        // One rectangle per unbroken contact.
        std::size_t end = k;
        while (end < samples.size() && samples[end].contacts[limb]) ++end;
        if (end > k) {
          const double from = x(samples[k].t_s);
          const double to = x(end < samples.size() ? samples[end].t_s : samples.back().t_s);
          canvas_.fill({from, y, to - from, kBar}, kGreen);
        }
        k = std::max(end, k + 1);
      }
    }
    canvas_.outline({kLeft, top, kPlotWidth, kPitch * kNumWheels}, {kBlack, 1.0});
    vertical_title("contact", top, kPitch * kNumWheels);
    canvas_.text({kLegend, top + 14.0}, "bar: wheel carries load", kText);
    canvas_.fill({kLegend, top + 24.0, 24.0, 14.0}, kHold);
    canvas_.outline({kLegend, top + 24.0, 24.0, 14.0}, {kGrid, 1.0});
    canvas_.text({kLegend + 32.0, top + 36.0}, "stopped, holding", kText);
    y_ = top + kContactsHeight + kGap;
  }

  void panel(const Panel& panel) {
    const Box box{kLeft, y_, kPlotWidth, kPanelHeight};
    const auto [lo, hi] = range(panel);
    const auto y = [&, lo = lo, hi = hi](double value) {
      return box.y + box.height * (1.0 - (value - lo) / (hi - lo));
    };
    time_grid(box);
    const std::vector<double> values = ticks(lo, hi, 5);
    for (const double value : values) {
      canvas_.line({{box.x, y(value)}, {box.x + box.width, y(value)}}, {kGrid, 1.0});
      canvas_.text({box.x - 8.0, y(value) + 4.5}, tick_label(value, values[1] - values[0]), kText,
                   Align::kRight);
    }
    double legend_y = box.y + 14.0;
    canvas_.clip(box);
    for (const Limit& limit : panel.limits) {
      canvas_.line({{box.x, y(limit.value)}, {box.x + box.width, y(limit.value)}},
                   {kLimit, 1.3, 6.0});
    }
    for (const Curve& curve : panel.curves) draw(curve, y);
    canvas_.unclip();
    for (const Curve& curve : panel.curves) {
      legend(legend_y, curve.name, {curve.color, 2.5});
    }
    for (const Limit& limit : panel.limits) {
      if (!limit.name.empty()) legend(legend_y, limit.name, {kLimit, 1.3, 6.0});
    }
    canvas_.outline(box, {kBlack, 1.0});
    vertical_title(panel.title, box.y, box.height);
    y_ += kPanelHeight + kGap;
  }

  void time_axis() {
    const double bottom = y_ - kGap;
    const std::vector<double> values = ticks(0.0, end_s_, 10);
    for (const double value : values) {
      canvas_.line({{x(value), bottom}, {x(value), bottom + 5.0}}, {kBlack, 1.0});
      canvas_.text({x(value), bottom + 20.0}, tick_label(value, values[1] - values[0]), kText,
                   Align::kCentre);
    }
    canvas_.text({kLeft + 0.5 * kPlotWidth, bottom + 44.0}, "time of the drive (s)", kText,
                 Align::kCentre);
  }

  Result<void> write(const std::filesystem::path& file) const { return canvas_.write_png(file); }

 private:
  static constexpr double kTop = 48.0, kPanelHeight = 150.0, kGap = 24.0, kContactsHeight = 88.0;
  static constexpr double kLegend = kLeft + kPlotWidth + 16.0;

  double x(double t_s) const { return kLeft + kPlotWidth * t_s / end_s_; }

  void time_grid(const Box& box) {
    canvas_.fill({x(hold_from_s_), box.y, x(end_s_) - x(hold_from_s_), box.height}, kHold);
    for (const double value : ticks(0.0, end_s_, 10)) {
      canvas_.line({{x(value), box.y}, {x(value), box.y + box.height}}, {kGrid, 1.0});
    }
  }

  void vertical_title(const std::string& text, double top, double height) {
    canvas_.text({34.0, top + 0.5 * height}, text, kText, Align::kCentre, kBlack,
                 0.5 * std::numbers::pi);
  }

  void legend(double& y, const std::string& name, const Stroke& stroke) {
    canvas_.line({{kLegend, y - 4.0}, {kLegend + 24.0, y - 4.0}}, stroke);
    canvas_.text({kLegend + 32.0, y}, name, kText);
    y += 20.0;
  }

  template <typename ToPixel>
  void draw(const Curve& curve, const ToPixel& y) {
    if (curve.dots) {
      constexpr double kDot = 3.0;
      for (const Eigen::Vector2d& p : curve.points) {
        canvas_.fill({x(p.x()) - 0.5 * kDot, y(p.y()) - 0.5 * kDot, kDot, kDot}, curve.color);
      }
      return;
    }
    std::vector<Eigen::Vector2d> pixels;
    for (const Eigen::Vector2d& p : curve.points) {
      if (std::isfinite(p.y())) pixels.emplace_back(x(p.x()), y(p.y()));
    }
    canvas_.line(pixels, {curve.color, 1.6});
  }

  static std::pair<double, double> range(const Panel& panel) {
    double lo = panel.least_lo, hi = panel.least_hi;
    for (const Curve& curve : panel.curves) {
      for (const Eigen::Vector2d& p : curve.points) {
        if (!std::isfinite(p.y())) continue;
        lo = std::min(lo, p.y());
        hi = std::max(hi, p.y());
      }
    }
    const double border = 0.05 * (hi - lo);
    return {lo < panel.least_lo || lo < 0.0 ? lo - border : lo, hi + border};
  }

  double hold_from_s_, end_s_;
  Canvas canvas_;
  double y_;
};

template <typename Value>
Curve curve(std::string name, const Color& color, const std::vector<DriveSample>& samples,
            const Value& value) {
  Curve c{std::move(name), color, {}, false};
  for (const DriveSample& s : samples) c.points.emplace_back(s.t_s, value(s));
  return c;
}

}  // namespace

Result<void> draw_timeline(const RunReport& report, const std::filesystem::path& file) {
  WEX_EXPECTS(report.drive && report.drive->samples.size() > 1);
  const std::vector<DriveSample>& samples = report.drive->samples;

  const Panel tilt{
      "tilt (degrees)",
      {curve("roll", kBlue, samples, [](const auto& s) { return kDegrees * s.base[kBaseRoll]; }),
       curve("pitch", kOrange, samples,
             [](const auto& s) { return kDegrees * s.base[kBasePitch]; })},
      {{20.0, "planning limit, 20"}, {-20.0, ""}},
      -22.0,
      22.0};
  const Panel margin{
      "stability margin (m)",
      {curve("scheduled wheels", kBlue, samples,
             [](const auto& s) { return s.scheduled_margin_m; }),
       curve("loaded wheels", kOrange, samples, [](const auto& s) { return s.loaded_margin_m; })},
      {{0.30, "plan, 0.30"}, {0.25, "refinement, 0.25"}, {0.15, "driven, 0.15"}},
      0.0,
      1.0};
  const Panel tracking{
      "tracking (m)",
      {curve("to the reference", kBlue, samples, [](const auto& s) { return s.reference_error_m; }),
       curve("to the goal (clipped)", kOrange, samples,
             [](const auto& s) {
               return s.goal_distance_m < 0.6 ? s.goal_distance_m
                                              : std::numeric_limits<double>::quiet_NaN();
             })},
      {{0.30, "goal tolerance, 0.30"}},
      0.0,
      0.4};
  Curve solve_times{"CPU time of a solve", kBlue, {}, true};
  for (const SolveSample& s : report.drive->solves) {
    solve_times.points.emplace_back(s.t_s, 1e3 * s.cpu_time_s);
  }
  Curve unusable{"no usable result", kLimit, {}, true};
  for (const SolveSample& s : report.drive->solves) {
    if (!s.usable) unusable.points.emplace_back(s.t_s, 1e3 * s.cpu_time_s);
  }
  Panel solving{"solve time (ms)", {solve_times}, {{100.0, "period, 100"}}, 0.0, 120.0};
  if (!unusable.points.empty()) solving.curves.push_back(unusable);

  Timeline timeline(report.drive->duration_s, samples.back().t_s, 4);
  timeline.title(report.options.map.filename().string() + ", seed " +
                 std::to_string(report.options.seed) + ": the drive over time");
  timeline.contacts(samples);
  for (const Panel& panel : {tilt, margin, tracking, solving}) timeline.panel(panel);
  timeline.time_axis();
  return timeline.write(file);
}

}  // namespace wex::app
