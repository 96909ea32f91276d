#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "flexura/model/backbone.h"

// Cubic curves that approximate a backbone where exact arcs cannot be drawn (docs/kinematic-model.md compares
// them).
namespace flexura {

/// A cubic Bezier curve with four control points, u in [0, 1].
struct CubicBezier {
  std::array<Eigen::Vector3d, 4> points;  ///< The first and the last are its ends, in W, m.

  /// Returns its point at u, in W, m. Extrapolates the cubic for u outside [0, 1].
  [[nodiscard]] Eigen::Vector3d at(double u) const;
  /// Returns d/du, in W, m per unit of u.
  [[nodiscard]] Eigen::Vector3d velocity(double u) const;
};

/// Returns the paper's Catmull-Rom spline through `points` (eq. 11), one cubic per span. The tangent at a
/// point is tension * (next - previous). The point past each end is that end's neighbour reflected in it.
/// Tension 1/2 is the standard spline, the only one with constant speed through equally spaced points of a
/// straight line. Throws std::invalid_argument for fewer than two points.
[[nodiscard]] std::vector<CubicBezier> catmull_rom(std::span<const Eigen::Vector3d> points,
                                                   double tension = 0.5);

/// Returns the Catmull-Rom spline through `spans` >= 1 equal pieces of every section. With 1 it passes only
/// through the section base points, as in the paper. Throws std::invalid_argument for fewer.
[[nodiscard]] std::vector<CubicBezier> catmull_rom(const Backbone& backbone, int spans, double tension = 0.5);

/// Returns one cubic per section with exact ends and end tangents; its middle is on the arc too. A section
/// with more than half a turn is split into the fewest equal pieces within half a turn. A single cubic's
/// handles grow beyond bounds towards a full turn.
[[nodiscard]] std::vector<CubicBezier> tangent_bezier(const Backbone& backbone);

/// Curves for drawing an arm: its exact arcs, the paper's spline through the section base points, or one
/// tangent-exact cubic per section.
enum class CurveKind : std::uint8_t { arcs, catmull_rom, bezier };

/// Returns the cubics of a kind, in W, m, from the base on; empty for `arcs`, which are drawn directly.
/// `tension` is the spline's.
[[nodiscard]] std::vector<CubicBezier> drawn_curve(const Backbone& backbone, CurveKind kind, double tension);

/// Deviation of a drawn curve from the backbone.
struct CurveDeviation {
  double distance =
      0.0;  ///< Largest distance of the curve's points from the backbone, m (256 per piece are checked).
  double length = 0.0;  ///< Length of the curve, m.
};
/// Returns the deviation of `curve` and its length.
[[nodiscard]] CurveDeviation deviation(std::span<const CubicBezier> curve, const Backbone& backbone);

}  // namespace flexura
