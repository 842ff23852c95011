#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

#include "models/types/result.hpp"

namespace wex {

/// Draws a MuJoCo scene into a PNG without a display: EGL without surface, or OSMesa where there is
/// no EGL. The graphics libraries are opened at run time, so nothing links to them. One thread.
class OffscreenRenderer {
 public:
  /// errors  kInternal: no usable graphics library (says which were tried)
  [[nodiscard]] static Result<std::unique_ptr<OffscreenRenderer>> create(const mjModel* model);
  ~OffscreenRenderer();

  /// errors  kBadInput: the file cannot be written
  [[nodiscard]] Result<void> draw(const mjModel* model, mjData* data, const mjvCamera& camera,
                                  const std::string& png_file, int width_px, int height_px);

 private:
  struct Impl;
  explicit OffscreenRenderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace wex
