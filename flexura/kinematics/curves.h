#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "flexura/model/backbone.h"

// Cubic curves that draw a backbone where exact arcs cannot be drawn (docs/kinematic-model.md compares them).
namespace flexura {

/// A cubic Bezier curve by its four control points, u in [0, 1].
struct CubicBezier {
  std::array<Eigen::Vector3d, 4> points;  ///< The first and the last are its ends, in W, m.

  /// Its point, in W, m. u outside [0, 1] goes on along the cubic.
  [[nodiscard]] Eigen::Vector3d at(double u) const;
  /// d/du, in W, m for a unit of u.
  [[nodiscard]] Eigen::Vector3d velocity(double u) const;
};

/// The paper's Catmull-Rom spline through `points` (eq. 11, at least two, else std::invalid_argument), one
/// cubic a span: the tangent at a point is tension * (next - previous), and past each end stands that end's
/// neighbour reflected in it. tension 1/2 is the standard spline, the only one that draws equally spaced
/// points of a straight line at constant speed.
[[nodiscard]] std::vector<CubicBezier> catmull_rom(std::span<const Eigen::Vector3d> points,
                                                   double tension = 0.5);

/// The same through `spans` >= 1 equal pieces of every section (1: the section base points alone, as in the
/// paper); std::invalid_argument for fewer.
[[nodiscard]] std::vector<CubicBezier> catmull_rom(const Backbone& backbone, int spans, double tension = 0.5);

/// One cubic a section with exact ends and exact end tangents; its middle lies on the arc too. A section bent
/// more than half a turn is drawn in the fewest equal pieces that bend no more: a single cubic's handles grow
/// beyond bounds towards a full turn.
[[nodiscard]] std::vector<CubicBezier> tangent_bezier(const Backbone& backbone);

/// The curves an arm may be drawn with: its exact arcs, the paper's spline through the section base points,
/// or one tangent-exact cubic a section.
enum class CurveKind : std::uint8_t { arcs, catmull_rom, bezier };

/// The cubics of a kind, in W, m, from the base on; none for `arcs`, which are drawn as they are. `tension`
/// is the spline's.
[[nodiscard]] std::vector<CubicBezier> drawn_curve(const Backbone& backbone, CurveKind kind, double tension);

/// How a drawn curve differs from the backbone.
struct CurveDeviation {
  double distance =
      0.0;  ///< Largest distance of the curve's points from the backbone, m (256 a piece looked at).
  double length = 0.0;  ///< Of the curve, m.
};
/// How far off `curve` is, and how long.
[[nodiscard]] CurveDeviation deviation(std::span<const CubicBezier> curve, const Backbone& backbone);

}  // namespace flexura
