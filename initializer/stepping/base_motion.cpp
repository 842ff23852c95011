#include "initializer/stepping/base_motion.hpp"

#include <algorithm>
#include <cmath>

#include "models/types/result.hpp"

namespace wex {
namespace {

constexpr double kLeverM = 2.4;          // from the base to a wheel: what a turn moves
constexpr double kShareStep = 0.25;      // how fast smoothing is given up where it does not fit
constexpr double kShareSlope_1_m = 1.0;  // and how fast it may change along the run

double way_m(const BaseCoordinates& a, const BaseCoordinates& b) {
  const BaseCoordinates d = (b - a).cwiseAbs();
  return std::max({d.head<2>().norm(), d[kBaseZ], kLeverM * d[kBasePitch], kLeverM * d[kBaseRoll]});
}

void limit_slope(const std::vector<BaseKnot>& knots, std::vector<double>& share) {
  const auto limit = [&](std::size_t from, std::size_t to) {
    const double step_m = std::abs(knots[to].sigma_m - knots[from].sigma_m);
    share[to] = std::min(share[to], share[from] + kShareSlope_1_m * step_m);
  };
  for (std::size_t i = 1; i < share.size(); ++i) limit(i - 1, i);
  for (std::size_t i = share.size() - 1; i > 0; --i) limit(i, i - 1);
}

}  // namespace

BaseRun::Point BaseRun::at(double sigma_m) const {
  const auto after =
      std::upper_bound(knots.begin(), knots.end(), sigma_m,
                       [](double sigma, const BaseKnot& knot) { return sigma < knot.sigma_m; });
  if (after == knots.begin()) return {knots.front().base, knots.front().curvature_1_m};
  if (after == knots.end()) return {knots.back().base, knots.back().curvature_1_m};
  const BaseKnot& a = *std::prev(after);
  const BaseKnot& b = *after;
  const double share = (sigma_m - a.sigma_m) / (b.sigma_m - a.sigma_m);
  return {a.base + share * (b.base - a.base),
          a.curvature_1_m + share * (b.curvature_1_m - a.curvature_1_m)};
}

std::vector<BaseRun> base_runs(const CertifiedSequence& sequence, double steering_window_m) {
  const std::vector<double> curvature =
      steered_curvature_1_m(sequence.path, sequence.stations, steering_window_m);
  std::vector<BaseRun> runs;
  for (std::size_t i = 0; i < sequence.states.size(); ++i) {
    const SteppingState& state = sequence.states[i];
    const Station& station = sequence.stations[state.station];
    BaseKnot knot{0.0, i, state.base, curvature[state.station], station.stop};
    if (runs.empty() || !(runs.back().support == state.support)) {
      runs.push_back({state.support, {}, {}});
    } else {
      const BaseKnot& last = runs.back().knots.back();
      const double step_m = way_m(last.base, knot.base);
      if (step_m < 1e-9) continue;
      knot.sigma_m = last.sigma_m + step_m;
    }
    runs.back().knots.push_back(knot);
  }
  return runs;
}

Result<void, MotionFailure> smooth_base(BaseRun& run, double window_m, const PoseJudge& judge) {
  const std::vector<BaseKnot> decided = run.knots;
  const std::size_t n = decided.size();
  std::vector<double> sigma(n);
  for (std::size_t i = 0; i < n; ++i) sigma[i] = decided[i].sigma_m;
  std::vector<BaseCoordinates> smoothed(n);
  for (std::size_t i = 0; i < n; ++i) smoothed[i] = decided[i].base;
  for (const int c : {kBaseZ, kBasePitch, kBaseRoll}) {
    std::vector<double> values(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = decided[i].base[c];
    values = moving_average(sigma, moving_average(sigma, values, window_m), window_m);
    for (std::size_t i = 0; i < n; ++i) smoothed[i][c] = values[i];
  }
  smoothed.front() = decided.front().base;
  smoothed.back() = decided.back().base;

  std::vector<double> share(n, 1.0), tried(n, -1.0);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < n; ++i) {
      while (tried[i] != share[i]) {
        tried[i] = share[i];
        run.knots[i].base = decided[i].base + share[i] * (smoothed[i] - decided[i].base);
        const auto why = judge(run.knots[i]);
        if (!why) break;
        if (share[i] <= 0.0 || smoothed[i] == decided[i].base) {
          return tl::unexpected<MotionFailure>({decided[i].state, *why});
        }
        share[i] = std::max(0.0, share[i] - kShareStep);
        changed = true;
      }
    }
    if (changed) limit_slope(decided, share);
  }
  return {};
}

Result<void, MotionFailure> lift_wheels(BaseRun& run, const WheelPlacer& placer,
                                        double clearance_m) {
  for (int wheel = 0; wheel < kNumWheels; ++wheel) {
    if ((run.support.lifted >> wheel & 1) == 0) continue;
    double needed_rad = -1e9;
    for (std::size_t i = 0; i < run.knots.size(); ++i) {
      const double next = run.knots[std::min(i + 1, run.knots.size() - 1)].sigma_m;
      for (const double sigma : {run.knots[i].sigma_m, 0.5 * (run.knots[i].sigma_m + next)}) {
        const BaseRun::Point point = run.at(sigma);
        const auto clear =
            placer.lowest_clear_rad(point.base, point.curvature_1_m, wheel, clearance_m);
        if (!clear) {
          return tl::unexpected<MotionFailure>(
              {run.knots[i].state, "wheel " +
                                       std::string(kLimbNames[static_cast<std::size_t>(wheel)]) +
                                       " cannot be lifted clear of the ground"});
        }
        needed_rad = std::max(needed_rad, *clear);
      }
    }
    run.lifted_hfe_rad[static_cast<std::size_t>(wheel)] = needed_rad;
  }
  return {};
}

}  // namespace wex
