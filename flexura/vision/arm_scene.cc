#include "flexura/vision/arm_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "flexura/vision/arm_matte.h"
#include "flexura/vision/picture_file.h"

namespace flexura {
namespace {

using Eigen::Vector2d;

// Returns the pixels within a polygon, by the even-odd rule: 255 inside, 0 outside.
Image<std::uint8_t> filled_polygon(const std::vector<Vector2d>& corners, const PixelBox& box) {
  Image<std::uint8_t> inside(box.width(), box.height());
  std::vector<double> crossings;
  for (int v = 0; v < box.height(); ++v) {
    crossings.clear();
    const double row = v + box.top;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
      if ((a.y() <= row) == (b.y() <= row)) continue;
      crossings.push_back(a.x() + (row - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) - box.left);
    }
    std::ranges::sort(crossings);
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const int first = std::max(0, static_cast<int>(std::ceil(crossings[i])));
      const int last = std::min(box.width(), static_cast<int>(std::floor(crossings[i + 1])) + 1);
      for (int u = first; u < last; ++u) inside.at(u, v) = 255;
    }
  }
  return inside;
}

// Repeats in each row the nearest pixel inside, so that what is outside has no contrast of its own.
Image<std::uint8_t> filled_outside(const Image<std::uint8_t>& gray, const Image<std::uint8_t>& inside) {
  Image<std::uint8_t> filled = gray;
  for (int v = 0; v < gray.height(); ++v) {
    int before = -1;  // The last column inside.
    for (int u = 0; u < gray.width(); ++u) {
      if (inside.at(u, v) == 0) continue;
      for (int gap = before + 1; gap < u; ++gap) {
        const bool is_nearer = before >= 0 && gap - before < u - gap;
        filled.at(gap, v) = gray.at(is_nearer ? before : u, v);
      }
      before = u;
    }
    for (int u = before + 1; before >= 0 && u < gray.width(); ++u) filled.at(u, v) = gray.at(before, v);
    // A row without a pixel inside repeats the row above.
    if (before < 0 && v > 0) std::ranges::copy(filled.row(v - 1), filled.row(v).begin());
  }
  return filled;
}

PixelBox box_of(const std::vector<Vector2d>& corners, const Image<std::uint8_t>& picture) {
  PixelBox box{0, 0, picture.width(), picture.height()};
  if (corners.empty()) return box;
  Vector2d least = corners.front(), most = corners.front();
  for (const Vector2d& corner : corners) least = least.cwiseMin(corner), most = most.cwiseMax(corner);
  const auto pixel = [](double x, int size) {
    return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(size)));
  };
  box.left = pixel(std::ceil(least.x()), picture.width());
  box.top = pixel(std::ceil(least.y()), picture.height());
  box.right = pixel(std::floor(most.x()) + 1, picture.width());
  box.bottom = pixel(std::floor(most.y()) + 1, picture.height());
  return box;
}

bool is_all_inside(const Image<std::uint8_t>& inside) {
  return std::ranges::none_of(inside.values(), [](std::uint8_t value) { return value == 0; });
}

}  // namespace

ScenePart part_in_scene(const ArmScene& scene, const Image<std::uint8_t>& picture) {
  ScenePart part;
  part.box = box_of(scene.region, picture);
  constexpr int least_side = 8;
  if (part.box.width() < least_side || part.box.height() < least_side) {
    part.reason = fmt::format("the region has fewer than {} rows or columns in the picture", least_side);
    return part;
  }
  for (const auto* image : {&scene.background, &scene.mask}) {
    if (image->values().empty() || (image->width() == picture.width() && image->height() == picture.height()))
      continue;
    part.reason = fmt::format("the {} has {} x {} px, but the picture has {} x {} px",
                              image == &scene.mask ? "mask" : "picture of the background", image->width(),
                              image->height(), picture.width(), picture.height());
    return part;
  }
  if (!scene.region.empty()) {
    part.inside = filled_polygon(scene.region, part.box);
    if (is_all_inside(part.inside)) part.inside = {};
  }
  if (scene.has_cues()) {
    make_matte(scene, picture, part);
    return part;
  }
  cut_out(gray_picture(picture), part.box, part.gray);
  part.filled = part.inside.values().empty() ? part.gray : filled_outside(part.gray, part.inside);
  return part;
}

}  // namespace flexura
