#pragma once

#include <Eigen/Geometry>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/report/arm_curve.h"
#include "flexura/report/motion.h"

namespace flexura {

/// One plot per view, side by side, all at one scale along both axes.
struct PlotScene {
  std::vector<PlotView> views;
  std::vector<PlotFrame> frames;  ///< One per view.
  double width = 0.0;   ///< Width of the whole picture with room for axes and a heading, page units.
  double height = 0.0;  ///< Page units.

  /// Returns true if marks at the section borders do not overlap, for an arm of `sections` and `length` m.
  [[nodiscard]] bool has_room_for_joints(double length, std::size_t sections) const {
    return scale() * length > 14.0 * static_cast<double>(sections);
  }
  /// Returns page units per metre.
  [[nodiscard]] double scale() const { return frames.front().scale().x(); }
};

/// Returns a scene that shows `box` (m, world axes) with a border, in XOY only or in both views. The shown
/// range is at least `least` m wide.
[[nodiscard]] PlotScene scene_of(const Eigen::AlignedBox3d& box, bool one_view, double least);

/// Extends a box by an arm's tube, m.
void extend_by_tube(Eigen::AlignedBox3d& box, const Backbone& backbone);
/// Returns the volume swept by the arm's tube during the motion, m.
[[nodiscard]] Eigen::AlignedBox3d swept_box(const ReportMotion& motion);

/// Returns the box extended by the missed targets: all within half of its diagonal, and as far towards
/// others.
[[nodiscard]] Eigen::AlignedBox3d with_targets(Eigen::AlignedBox3d box, const ReportMotion& motion);

/// Draws the heading and the axes of every view.
void draw_scene_axes(XmlWriter& svg, const PlotScene& scene, std::string_view heading);

/// Draws a label beside the page point `at`, on the side with more room in the plot.
void label_beside(XmlWriter& svg, const PlotFrame& frame, const Eigen::Vector2d& at,
                  std::string_view content);

}  // namespace flexura
