#pragma once

#include <cstddef>
#include <vector>

#include "flexura/render/image_region.h"
#include "flexura/render/ray_field.h"
#include "flexura/render/span_kernels.h"

namespace flexura {

/// Maps each pixel to the undistorted position of its ray: the pixel at which a lens without distortion would
/// show the ray. For a lens without distortion, nothing is stored. For other lenses, the map is recomputed
/// only after a change of the lens or the image size.
class LensMap {
 public:
  void set(const RayField& rays, const Intrinsics& intrinsics);

  /// Returns the positions for row v. LensRow::u is null if the lens has no distortion.
  [[nodiscard]] LensRow row(int v) const;
  /// Sets entry `index` of `places` to the undistorted position of a pixel, with derivatives.
  void place(int u, int v, std::size_t index, SpanPlaces& places) const;

  /// Returns all rows in which the region may be visible.
  [[nodiscard]] PixelRange rows(const ImageRegion& region) const;
  /// Returns all columns of row v in which the region may be visible.
  [[nodiscard]] PixelRange columns(const ImageRegion& region, int v) const;

 private:
  // Bounds of the undistorted positions of some neighbouring pixels of a row.
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
