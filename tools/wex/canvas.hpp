#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "models/types/result.hpp"

namespace wex::app {

/// Colour, components 0 to 1.
struct Color {
  double red = 0.0, green = 0.0, blue = 0.0, alpha = 1.0;
};

enum class Align { kLeft, kCentre, kRight };

struct Stroke {
  Color color{};
  double width_px = 1.0;
  double dash_px = 0.0;  ///< 0: solid
};

/// A rectangle in pixels, y down.
struct Box {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
};

/// A picture in memory, pixels from the upper left corner; thin layer over cairo.
class Canvas {
 public:
  Canvas(int width_px, int height_px);
  ~Canvas();
  Canvas(Canvas&&) noexcept;
  Canvas& operator=(Canvas&&) noexcept;

  void fill(const Box& box, const Color& color);
  void outline(const Box& box, const Stroke& stroke);
  void line(const std::vector<Eigen::Vector2d>& points, const Stroke& stroke);
  void polygon(const std::vector<Eigen::Vector2d>& points, const Color& color);
  /// Text whose baseline begins, is centred or ends at the point; turned counter-clockwise.
  void text(const Eigen::Vector2d& at, const std::string& text, double size_px,
            Align align = Align::kLeft, const Color& color = {}, double turn_rad = 0.0,
            bool bold = false);
  /// Opaque image of 0xRRGGBB pixels, rows from the top, smoothly scaled into the box.
  void image(const Box& box, const std::vector<std::uint32_t>& pixels, int width, int height);
  /// Restricts drawing to a box until unclip().
  void clip(const Box& box);
  void unclip();

  /// errors  kBadInput naming the file and cairo's reason
  [[nodiscard]] Result<void> write_png(const std::filesystem::path& file) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Round tick positions covering [lo, hi], about `count` of them (a step of 1, 2 or 5 x 10^n).
[[nodiscard]] std::vector<double> ticks(double lo, double hi, int count);
/// A tick's label without needless decimals.
[[nodiscard]] std::string tick_label(double value, double step);

}  // namespace wex::app
