#pragma once

#include <Eigen/Geometry>

#include "flexura/report/motion.h"
#include "flexura/report/scene.h"
#include "flexura/report/svg.h"

namespace flexura {

/// The box with what stands beside it: the parts of the obstacles that are within a quarter of its diagonal.
/// Planes take no room. m, world axes.
[[nodiscard]] Eigen::AlignedBox3d with_obstacles(Eigen::AlignedBox3d box,
                                                 const std::vector<ObstacleConfig>& obstacles);

/// Draws the outlines of the run's obstacles in view `v` of the scene, cut off at the plot's border. A plane
/// is drawn where it is seen from the side; for an arm in a plane, where it cuts that plane.
void draw_obstacles(XmlWriter& svg, const PlotScene& scene, std::size_t v, const ReportMotion& motion);

}  // namespace flexura
