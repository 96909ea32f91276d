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

/// A piece of a circle in the XOY plane, shorter than a quarter turn.
struct CirclePiece {
  Eigen::Vector2d from;  ///< m
  Eigen::Vector2d to;    ///< m
  double radius = 0.0;   ///< m; infinite for a straight piece.
  double angle = 0.0;    ///< Turn from start to end, rad, counter-clockwise; 0 for a straight piece.
};

/// An arc that lies in a plane parallel to XOY, cut into equal pieces; each starts where the one before ends.
[[nodiscard]] std::vector<CirclePiece> circle_pieces(const Arc& arc);

/// A cubic Bezier's four control points.
using Bezier = std::array<Eigen::Vector2d, 4>;

/// An arc in a view as Beziers of at most an eighth turn with exact ends and end tangents: within 5e-6 of the
/// radius.
[[nodiscard]] std::vector<Bezier> bezier_pieces(const Arc& arc, PlotView view);

/// SVG path data of the arc on the page: circular arcs ("A") where `in_plane`, or else Beziers ("C").
[[nodiscard]] std::string arc_path(const Arc& arc, PlotView view, const PlotFrame& frame, bool in_plane);

/// The outline of a tube whose radius goes from radius[0] to radius[1] (page units) along the arc, as path
/// data.
[[nodiscard]] std::string taper_path(const Arc& arc, PlotView view, const PlotFrame& frame,
                                     std::array<double, 2> radius);

}  // namespace flexura
