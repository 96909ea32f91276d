#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/model/arm.h"
#include "flexura/model/obstacle.h"

// Distances between the arm's tubes and to obstacles. A tube is the union of balls around the backbone, so
// its ends are hemispheres. Distances are right to `distance_tolerance`: the result is a distance that
// occurs, and no distance is less by more.
namespace flexura {

inline constexpr double distance_tolerance = 5e-7;  ///< m.
inline constexpr double no_distance = std::numeric_limits<double>::infinity();

/// The tube of one section in a state.
struct SectionTube {
  Pose X_WS;                          ///< Frame at its start; z is the tangent.
  Eigen::Vector2d bend;               ///< rad.
  double length = 0;                  ///< In m, with stretch.
  std::array<double, 2> radius = {};  ///< In m, at its start and end.
  double turn = 0;   ///< Turn of the backbone from the base to its start: sum of |bend|, rad.
  double start = 0;  ///< Length of the backbone up to its start, m.
  /// A quarter of the circumference, pi/2 times its radius, at its start and end, m: for PairRule. Unchanged
  /// for thicker or thinner copies of a tube.
  std::array<double, 2> girth = {};

  /// Returns the backbone point at the fraction `u` in [0, 1] of the section.
  [[nodiscard]] Eigen::Vector3d point(double u) const;
  [[nodiscard]] double radius_at(double u) const { return radius[0] + u * (radius[1] - radius[0]); }
  [[nodiscard]] double turn_at(double u) const { return turn + u * bend.norm(); }
  [[nodiscard]] double arc_at(double u) const { return start + u * length; }
  [[nodiscard]] double girth_at(double u) const { return girth[0] + u * (girth[1] - girth[0]); }
};

/// Returns the arm's tubes, one per section. Throws std::invalid_argument if `state` does not fit the arm.
[[nodiscard]] std::vector<SectionTube> tube_arcs(const Arm& arm, const ArmState& state);

/// Rule for the pairs of backbone points that count. Either the backbone turns by `turn` rad or more between
/// them. Or it is longer between them than half a circle of their mean radius, by `gap` m or more.
struct PairRule {
  double turn = 0;
  double gap = no_distance;
};

/// Required precision of a least distance: values at or above `cap` do not matter, and any value below
/// `enough` suffices.
struct DistanceQuery {
  double cap = no_distance;
  double enough = -no_distance;
};

/// Returns the least distance between the surfaces of `a` and `b`, m, over the pairs of backbone points that
/// count. `a` is nearer to the base, or the same arc. Negative if they overlap; the cap if there are no
/// pairs, or none nearer.
///
/// Branch and bound: a piece of an arc of length l that turns by psi stays within l min(psi/8, 1/2) of its
/// chord. So the distance of two chords bounds that of the pieces, more tightly as they get shorter.
[[nodiscard]] double tube_distance(const SectionTube& a, const SectionTube& b, const PairRule& rule,
                                   const DistanceQuery& query = {});

/// Returns true if all these pairs are proved to be at least this far apart; false if the proof takes too
/// long.
[[nodiscard]] bool stay_apart(const SectionTube& a, const SectionTube& b, const PairRule& rule,
                              double distance);

/// Returns true if some of these pairs are proved to be nearer; false if the proof takes too long.
[[nodiscard]] bool come_within(const SectionTube& a, const SectionTube& b, const PairRule& rule,
                               double distance);

/// Returns the least distance from the tube's surface to the obstacle, m, negative if they overlap, for the
/// tube from the fraction `from` on. Exact for a plane.
[[nodiscard]] double obstacle_distance(const SectionTube& tube, double from, const Obstacle& obstacle,
                                       const DistanceQuery& query);

/// Returns true if the tube is proved to stay at least this far from the obstacle; false if the proof takes
/// too long.
[[nodiscard]] bool stays_clear(const SectionTube& tube, double from, const Obstacle& obstacle,
                               double distance);

/// Returns true if the tube is proved to come nearer to the obstacle; false if the proof takes too long.
[[nodiscard]] bool comes_within(const SectionTube& tube, double from, const Obstacle& obstacle,
                                double distance);

}  // namespace flexura
