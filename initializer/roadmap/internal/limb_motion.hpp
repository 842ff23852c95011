#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "models/excavator/machine_model.hpp"

namespace wex {

/// Coordinates a limb's roadmap is over: a leg's joints but the wheel's, all of the arm's.
[[nodiscard]] std::vector<int> limb_coordinates(const MachineModel& machine, Limb limb);

/// Configurations of some joints: what lies between two, and how far they are apart. A continuous
/// joint goes the shorter way round.
class LimbMotion {
 public:
  LimbMotion(const MachineModel& machine, std::vector<int> coordinates);

  [[nodiscard]] Eigen::Index size() const noexcept {
    return static_cast<Eigen::Index>(coordinates_.size());
  }
  [[nodiscard]] const std::vector<int>& coordinates() const noexcept { return coordinates_; }
  [[nodiscard]] const Joint& joint(Eigen::Index i) const noexcept {
    return machine_->joints[coordinates_[i] - kNumBaseCoordinates];
  }
  /// Of a continuous joint one turn, around zero.
  [[nodiscard]] std::pair<double, double> limits(Eigen::Index i) const noexcept;

  [[nodiscard]] Eigen::VectorXd read(const Eigen::VectorXd& q) const;
  void write(const Eigen::Ref<const Eigen::VectorXd>& configuration, Eigen::VectorXd& q) const;

  /// What to add to `from` to be where `to` is.
  void step(const Eigen::Ref<const Eigen::VectorXd>& from,
            const Eigen::Ref<const Eigen::VectorXd>& to, Eigen::VectorXd& step) const noexcept;
  /// Root of summed squares of the joints' shortest times.
  [[nodiscard]] double distance_s(const Eigen::Ref<const Eigen::VectorXd>& from,
                                  const Eigen::Ref<const Eigen::VectorXd>& to) const noexcept;

  /// Whether `valid` holds strictly between two configurations, looked at no farther apart than
  /// `max_step` in any joint; the middle first, where the ends say least.
  template <typename Valid>
  [[nodiscard]] bool holds_between(const Eigen::Ref<const Eigen::VectorXd>& from,
                                   const Eigen::Ref<const Eigen::VectorXd>& to, double max_step,
                                   const Valid& valid) const;

 private:
  const MachineModel* machine_;
  std::vector<int> coordinates_;
  std::vector<bool> continuous_;
  Eigen::VectorXd seconds_per_unit_;
};

template <typename Valid>
bool LimbMotion::holds_between(const Eigen::Ref<const Eigen::VectorXd>& from,
                               const Eigen::Ref<const Eigen::VectorXd>& to, double max_step,
                               const Valid& valid) const {
  Eigen::VectorXd whole(size()), between(size());
  step(from, to, whole);
  int pieces = 1;  // the next power of two, so that halving meets every point once
  while (whole.lpNorm<Eigen::Infinity>() > max_step * pieces) pieces *= 2;
  for (int stride = pieces; stride > 1; stride /= 2) {
    for (int k = stride / 2; k < pieces; k += stride) {
      between = from + whole * (static_cast<double>(k) / pieces);
      if (!valid(between)) return false;
    }
  }
  return true;
}

}  // namespace wex
