#pragma once

#include <Eigen/Geometry>

#include "flexura/report/motion.h"
#include "flexura/report/scene.h"
#include "flexura/report/svg.h"

namespace flexura {

/// Returns the box (m, axes of W) extended by the parts of obstacles within a quarter of the box's diagonal.
/// Planes do not extend the box.
[[nodiscard]] Eigen::AlignedBox3d with_obstacles(Eigen::AlignedBox3d box,
                                                 const std::vector<ObstacleConfig>& obstacles);

/// Draws the outlines of the run's obstacles in view `v` of the scene, clipped at the plot's border. A plane
/// obstacle is drawn if it is perpendicular to the view. For an arm in a plane, the intersection of the
/// obstacle with the arm's plane is drawn.
void draw_obstacles(XmlWriter& svg, const PlotScene& scene, std::size_t v, const ReportMotion& motion);

}  // namespace flexura
