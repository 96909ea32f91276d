#include "flexura/render/ray_field.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>

namespace flexura {

bool is_same(const Intrinsics& a, const Intrinsics& b) {
  return a.fx == b.fx && a.fy == b.fy && a.cx == b.cx && a.cy == b.cy && a.distortion == b.distortion;
}

Ray straight_ray(const Intrinsics& intrinsics, double u, double v) {
  Ray ray;
  ray.direction << (u - intrinsics.cx) / intrinsics.fx, (v - intrinsics.cy) / intrinsics.fy, 1;
  ray.by_pixel << 1 / intrinsics.fx, 0, 0, 1 / intrinsics.fy;
  return ray;
}

std::optional<Ray> ray_at(const Lens& lens, const Eigen::Vector2d& pixel) {
  if (!lens.intrinsics().is_distorted()) return straight_ray(lens.intrinsics(), pixel.x(), pixel.y());
  const auto normal = lens.unproject(pixel);
  if (!normal) return std::nullopt;
  Ray ray;
  ray.direction << *normal, 1;
  const auto projection = lens.project_with_derivatives(ray.direction);
  if (!projection) return std::nullopt;
  const Eigen::Matrix2d by_normal = projection->by_point.leftCols<2>();
  ray.by_pixel = by_normal.inverse();
  if (!ray.by_pixel.allFinite()) return std::nullopt;
  return ray;
}

void RayField::set(const Lens& lens, int width, int height) {
  constexpr int largest = 65536;
  if (width < 1 || height < 1 || width > largest || height > largest)
    throw std::invalid_argument(fmt::format("an image of {} x {} pixels cannot be rendered", width, height));
  const Intrinsics& intrinsics = lens.intrinsics();
  const bool is_known =
      intrinsics_ && is_same(*intrinsics_, intrinsics) && width_ == width && height_ == height;
  if (is_known) return;
  intrinsics_ = intrinsics;
  width_ = width, height_ = height;
  rays_.clear();
  largest_step_ = std::max(1 / intrinsics.fx, 1 / intrinsics.fy);
  if (!intrinsics.is_distorted()) return;
  const double largest_undistorted = largest_step_;
  rays_.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const auto ray = ray_at(lens, {u, v});
      rays_.push_back(ray.value_or(Ray{Eigen::Vector3d::Zero(), Eigen::Matrix2d::Zero()}));
      // Where the lens folds the image over itself, the step has no bound.
      const double step = rays_.back().by_pixel.colwise().norm().maxCoeff();
      largest_step_ = std::max(largest_step_, std::min(step, 10 * largest_undistorted));
    }
  }
}

std::optional<Ray> RayField::ray(int u, int v) const {
  if (rays_.empty()) return straight_ray(*intrinsics_, u, v);
  const Ray& ray =
      rays_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u)];
  if (ray.direction.z() == 0) return std::nullopt;
  return ray;
}

}  // namespace flexura
