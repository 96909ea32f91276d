#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/model/backbone.h"
#include "flexura/report/axes.h"

namespace flexura {

/// The two parallel projections of the paper's cameras. XOY has X to the right and Y up (camera 1); ZOY has Z
/// to the right and Y up (camera 2).
enum class PlotView : std::uint8_t { xoy, zoy };

/// Returns the coordinates of a point of W in a view, m.
[[nodiscard]] Eigen::Vector2d seen(PlotView view, const Eigen::Vector3d& p_W);

/// Returns true if the arm bends in a plane parallel to XOY. The first view of this arm shows its undistorted
/// shape.
[[nodiscard]] bool lies_in_xoy(const Arm& arm);

/// Returns the page points of an arc in a view. The points are displaced to the left of the arc's direction
/// by an offset that changes from aside[0] to aside[1] (page units). For arcs that fit a page, the points are
/// accurate to 0.1 page units.
[[nodiscard]] std::vector<Eigen::Vector2d> arc_points(const Arc& arc, PlotView view, const PlotFrame& frame,
                                                      std::array<double, 2> aside = {});

/// Returns the outline of a tube along the arc as path data. The tube's radius changes from radius[0] to
/// radius[1] (page units).
[[nodiscard]] std::string tube_path(const Arc& arc, PlotView view, const PlotFrame& frame,
                                    std::array<double, 2> radius);

}  // namespace flexura
