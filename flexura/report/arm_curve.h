#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/model/backbone.h"
#include "flexura/report/axes.h"

namespace flexura {

/// The two parallel views of the paper's cameras: X to the right and Y up (camera 1), Z to the right and Y up
/// (camera 2).
enum class PlotView : std::uint8_t { xoy, zoy };

/// A world point as a view sees it, m.
[[nodiscard]] Eigen::Vector2d seen(PlotView view, const Eigen::Vector3d& p_W);

/// Whether the arm bends in a plane parallel to XOY, so that the first view alone shows it in true shape.
[[nodiscard]] bool lies_in_xoy(const Arm& arm);

/// The page points of an arc in a view, moved aside (to the left of its way) by an offset that goes from
/// aside[0] to aside[1] (page units): within a tenth of a page unit for arcs that fit a page.
[[nodiscard]] std::vector<Eigen::Vector2d> arc_points(const Arc& arc, PlotView view, const PlotFrame& frame,
                                                      std::array<double, 2> aside = {});

/// The outline of a tube whose radius goes from radius[0] to radius[1] (page units) along the arc, as path
/// data.
[[nodiscard]] std::string tube_path(const Arc& arc, PlotView view, const PlotFrame& frame,
                                    std::array<double, 2> radius);

}  // namespace flexura
