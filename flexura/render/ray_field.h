#pragma once

#include <optional>
#include <vector>

#include "flexura/camera/intrinsics.h"
#include "flexura/render/ray.h"

namespace flexura {

[[nodiscard]] bool is_same(const Intrinsics& a, const Intrinsics& b);

/// Returns the ray of the image point (u, v) of a lens without distortion.
[[nodiscard]] Ray straight_ray(const Intrinsics& intrinsics, double u, double v);

/// Returns the ray of an image point; empty where the lens's distortion maps no ray to it.
[[nodiscard]] std::optional<Ray> ray_at(const Lens& lens, const Eigen::Vector2d& pixel);

/// The rays of all pixels of an image. Without distortion nothing is stored. With it, all rays are stored and
/// recomputed only when the lens or the size has changed.
class RayField {
 public:
  /// Throws std::invalid_argument for a size that is not positive or over 65536 px.
  void set(const Lens& lens, int width, int height);

  /// Returns the ray of a pixel; empty where the lens's distortion maps no ray to it.
  [[nodiscard]] std::optional<Ray> ray(int u, int v) const;
  /// Returns the largest step in (a, b) from one pixel to its neighbours.
  [[nodiscard]] double largest_step() const { return largest_step_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  std::optional<Intrinsics> intrinsics_;
  int width_ = 0, height_ = 0;
  double largest_step_ = 0;
  std::vector<Ray> rays_;  // Direction (0, 0, 0): no ray.
};

}  // namespace flexura
