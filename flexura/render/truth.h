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

// What is true of a picture, from the geometry that draws it and free of sensor effects. Each function asks a
// renderer that is prepared for a scene and a view.

/// A label as one number: 4096 times the kind's place in SurfaceKind, plus the index.
[[nodiscard]] std::uint16_t label_value(SurfaceLabel label);
/// The label that is this number.
[[nodiscard]] SurfaceLabel label_from_value(std::uint16_t value);

/// What is seen in the middle of one pixel.
struct PixelTruth {
  SurfaceLabel label;
  double depth = std::numeric_limits<double>::infinity();  ///< As in TruthMaps, m.
  double s = std::numeric_limits<double>::quiet_NaN();     ///< m.
};
/// (u, v) must be in the image, else std::out_of_range.
[[nodiscard]] PixelTruth pixel_truth(const Renderer& renderer, int u, int v);

/// What is seen in the middle of each pixel.
struct TruthMaps {
  Image<float> depth;          ///< Along the optical axis, m; infinite where nothing is.
  Image<std::uint16_t> label;  ///< label_value().
  Image<float> s;              ///< On the arm, arc length from its base, m; no number elsewhere.
};
/// Makes `maps` to fit the renderer's view and fills them.
void truth_maps(const Renderer& renderer, TruthMaps& maps);

/// The share of each pixel's square that shows surfaces of `kind`, 0 to 1; with an index, those alone. One
/// channel, of the view's size.
[[nodiscard]] Image<float> coverage(const Renderer& renderer, SurfaceKind kind,
                                    std::optional<std::uint16_t> index = std::nullopt);

/// A point of the arm's backbone in the image.
struct AxisPoint {
  double s = 0;                          ///< m.
  std::optional<Eigen::Vector2d> pixel;  ///< None: behind the camera, or outside the lens's field.
  double depth = 0;                      ///< Along the optical axis, m; negative behind the camera.
  /// Whether the arm's surface there is what the camera sees: the way from the camera to the point enters the
  /// arm once and meets nothing else before.
  bool is_visible = false;
};
/// At the arc lengths, m, which are kept within the arm. Without an arm: none.
[[nodiscard]] std::vector<AxisPoint> projected_axis(const Renderer& renderer, std::span<const double> s);

/// A marker ring in the image.
struct MarkerView {
  AxisPoint center;                   ///< Of the backbone, in the ring's middle.
  double area = 0;                    ///< Seen of it in the image, px^2.
  Eigen::Vector2d centroid = {0, 0};  ///< Of what is seen, px; meaningless when the area is 0.
};
/// One for each of the scene's markers, in their order.
[[nodiscard]] std::vector<MarkerView> marker_views(const Renderer& renderer);

/// Two channels (u, v): how far what is seen in the middle of each pixel moves in the image, px, from the
/// prepared scene and view to another; no number for the background and what leaves the lens's field. Points
/// of the arm keep their section, their share of its length, and their place in the cross-section; screens
/// and the etalon carry their points along; obstacles stand still. Hidden or not does not matter.
/// std::invalid_argument: a scene that check() refuses, or with other numbers of tube arcs, disks or screens,
/// or without the etalon.
[[nodiscard]] Image<float> optical_flow(const Renderer& renderer, const Scene& scene, const View& view);

}  // namespace flexura
