#pragma once

#include <Eigen/Geometry>

#include "flexura/report/motion.h"
#include "flexura/report/scene.h"
#include "flexura/report/svg.h"

namespace flexura {

/// Returns the box extended by the obstacles near it: their parts within a quarter of its diagonal. Planes do
/// not extend it. m, world axes.
[[nodiscard]] Eigen::AlignedBox3d with_obstacles(Eigen::AlignedBox3d box,
                                                 const std::vector<ObstacleConfig>& obstacles);

/// Draws the outlines of the run's obstacles in view `v` of the scene, clipped at the plot's border. A plane
/// is drawn if it is seen edge-on; for an arm in a plane, where it cuts that plane.
void draw_obstacles(XmlWriter& svg, const PlotScene& scene, std::size_t v, const ReportMotion& motion);

}  // namespace flexura
