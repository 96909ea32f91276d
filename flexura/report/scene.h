#pragma once

#include <Eigen/Geometry>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/report/arm_curve.h"
#include "flexura/report/motion.h"

namespace flexura {

/// Plots of the views side by side. All axes have equal scales.
struct PlotScene {
  std::vector<PlotView> views;
  std::vector<PlotFrame> frames;  ///< Plots, one per view.
  double width = 0.0;   ///< Width of the whole picture with room for axes and a heading, page units.
  double height = 0.0;  ///< Height of the whole picture, page units.

  /// Returns true if there is enough room to draw marks at the section borders without overlap, for an arm of
  /// `length` m with this number of sections.
  [[nodiscard]] bool has_room_for_joints(double length, std::size_t sections) const {
    return scale() * length > 14.0 * static_cast<double>(sections);
  }
  /// Returns the scale, page units per metre.
  [[nodiscard]] double scale() const { return frames.front().scale().x(); }
};

/// Returns a scene that shows `box` (m, axes of W) with a margin. The scene has only the view XOY if
/// `one_view`, otherwise both views. The range that the scene shows is at least `least` m wide.
[[nodiscard]] PlotScene scene_of(const Eigen::AlignedBox3d& box, bool one_view, double least);

/// Extends a box (m, axes of W) by an arm's tube.
void extend_by_tube(Eigen::AlignedBox3d& box, const Backbone& backbone);
/// Returns the bounding box of the arm's tube over the whole motion, m, axes of W.
[[nodiscard]] Eigen::AlignedBox3d swept_box(const ReportMotion& motion);

/// Returns the box extended towards the missed targets, by at most half of its diagonal.
[[nodiscard]] Eigen::AlignedBox3d with_targets(Eigen::AlignedBox3d box, const ReportMotion& motion);

/// Draws the heading and the axes of every view.
void draw_scene_axes(XmlWriter& svg, const PlotScene& scene, std::string_view heading);

/// Draws a label beside the page point `at`, on the side with more room in the plot.
void label_beside(XmlWriter& svg, const PlotFrame& frame, const Eigen::Vector2d& at,
                  std::string_view content);

}  // namespace flexura
