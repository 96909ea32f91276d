#include "flexura/render/lens_map.h"

#include <algorithm>
#include <limits>

namespace flexura {

bool LensMap::Box::touches(const ImageRegion& region) const {
  const Eigen::Vector2d &low = region.low(), &high = region.high();
  return static_cast<double>(high_u) >= low.x() && static_cast<double>(low_u) <= high.x() &&
         static_cast<double>(high_v) >= low.y() && static_cast<double>(low_v) <= high.y();
}

void LensMap::set(const RayField& rays, const Intrinsics& intrinsics) {
  const bool is_same_size = width_ == rays.width() && height_ == rays.height();
  if (is_same_size && is_same(intrinsics_, intrinsics)) return;
  intrinsics_ = intrinsics;
  width_ = rays.width(), height_ = rays.height();
  boxes_ = (width_ + box_size - 1) / box_size;
  row_boxes_.clear(), column_boxes_.clear();
  const auto count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  for (std::vector<float>& map : maps_) map.resize(intrinsics.is_distorted() ? count : 0);
  if (is_straight()) return;
  for (int v = 0; v < height_; ++v) fill_row(rays, v);
}

// Pixels without a ray become NaN, which no kernel draws.
void LensMap::fill_row(const RayField& rays, int v) {
  constexpr float most = std::numeric_limits<float>::infinity();
  constexpr Box empty{most, most, -most, -most};
  const auto join = [](Box& box, const Box& other) {
    box.low_u = std::min(box.low_u, other.low_u), box.high_u = std::max(box.high_u, other.high_u);
    box.low_v = std::min(box.low_v, other.low_v), box.high_v = std::max(box.high_v, other.high_v);
  };
  Box around = empty;
  for (int u = 0; u < width_; ++u) {
    const auto i =
        static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u);
    if (u % box_size == 0) column_boxes_.push_back(empty);
    const auto ray = rays.ray(u, v);
    if (!ray) {
      for (std::vector<float>& map : maps_) map[i] = std::numeric_limits<float>::quiet_NaN();
      continue;
    }
    const Eigen::Vector2d at(intrinsics_.fx * ray->direction.x() + intrinsics_.cx,
                             intrinsics_.fy * ray->direction.y() + intrinsics_.cy);
    const Eigen::Matrix2d& by = ray->by_pixel;
    const double values[6] = {at.x(),
                              at.y(),
                              intrinsics_.fx * by(0, 0),
                              intrinsics_.fx * by(0, 1),
                              intrinsics_.fy * by(1, 0),
                              intrinsics_.fy * by(1, 1)};
    for (std::size_t j = 0; j < 6; ++j) maps_[j][i] = static_cast<float>(values[j]);
    const float x = maps_[0][i], y = maps_[1][i];
    join(column_boxes_.back(), {x, y, x, y});
  }
  for (auto box = column_boxes_.end() - boxes_; box != column_boxes_.end(); ++box) join(around, *box);
  row_boxes_.push_back(around);
}

LensRow LensMap::row(int v) const {
  if (is_straight()) return {};
  const auto from = static_cast<std::size_t>(v) * static_cast<std::size_t>(width_);
  const auto at = [&](std::size_t map) { return maps_[map].data() + from; };
  return {at(0), at(1), at(2), at(3), at(4), at(5)};
}

void LensMap::place(int u, int v, std::size_t index, SpanPlaces& places) const {
  const std::size_t i =
      static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u);
  const auto value = [&](std::size_t map, float straight) {
    return is_straight() ? straight : maps_[map][i];
  };
  places.u[index] = value(0, static_cast<float>(u)), places.v[index] = value(1, static_cast<float>(v));
  places.u_by_u[index] = value(2, 1), places.u_by_v[index] = value(3, 0);
  places.v_by_u[index] = value(4, 0), places.v_by_v[index] = value(5, 1);
}

PixelRange LensMap::rows(const ImageRegion& region) const {
  if (is_straight()) return region.rows(height_);
  int begin = 0, end = height_;
  const auto touches = [&](int v) { return row_boxes_[static_cast<std::size_t>(v)].touches(region); };
  while (begin < end && !touches(begin)) ++begin;
  while (end > begin && !touches(end - 1)) --end;
  return {begin, end};
}

PixelRange LensMap::columns(const ImageRegion& region, int v) const {
  if (is_straight()) return region.columns(v, width_);
  const Box* const boxes = column_boxes_.data() + static_cast<std::ptrdiff_t>(v) * boxes_;
  int begin = 0, end = boxes_;
  while (begin < end && !boxes[begin].touches(region)) ++begin;
  while (end > begin && !boxes[end - 1].touches(region)) --end;
  return {begin * box_size, std::min(end * box_size, width_)};
}

}  // namespace flexura
