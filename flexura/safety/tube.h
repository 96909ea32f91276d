#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/model/arm.h"
#include "flexura/model/obstacle.h"

// Distances between the arm's tubes, and from the tubes to obstacles. A tube is the union of balls around the
// backbone, so that its ends are hemispheres. A computed smallest distance exceeds the true smallest distance
// by at most `distance_tolerance`.
namespace flexura {

inline constexpr double distance_tolerance = 5e-7;  ///< Largest error of distances, m.
inline constexpr double no_distance = std::numeric_limits<double>::infinity();

/// The tube of one section in a state of the arm.
struct SectionTube {
  Pose X_WS;                          ///< Frame at the section's start; z is the tangent.
  Eigen::Vector2d bend;               ///< Bend vector, rad.
  double length = 0;                  ///< Length with stretch, m.
  std::array<double, 2> radius = {};  ///< Radius at the section's start and end, m.
  /// Total turning angle of the backbone from the arm's base to the section's start: the sum of |bend|, rad.
  double turn = 0;
  double start = 0;  ///< Length of the backbone from the arm's base to the section's start, m.
  /// A quarter of the circumference (pi/2 times the radius) at the section's start and end, m, for PairRule.
  /// This length remains unchanged in thicker or thinner copies of a tube.
  std::array<double, 2> girth = {};

  /// Returns the backbone point at the fraction `u` of the section, in [0, 1].
  [[nodiscard]] Eigen::Vector3d point(double u) const;
  [[nodiscard]] double radius_at(double u) const { return radius[0] + u * (radius[1] - radius[0]); }
  [[nodiscard]] double turn_at(double u) const { return turn + u * bend.norm(); }
  [[nodiscard]] double arc_at(double u) const { return start + u * length; }
  [[nodiscard]] double girth_at(double u) const { return girth[0] + u * (girth[1] - girth[0]); }
};

/// Returns the arm's tubes, one per section. Throws std::invalid_argument unless `state` has one bend and one
/// stretch per section.
[[nodiscard]] std::vector<SectionTube> tube_arcs(const Arm& arm, const ArmState& state);

/// Rule that selects pairs of backbone points. A pair is selected if the backbone between its points turns by
/// `turn`, rad, or more. A pair is also selected if the backbone between its points exceeds half a circle of
/// the pair's mean radius by at least `gap`, m.
struct PairRule {
  double turn = 0;
  double gap = no_distance;
};

/// Required precision of a smallest distance, m. Distances of at least `cap` need not be computed, and any
/// distance below `enough` suffices.
struct DistanceQuery {
  double cap = no_distance;
  double enough = -no_distance;
};

/// Returns the smallest distance between the surfaces of `a` and `b`, m, over the pairs of backbone points
/// that `rule` selects. `a` is nearer to the base than `b`, or is the section `b` itself. The result is
/// negative if the tubes overlap, and query.cap if no selected pair is nearer than query.cap.
///
/// The method is branch and bound. A piece of an arc with the length l and the angle psi is within l
/// min(psi/8, 1/2) of its chord. Hence the distance of two chords bounds the distance of their pieces, more
/// tightly for shorter pieces.
[[nodiscard]] double tube_distance(const SectionTube& a, const SectionTube& b, const PairRule& rule,
                                   const DistanceQuery& query = {});

/// Returns true if the function proves that all pairs selected by `rule` are at least `distance`, m, apart.
/// Returns false if no proof is found within the limit on steps.
[[nodiscard]] bool stay_apart(const SectionTube& a, const SectionTube& b, const PairRule& rule,
                              double distance);

/// Returns true if the function proves that a pair selected by `rule` is nearer than `distance`, m. Returns
/// false if no proof is found within the limit on steps.
[[nodiscard]] bool come_within(const SectionTube& a, const SectionTube& b, const PairRule& rule,
                               double distance);

/// Returns the smallest distance, m, between the obstacle and the tube's surface beyond the fraction `from`
/// of the section. The distance is negative if tube and obstacle overlap. The distance is exact for a plane.
[[nodiscard]] double obstacle_distance(const SectionTube& tube, double from, const Obstacle& obstacle,
                                       const DistanceQuery& query);

/// Returns true if the function proves that the tube is at least `distance`, m, from the obstacle. Returns
/// false if no proof is found within the limit on steps.
[[nodiscard]] bool stays_clear(const SectionTube& tube, double from, const Obstacle& obstacle,
                               double distance);

/// Returns true if the function proves that the tube is nearer to the obstacle than `distance`, m. Returns
/// false if no proof is found within the limit on steps.
[[nodiscard]] bool comes_within(const SectionTube& tube, double from, const Obstacle& obstacle,
                                double distance);

}  // namespace flexura
