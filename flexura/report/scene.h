#pragma once

#include <Eigen/Geometry>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/report/arm_curve.h"
#include "flexura/report/motion.h"

namespace flexura {

/// One plot a view, side by side, all at one scale and equal along both axes.
struct PlotScene {
  std::vector<PlotView> views;
  std::vector<PlotFrame> frames;  ///< One a view.
  double width = 0.0;             ///< Of the whole picture with room for axes and a heading, page units.
  double height = 0.0;            ///< Page units.

  /// Whether marks at the section borders keep apart, for an arm of `sections` and `length` m.
  [[nodiscard]] bool has_room_for_joints(double length, std::size_t sections) const {
    return scale() * length > 14.0 * static_cast<double>(sections);
  }
  /// Page units per metre.
  [[nodiscard]] double scale() const { return frames.front().scale().x(); }
};

/// A scene that shows `box` (m, world axes) with a border, in XOY alone or in both views.
/// Nothing shown is made smaller than `least` m across.
[[nodiscard]] PlotScene scene_of(const Eigen::AlignedBox3d& box, bool one_view, double least);

/// What the arm's tube sweeps over during the motion, m.
[[nodiscard]] Eigen::AlignedBox3d swept_box(const ReportMotion& motion);

/// The box with the targets that the motion misses: all that are within half of its diagonal, and as far
/// towards others.
[[nodiscard]] Eigen::AlignedBox3d with_targets(Eigen::AlignedBox3d box, const ReportMotion& motion);

/// Draws the heading and the axes of every view.
void draw_scene_axes(XmlWriter& svg, const PlotScene& scene, std::string_view heading);

/// Places one-line labels beside points so that they stay in the plot and keep off what is drawn.
class LabelPlacer {
 public:
  explicit LabelPlacer(PlotFrame frame) : frame_(std::move(frame)) {}
  /// Labels keep off this page point, the more the greater its weight.
  void avoid(const Eigen::Vector2d& point, double weight) { taken_.push_back({point, weight}); }
  /// Writes the label beside the page point `at`.
  void place(XmlWriter& svg, const Eigen::Vector2d& at, std::string_view content);

 private:
  struct Taken {
    Eigen::Vector2d point;
    double weight;
  };

  [[nodiscard]] double cost(const Eigen::AlignedBox2d& box) const;

  PlotFrame frame_;
  std::vector<Taken> taken_;
};

}  // namespace flexura
