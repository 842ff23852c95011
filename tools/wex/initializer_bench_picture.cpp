#include "tools/wex/initializer_bench_picture.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "tools/bench/drive_bench_table.hpp"
#include "tools/wex/canvas.hpp"

namespace wex::app {
namespace {

constexpr Color kBlack{0.0, 0.0, 0.0}, kGrid{0.88, 0.88, 0.88};
constexpr Color kBlue{0.10, 0.35, 0.80}, kOrange{0.90, 0.45, 0.00}, kGreen{0.10, 0.50, 0.25};
constexpr double kText = 13.0, kLeft = 90.0, kWidth = 1000.0, kPlotWidth = 880.0;

/// Maps values to pixels of one panel, linear or logarithmic upwards.
class Panel {
 public:
  Panel(Canvas& canvas, double top, double height, double lo, double hi, bool logarithmic)
      : canvas_(canvas), top_(top), height_(height), lo_(lo), hi_(hi), log_(logarithmic) {}

  [[nodiscard]] double y(double value) const {
    const auto f = [&](double v) { return log_ ? std::log10(v) : v; };
    const double share = (f(std::clamp(value, lo_, hi_)) - f(lo_)) / (f(hi_) - f(lo_));
    return top_ + height_ * (1.0 - share);
  }
  void frame(const std::string& title) {
    if (log_) {
      for (double v = lo_; v <= hi_ * 1.0001; v *= 10.0) grid(v, v / 10.0);
    } else {
      const std::vector<double> at = ticks(lo_, hi_, 5);
      for (const double v : at) {
        if (v >= lo_ && v <= hi_) grid(v, at.size() > 1 ? at[1] - at[0] : 1.0);
      }
    }
    canvas_.outline({kLeft, top_, kPlotWidth, height_}, {kBlack, 1.0});
    canvas_.text({22.0, top_ + 0.5 * height_}, title, kText, Align::kCentre, kBlack, M_PI / 2.0);
  }

 private:
  void grid(double value, double step) {
    canvas_.line({{kLeft, y(value)}, {kLeft + kPlotWidth, y(value)}}, {kGrid, 1.0});
    canvas_.text({kLeft - 8.0, y(value) + 4.0}, tick_label(value, step), kText, Align::kRight);
  }

  Canvas& canvas_;
  double top_, height_, lo_, hi_;
  bool log_;
};

using Value = std::function<double(const InitializerRow&)>;

std::vector<double> sorted_values(const InitializerBenchOutcome& outcome,
                                  const std::string& terrain, const Value& value) {
  std::vector<double> values;
  for (const InitializerRow& row : outcome.rows) {
    const auto cell = std::find_if(outcome.cells.begin(), outcome.cells.end(),
                                   [&](const InitializerCell& c) { return c.name == row.cell; });
    if (row.accepted && cell != outcome.cells.end() && cell->terrain == terrain) {
      values.push_back(value(row));
    }
  }
  std::sort(values.begin(), values.end());
  return values;
}

double at_share(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
}

std::vector<std::string> terrains(const InitializerBenchOutcome& outcome) {
  std::vector<std::string> names;
  for (const InitializerCell& cell : outcome.cells) {
    if (std::find(names.begin(), names.end(), cell.terrain) == names.end()) {
      names.push_back(cell.terrain);
    }
  }
  return names;
}

void draw_spread(Canvas& canvas, const Panel& panel, double x, const std::vector<double>& sorted,
                 const Color& color) {
  if (sorted.empty()) return;
  canvas.line({{x, panel.y(at_share(sorted, 0.05))}, {x, panel.y(at_share(sorted, 0.95))}},
              {color, 3.0});
  const double median = panel.y(at_share(sorted, 0.5));
  canvas.fill({x - 6.0, median - 6.0, 12.0, 12.0}, color);
}

Result<void> draw_times(const InitializerBenchOutcome& outcome, const std::filesystem::path& file) {
  const std::vector<std::string> names = terrains(outcome);
  Canvas canvas(static_cast<int>(kWidth), 660);
  canvas.text({kLeft, 28.0}, "Time to the first accepted plan, cost of the first and of the last",
              17.0, Align::kLeft, kBlack, 0.0, true);
  Panel time(canvas, 50.0, 230.0, 0.001, 10.0, true);
  time.frame("first plan [s of one core]");
  double highest_cost = 20.0;
  for (const InitializerRow& row : outcome.rows) {
    if (row.accepted) highest_cost = std::max({highest_cost, row.cost, row.first_cost});
  }
  Panel cost(canvas, 320.0, 230.0, 0.0, 1.05 * highest_cost, false);
  cost.frame("cost [m of driving]");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double x =
        kLeft + kPlotWidth * (static_cast<double>(i) + 0.5) / static_cast<double>(names.size());
    draw_spread(canvas, time, x,
                sorted_values(outcome, names[i], [](const auto& row) { return row.first_s; }),
                kBlue);
    draw_spread(canvas, cost, x - 10.0,
                sorted_values(outcome, names[i], [](const auto& row) { return row.first_cost; }),
                kOrange);
    draw_spread(canvas, cost, x + 10.0,
                sorted_values(outcome, names[i], [](const auto& row) { return row.cost; }), kGreen);
    canvas.text({x, 572.0}, names[i], kText, Align::kCentre);
  }
  canvas.text({kLeft, 610.0}, "square: median, bar: 5 to 95 % of all accepted runs", kText);
  canvas.fill({kLeft, 624.0, 12.0, 12.0}, kOrange);
  canvas.text({kLeft + 18.0, 635.0}, "first plan", kText);
  canvas.fill({kLeft + 110.0, 624.0, 12.0, 12.0}, kGreen);
  canvas.text({kLeft + 128.0, 635.0}, "at the end of the budget", kText);
  return canvas.write_png(file);
}

Result<void> draw_success(const InitializerBenchOutcome& outcome,
                          const std::filesystem::path& file) {
  constexpr double kTop = 50.0, kHeight = 340.0;
  Canvas canvas(static_cast<int>(kWidth), 480);
  canvas.text({kLeft, 28.0}, "Accepted plans over difficulty, bars: 95 % Wilson interval", 17.0,
              Align::kLeft, kBlack, 0.0, true);
  Panel share(canvas, kTop, kHeight, 0.0, 105.0, false);
  share.frame("accepted [%]");
  const std::vector<std::pair<std::string, Color>> curves{
      {"rough", kBlue}, {"gap", kOrange}, {"step", kGreen}};
  for (const double d : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    canvas.text({kLeft + kPlotWidth * (0.06 + 0.88 * d), kTop + kHeight + 20.0},
                tick_label(d, 0.25), kText, Align::kCentre);
  }
  canvas.text({kLeft + 0.5 * kPlotWidth, kTop + kHeight + 42.0}, "difficulty", kText,
              Align::kCentre);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const double shift = 7.0 * (static_cast<double>(i) - 1.0);
    std::vector<Eigen::Vector2d> line;
    for (const InitializerCell& cell : outcome.cells) {
      if (!cell.has_levels || cell.terrain != curves[i].first) continue;
      int accepted = 0, runs = 0;
      for (const InitializerRow& row : outcome.rows) {
        if (row.cell != cell.name) continue;
        ++runs;
        accepted += row.accepted;
      }
      if (runs == 0) continue;
      const auto [low, high] = wilson_interval(accepted, runs);
      const double x = kLeft + kPlotWidth * (0.06 + 0.88 * cell.difficulty) + shift;
      const double y = share.y(100.0 * accepted / runs);
      canvas.line({{x, share.y(100.0 * low)}, {x, share.y(100.0 * high)}}, {curves[i].second, 2.0});
      canvas.fill({x - 5.0, y - 5.0, 10.0, 10.0}, curves[i].second);
      line.emplace_back(x, y);
    }
    if (line.size() > 1) canvas.line(line, {curves[i].second, 1.5});
    const double x = kLeft + 110.0 * static_cast<double>(i);
    canvas.fill({x, kTop + kHeight + 58.0, 12.0, 12.0}, curves[i].second);
    canvas.text({x + 18.0, kTop + kHeight + 69.0}, curves[i].first, kText);
  }
  return canvas.write_png(file);
}

}  // namespace

Result<void> draw_initializer_bench(const InitializerBenchOutcome& outcome,
                                    const std::filesystem::path& folder) {
  if (auto drawn = draw_times(outcome, folder / "times.png"); !drawn) return drawn;
  return draw_success(outcome, folder / "success.png");
}

}  // namespace wex::app
