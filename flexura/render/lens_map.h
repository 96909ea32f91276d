#pragma once

#include <cstddef>
#include <vector>

#include "flexura/render/image_region.h"
#include "flexura/render/ray_field.h"
#include "flexura/render/span_kernels.h"

namespace flexura {

/// Positions of all pixels' rays in the image of the lens without distortion. Without distortion nothing is
/// stored. With it, the map is recomputed only when the lens or the size has changed.
class LensMap {
 public:
  void set(const RayField& rays, const Intrinsics& intrinsics);

  /// `u` is null if the lens has no distortion.
  [[nodiscard]] LensRow row(int v) const;
  /// Sets the undistorted position of a pixel.
  void place(int u, int v, std::size_t index, SpanPlaces& places) const;

  /// Return the rows, and the columns of a row, in which the region is visible. Never too few.
  [[nodiscard]] PixelRange rows(const ImageRegion& region) const;
  [[nodiscard]] PixelRange columns(const ImageRegion& region, int v) const;

 private:
  // Bounds of the positions of some neighbouring pixels of a row.
  struct Box {
    float low_u, low_v, high_u, high_v;
    [[nodiscard]] bool touches(const ImageRegion& region) const;
  };
  static constexpr int box_size = 32;

  [[nodiscard]] bool is_straight() const { return maps_[0].empty(); }
  void fill_row(const RayField& rays, int v);

  Intrinsics intrinsics_;
  int width_ = 0, height_ = 0, boxes_ = 0;
  std::vector<float> maps_[6];  // u, v, u_by_u, u_by_v, v_by_u, v_by_v
  std::vector<Box> row_boxes_, column_boxes_;
};

}  // namespace flexura
