#include "tools/wex/timeline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wex::app {
namespace {

constexpr Color kBlack{0.0, 0.0, 0.0}, kGrid{0.88, 0.88, 0.88}, kLimitColor{0.75, 0.15, 0.10},
    kTail{0.94, 0.94, 0.97}, kWheel{0.10, 0.50, 0.25}, kBucket{0.60, 0.15, 0.60};
constexpr double kText = 13.0;
constexpr double kWidth = 1200.0, kLeft = 110.0, kPlotWidth = 850.0;
constexpr double kTop = 48.0, kPanelHeight = 150.0, kGap = 24.0, kBar = 14.0, kLimbPitch = 22.0;
constexpr double kLegend = kLeft + kPlotWidth + 16.0;

std::pair<double, double> range(const Panel& panel) {
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

}  // namespace

Timeline::Timeline(double end_s, int num_limbs, int num_panels, std::optional<Tail> tail)
    : end_s_(end_s),
      num_limbs_(num_limbs),
      tail_(std::move(tail)),
      canvas_(static_cast<int>(kWidth),
              static_cast<int>(kTop + kLimbPitch * num_limbs + kGap +
                               num_panels * (kPanelHeight + kGap) + 50.0)),
      y_(kTop) {
  WEX_EXPECTS(num_limbs >= 1 && num_limbs <= kNumLimbs && end_s > 0.0);
}

void Timeline::title(const std::string& text) {
  canvas_.text({kLeft, 28.0}, text, 17.0, Align::kLeft, kBlack, 0.0, true);
}

void Timeline::contacts(const ContactSchedule& schedule, const std::string& meaning) {
  const double top = y_, height = kLimbPitch * num_limbs_;
  time_grid({kLeft, top, kPlotWidth, height});
  for (int limb = 0; limb < num_limbs_; ++limb) {
    const double y = top + kLimbPitch * limb + 0.5 * (kLimbPitch - kBar);
    canvas_.text({kLeft - 8.0, y + 12.0}, std::string(kLimbNames[limb]), kText, Align::kRight);
    for (const ContactInterval& interval : schedule[limb]) {
      canvas_.fill({x(interval.from_s), y, x(interval.to_s) - x(interval.from_s), kBar},
                   Limb{limb} == Limb::kArm ? kBucket : kWheel);
    }
  }
  canvas_.outline({kLeft, top, kPlotWidth, height}, {kBlack, 1.0});
  vertical_title("contact", top, height);
  canvas_.text({kLegend, top + 14.0}, meaning, kText);
  if (tail_) {
    canvas_.fill({kLegend, top + 24.0, 24.0, 14.0}, kTail);
    canvas_.outline({kLegend, top + 24.0, 24.0, 14.0}, {kGrid, 1.0});
    canvas_.text({kLegend + 32.0, top + 36.0}, tail_->name, kText);
  }
  y_ = top + height + kGap;
}

void Timeline::panel(const Panel& panel) {
  const Box box{kLeft, y_, kPlotWidth, kPanelHeight};
  const auto [lo, hi] = range(panel);
  const ToPixel y = [&box, lo = lo, hi = hi](double value) {
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
                 {kLimitColor, 1.3, 6.0});
  }
  for (const Curve& curve : panel.curves) draw(curve, y);
  canvas_.unclip();
  for (const Curve& curve : panel.curves) legend(legend_y, curve.name, {curve.color, 2.5});
  for (const Limit& limit : panel.limits) {
    if (!limit.name.empty()) legend(legend_y, limit.name, {kLimitColor, 1.3, 6.0});
  }
  canvas_.outline(box, {kBlack, 1.0});
  vertical_title(panel.title, box.y, box.height);
  y_ += kPanelHeight + kGap;
}

void Timeline::time_axis(const std::string& title) {
  const double bottom = y_ - kGap;
  const std::vector<double> values = ticks(0.0, end_s_, 10);
  for (const double value : values) {
    canvas_.line({{x(value), bottom}, {x(value), bottom + 5.0}}, {kBlack, 1.0});
    canvas_.text({x(value), bottom + 20.0}, tick_label(value, values[1] - values[0]), kText,
                 Align::kCentre);
  }
  canvas_.text({kLeft + 0.5 * kPlotWidth, bottom + 44.0}, title, kText, Align::kCentre);
}

Result<void> Timeline::write(const std::filesystem::path& file) const {
  return canvas_.write_png(file);
}

double Timeline::x(double t_s) const { return kLeft + kPlotWidth * t_s / end_s_; }

void Timeline::time_grid(const Box& box) {
  if (tail_) {
    canvas_.fill({x(tail_->from_s), box.y, x(end_s_) - x(tail_->from_s), box.height}, kTail);
  }
  for (const double value : ticks(0.0, end_s_, 10)) {
    canvas_.line({{x(value), box.y}, {x(value), box.y + box.height}}, {kGrid, 1.0});
  }
}

void Timeline::vertical_title(const std::string& text, double top, double height) {
  canvas_.text({34.0, top + 0.5 * height}, text, kText, Align::kCentre, kBlack,
               0.5 * std::numbers::pi);
}

void Timeline::legend(double& y, const std::string& name, const Stroke& stroke) {
  canvas_.line({{kLegend, y - 4.0}, {kLegend + 24.0, y - 4.0}}, stroke);
  canvas_.text({kLegend + 32.0, y}, name, kText);
  y += 20.0;
}

void Timeline::draw(const Curve& curve, const ToPixel& y) {
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

}  // namespace wex::app
