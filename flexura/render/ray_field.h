#pragma once

#include <optional>
#include <vector>

#include "flexura/camera/intrinsics.h"
#include "flexura/render/ray.h"

namespace flexura {

[[nodiscard]] bool is_same(const Intrinsics& a, const Intrinsics& b);

/// Returns the ray of the image point (u, v) of a lens without distortion.
[[nodiscard]] Ray straight_ray(const Intrinsics& intrinsics, double u, double v);

/// Returns the ray of an image point; std::nullopt if the lens's distortion maps no ray to this point.
[[nodiscard]] std::optional<Ray> ray_at(const Lens& lens, const Eigen::Vector2d& pixel);

/// The rays of all pixels of an image. For a lens without distortion, a RayField stores nothing. For other
/// lenses, a RayField stores all rays, and recomputes the rays only after a change of the lens or the image
/// size.
class RayField {
 public:
  /// Sets lens and image size. Throws std::invalid_argument for a size that is not positive or above 65536
  /// px.
  void set(const Lens& lens, int width, int height);

  /// Returns the ray of a pixel; std::nullopt if the lens's distortion maps no ray to this pixel.
  [[nodiscard]] std::optional<Ray> ray(int u, int v) const;
  /// Returns the largest distance in (a, b) between the rays of neighbouring pixels.
  [[nodiscard]] double largest_step() const { return largest_step_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  std::optional<Intrinsics> intrinsics_;
  int width_ = 0, height_ = 0;
  double largest_step_ = 0;
  std::vector<Ray> rays_;  // Rays of all pixels; direction (0, 0, 0) means no ray.
};

}  // namespace flexura
