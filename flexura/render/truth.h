#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/render/renderer.h"
#include "flexura/render/surface_label.h"

namespace flexura {

// True values of a picture, from its geometry and without sensor effects. Each function queries a renderer
// that is prepared for a scene and a view.

/// Returns a label as one number: 4096 times the kind's index in SurfaceKind, plus the index.
[[nodiscard]] std::uint16_t label_value(SurfaceLabel label);
/// Returns the label of such a number.
[[nodiscard]] SurfaceLabel label_from_value(std::uint16_t value);

/// True values in the middle of one pixel.
struct PixelTruth {
  SurfaceLabel label;
  double depth = std::numeric_limits<double>::infinity();  ///< Depth as in TruthMaps, m.
  double s = std::numeric_limits<double>::quiet_NaN();     ///< Arc length as in TruthMaps, m.
};
/// Throws std::out_of_range unless (u, v) is in the image.
[[nodiscard]] PixelTruth pixel_truth(const Renderer& renderer, int u, int v);

/// True values in the middle of each pixel.
struct TruthMaps {
  Image<float> depth;          ///< Depth along the optical axis, m; infinite where there is no surface.
  Image<std::uint16_t> label;  ///< label_value() of the surface.
  Image<float> s;              ///< Arc length from the base on the arm, m; NaN elsewhere.
};
/// Resizes `maps` to the renderer's view and fills them.
void truth_maps(const Renderer& renderer, TruthMaps& maps);

/// Returns the share of each pixel's square that shows surfaces of `kind`, 0 to 1; with an index, that
/// surface alone. One channel, of the view's size.
[[nodiscard]] Image<float> coverage(const Renderer& renderer, SurfaceKind kind,
                                    std::optional<std::uint16_t> index = std::nullopt);

/// A point of the arm's backbone in the image.
struct AxisPoint {
  double s = 0;                          ///< Arc length from the base, m.
  std::optional<Eigen::Vector2d> pixel;  ///< Empty: behind the camera, or outside the lens's field.
  double depth = 0;                      ///< Depth along the optical axis, m; negative behind the camera.
  /// Whether the camera sees the arm's surface there: the line from the camera to the point enters the arm
  /// once and meets nothing else before.
  bool is_visible = false;
};
/// Returns the points at these arc lengths, m, clamped to the arm. Empty without an arm.
[[nodiscard]] std::vector<AxisPoint> projected_axis(const Renderer& renderer, std::span<const double> s);

/// A marker ring in the image.
struct MarkerView {
  AxisPoint center;                   ///< The backbone at the middle of the ring.
  double area = 0;                    ///< Visible area in the image, px^2.
  Eigen::Vector2d centroid = {0, 0};  ///< Centroid of the visible area, px; undefined if the area is 0.
};
/// Returns one view for each of the scene's markers, in order.
[[nodiscard]] std::vector<MarkerView> marker_views(const Renderer& renderer);

/// Returns the optical flow in two channels (u, v), px: how the surface point in the middle of each pixel
/// moves in the image. The motion is from the prepared scene and view to the given ones. NaN for the
/// background and for points that leave the lens's field. Points of the arm keep their section, their share
/// of its length, and their position in the cross-section. Screens and the etalon move their points;
/// obstacles are fixed. Visibility in the other view does not matter. Throws std::invalid_argument for a
/// scene that check() refuses, with other numbers of tube arcs, disks or screens, or without the etalon.
[[nodiscard]] Image<float> optical_flow(const Renderer& renderer, const Scene& scene, const View& view);

}  // namespace flexura
