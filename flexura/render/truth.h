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

// True values of a picture, computed from geometry, without sensor effects. Each function queries a renderer
// that is prepared for a scene and a view (Renderer::prepare).

/// Returns a label as one number: 4096 times the value of the SurfaceKind, plus the index.
[[nodiscard]] std::uint16_t label_value(SurfaceLabel label);
/// Returns the label for a number from label_value().
[[nodiscard]] SurfaceLabel label_from_value(std::uint16_t value);

/// True values in the middle of one pixel.
struct PixelTruth {
  SurfaceLabel label;
  /// Depth along the optical axis, m; infinite without a surface.
  double depth = std::numeric_limits<double>::infinity();
  /// Arc length from the base on the arm, m; NaN on other surfaces.
  double s = std::numeric_limits<double>::quiet_NaN();
};
/// Returns the true values of pixel (u, v). Throws std::out_of_range unless (u, v) is in the image.
[[nodiscard]] PixelTruth pixel_truth(const Renderer& renderer, int u, int v);

/// True values in the middle of each pixel.
struct TruthMaps {
  Image<float> depth;          ///< Depth along the optical axis, m; infinite without a surface.
  Image<std::uint16_t> label;  ///< Label of the surface (label_value()).
  Image<float> s;              ///< Arc length from the base on the arm, m; NaN on other surfaces.
};
/// Computes `maps`, resized to the view's image.
void truth_maps(const Renderer& renderer, TruthMaps& maps);

/// Returns the fraction of each pixel's square that shows surfaces of `kind`, from 0 to 1. If an index is
/// given, only the surface with this index counts. The image has one channel and the view's size.
[[nodiscard]] Image<float> coverage(const Renderer& renderer, SurfaceKind kind,
                                    std::optional<std::uint16_t> index = std::nullopt);

/// A point of the arm's backbone, projected into the image.
struct AxisPoint {
  double s = 0;  ///< Arc length from the base, m.
  std::optional<Eigen::Vector2d>
      /// Pixel (u, v), px; missing if the point is behind the camera or outside the lens's field of view.
      pixel;
  double depth = 0;  ///< Depth along the optical axis, m; negative behind the camera.
  /// Whether the camera sees the arm's surface in front of the point. In this case, the line from camera to
  /// point enters the arm exactly once, and hits nothing else before.
  bool is_visible = false;
};
/// Returns the backbone points at arc lengths `s`, m, clamped to the arm. The result is empty without an arm.
[[nodiscard]] std::vector<AxisPoint> projected_axis(const Renderer& renderer, std::span<const double> s);

/// A marker ring as seen in the image.
struct MarkerView {
  AxisPoint center;                   ///< Backbone point at the middle of the ring.
  double area = 0;                    ///< Visible area in the image, px^2.
  Eigen::Vector2d centroid = {0, 0};  ///< Centroid of the visible area, px; undefined if the area is 0.
};
/// Returns the views of all markers of the scene, in the scene's order.
[[nodiscard]] std::vector<MarkerView> marker_views(const Renderer& renderer);

/// Returns the optical flow in two channels (u, v), px: the image motion of the surface point in the middle
/// of each pixel. The motion is from the prepared scene and view to the given scene and view. The motion is
/// NaN for the background, and for points that leave the lens's field of view. Points of the arm keep their
/// section, their fraction of the section's length, and their position in the cross-section. Points of
/// screens and of the calibration cylinder move with these bodies. Obstacles are fixed. Points need not be
/// visible in the second view. Throws std::invalid_argument for a scene that check() rejects. Also throws
/// std::invalid_argument if the numbers of tube arcs, disks or screens of the two scenes differ, and if only
/// one of the scenes has the cylinder.
[[nodiscard]] Image<float> optical_flow(const Renderer& renderer, const Scene& scene, const View& view);

}  // namespace flexura
