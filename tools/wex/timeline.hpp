#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "models/types/contact_schedule.hpp"
#include "tools/wex/canvas.hpp"

namespace wex::app {

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

/// Contacts per limb and panels stacked over one time axis.
class Timeline {
 public:
  /// A stretch of time of its own tint at the end, such as the hold after a drive.
  struct Tail {
    double from_s = 0.0;
    std::string name;
  };

  ///   num_limbs  shown, in Limb order: four wheels, or the arm too
  Timeline(double end_s, int num_limbs, int num_panels, std::optional<Tail> tail = {});

  void title(const std::string& text);
  ///   meaning  of a bar, for the legend
  void contacts(const ContactSchedule& schedule, const std::string& meaning);
  void panel(const Panel& panel);
  void time_axis(const std::string& title);
  [[nodiscard]] Result<void> write(const std::filesystem::path& file) const;

 private:
  using ToPixel = std::function<double(double)>;

  [[nodiscard]] double x(double t_s) const;
  void time_grid(const Box& box);
  void vertical_title(const std::string& text, double top, double height);
  void legend(double& y, const std::string& name, const Stroke& stroke);
  void draw(const Curve& curve, const ToPixel& y);

  double end_s_;
  int num_limbs_;
  std::optional<Tail> tail_;
  Canvas canvas_;
  double y_;
};

}  // namespace wex::app
