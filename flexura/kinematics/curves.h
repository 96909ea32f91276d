#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "flexura/model/backbone.h"

// Cubic curves that approximate a backbone, for graphics without exact arcs. docs/kinematic-model.md compares
// the curves.
namespace flexura {

/// A cubic Bezier curve with four control points and a parameter u in [0, 1].
struct CubicBezier {
  std::array<Eigen::Vector3d, 4>
      points;  ///< Control points in W, m. The first and the last are the curve's ends.

  /// Returns the point at u, in W, m. Extrapolates the cubic for u outside [0, 1].
  [[nodiscard]] Eigen::Vector3d at(double u) const;
  /// Returns the derivative of the point with respect to u, in W, m.
  [[nodiscard]] Eigen::Vector3d velocity(double u) const;
};

/// Returns the paper's Catmull-Rom spline through `points` (eq. 11), one cubic between each two consecutive
/// points. The tangent at a point is tension * (next point - previous point). At each end of the curve, the
/// missing neighbour is the reflection of the other neighbour in the end point. Tension 1/2 gives the
/// standard spline. Only with this tension, the speed is constant through equally spaced points of a straight
/// line. Throws std::invalid_argument for fewer than two points.
[[nodiscard]] std::vector<CubicBezier> catmull_rom(std::span<const Eigen::Vector3d> points,
                                                   double tension = 0.5);

/// Returns the Catmull-Rom spline through the end points of `spans` equal pieces of every section. With spans
/// = 1 the spline passes only through the sections' base points and the tip, as in the paper. Throws
/// std::invalid_argument for spans < 1.
[[nodiscard]] std::vector<CubicBezier> catmull_rom(const Backbone& backbone, int spans, double tension = 0.5);

/// Returns one cubic per section. The cubic has the ends, end tangents and middle of the section's arc. A
/// section of more than half a turn is split into the smallest number of equal pieces of at most half a turn.
/// The reason is that the control points of a cubic diverge as its arc approaches a full turn.
[[nodiscard]] std::vector<CubicBezier> tangent_bezier(const Backbone& backbone);

/// Curve that is drawn for an arm: the exact arcs, the paper's spline through the sections' base points
/// (catmull_rom), or one cubic per section (tangent_bezier).
enum class CurveKind : std::uint8_t { arcs, catmull_rom, bezier };

/// Returns the cubics of a drawn curve, in W, m, from base to tip. The list is empty for `arcs`, which are
/// drawn directly. `tension` is the parameter of catmull_rom().
[[nodiscard]] std::vector<CubicBezier> drawn_curve(const Backbone& backbone, CurveKind kind, double tension);

/// Deviation of a drawn curve from the backbone.
struct CurveDeviation {
  double distance = 0.0;  ///< Largest distance from the backbone among 256 points per piece of the curve, m.
  double length = 0.0;    ///< Length of the curve, m.
};
/// Returns the deviation of `curve` from `backbone`, and the length of `curve`.
[[nodiscard]] CurveDeviation deviation(std::span<const CubicBezier> curve, const Backbone& backbone);

}  // namespace flexura
