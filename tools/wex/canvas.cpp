#include "tools/wex/canvas.hpp"

#include <cairo.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>

namespace wex::app {

struct Canvas::Impl {
  cairo_surface_t* surface = nullptr;
  cairo_t* context = nullptr;

  Impl(int width_px, int height_px)
      : surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_px, height_px)),
        context(cairo_create(surface)) {
    cairo_set_source_rgb(context, 1.0, 1.0, 1.0);
    cairo_paint(context);
    cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(context, CAIRO_LINE_CAP_BUTT);
  }
  ~Impl() {
    cairo_destroy(context);
    cairo_surface_destroy(surface);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void source(const Color& c) const {
    cairo_set_source_rgba(context, c.red, c.green, c.blue, c.alpha);
  }
  void path(const std::vector<Eigen::Vector2d>& points) const {
    cairo_new_path(context);
    for (const Eigen::Vector2d& p : points) cairo_line_to(context, p.x(), p.y());
  }
  void apply(const Stroke& stroke) const {
    source(stroke.color);
    cairo_set_line_width(context, stroke.width_px);
    cairo_set_dash(context, &stroke.dash_px, stroke.dash_px > 0.0 ? 1 : 0, 0.0);
    cairo_stroke(context);
  }
};

Canvas::Canvas(int width_px, int height_px) : impl_(std::make_unique<Impl>(width_px, height_px)) {}
Canvas::~Canvas() = default;
Canvas::Canvas(Canvas&&) noexcept = default;
Canvas& Canvas::operator=(Canvas&&) noexcept = default;

void Canvas::fill(const Box& box, const Color& color) {
  impl_->source(color);
  cairo_rectangle(impl_->context, box.x, box.y, box.width, box.height);
  cairo_fill(impl_->context);
}

void Canvas::outline(const Box& box, const Stroke& stroke) {
  cairo_rectangle(impl_->context, box.x, box.y, box.width, box.height);
  impl_->apply(stroke);
}

void Canvas::line(const std::vector<Eigen::Vector2d>& points, const Stroke& stroke) {
  impl_->path(points);
  impl_->apply(stroke);
}

void Canvas::polygon(const std::vector<Eigen::Vector2d>& points, const Color& color) {
  impl_->path(points);
  impl_->source(color);
  cairo_close_path(impl_->context);
  cairo_fill(impl_->context);
}

void Canvas::text(const Eigen::Vector2d& at, const std::string& text, double size_px, Align align,
                  const Color& color, double turn_rad, bool bold) {
  cairo_t* context = impl_->context;
  cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, size_px);
  cairo_text_extents_t extents;
  cairo_text_extents(context, text.c_str(), &extents);
  const double shift = align == Align::kLeft     ? 0.0
                       : align == Align::kCentre ? -0.5 * extents.x_advance
                                                 : -extents.x_advance;
  cairo_save(context);
  cairo_translate(context, at.x(), at.y());
  cairo_rotate(context, -turn_rad);
  cairo_move_to(context, shift, 0.0);
  impl_->source(color);
  cairo_show_text(context, text.c_str());
  cairo_restore(context);
}

void Canvas::image(const Box& box, const std::vector<std::uint32_t>& pixels, int width,
                   int height) {
  WEX_EXPECTS(pixels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  cairo_surface_t* picture = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
  cairo_surface_flush(picture);
  unsigned char* data = cairo_image_surface_get_data(picture);
  const int stride = cairo_image_surface_get_stride(picture);
  for (int row = 0; row < height; ++row) {
    std::memcpy(data + static_cast<std::ptrdiff_t>(row) * stride,
                pixels.data() + static_cast<std::ptrdiff_t>(row) * width,
                sizeof(std::uint32_t) * static_cast<std::size_t>(width));
  }
  cairo_surface_mark_dirty(picture);
  cairo_t* context = impl_->context;
  cairo_save(context);
  cairo_rectangle(context, box.x, box.y, box.width, box.height);
  cairo_clip(context);
  cairo_translate(context, box.x, box.y);
  cairo_scale(context, box.width / width, box.height / height);
  cairo_set_source_surface(context, picture, 0.0, 0.0);
  cairo_pattern_set_filter(cairo_get_source(context), CAIRO_FILTER_GOOD);
  cairo_pattern_set_extend(cairo_get_source(context), CAIRO_EXTEND_PAD);
  cairo_paint(context);
  cairo_restore(context);
  cairo_surface_destroy(picture);
}

void Canvas::clip(const Box& box) {
  cairo_save(impl_->context);
  cairo_rectangle(impl_->context, box.x, box.y, box.width, box.height);
  cairo_clip(impl_->context);
}

void Canvas::unclip() { cairo_restore(impl_->context); }

Result<void> Canvas::write_png(const std::filesystem::path& file) const {
  const cairo_status_t status = cairo_surface_write_to_png(impl_->surface, file.c_str());
  if (status == CAIRO_STATUS_SUCCESS) return {};
  return fail(ErrorCode::kBadInput,
              "cannot write " + file.string() + ": " + cairo_status_to_string(status));
}

std::vector<double> ticks(double lo, double hi, int count) {
  WEX_EXPECTS(hi > lo && count > 0);
  const double raw = (hi - lo) / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double lead = raw / power;
  const double step = power * (lead <= 1.0 ? 1.0 : lead <= 2.0 ? 2.0 : lead <= 5.0 ? 5.0 : 10.0);
  std::vector<double> values;
  constexpr double kEdge = 1e-9;
  for (double i = std::ceil(lo / step - kEdge); i * step <= hi + kEdge * step; i += 1.0) {
    values.push_back(i * step);
  }
  return values;
}

std::string tick_label(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  char text[32];
  std::snprintf(text, sizeof(text), "%.*f", decimals, std::abs(value) < 1e-12 ? 0.0 : value);
  return text;
}

}  // namespace wex::app
