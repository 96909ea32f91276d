#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/model/arm.h"
#include "flexura/model/obstacle.h"

// Distances between the arm's tubes and to obstacles. A tube is the union of balls around the backbone, so
// its ends are hemispheres. Distances are right to `distance_tolerance`: what is returned is a distance that
// occurs, and none is less by more.
namespace flexura {

inline constexpr double distance_tolerance = 5e-7;  ///< m
inline constexpr double no_distance = std::numeric_limits<double>::infinity();

/// One section's tube as it stands.
struct SectionTube {
  Pose X_WS;                          ///< Frame at its start; z is the tangent.
  Eigen::Vector2d bend;               ///< rad
  double length = 0;                  ///< m, stretch included.
  std::array<double, 2> radius = {};  ///< m, at its start and end.
  double turn = 0;   ///< How far the backbone turns from the base to its start: sum of |bend|, rad.
  double start = 0;  ///< How long it is up to there, m.
  /// A quarter of the way around the tube, pi/2 times its radius, at its start and end, m: for PairRule.
  /// Stays when a question is asked of a thicker or thinner tube.
  std::array<double, 2> girth = {};

  /// On the backbone, at the fraction `u` in [0, 1] of the way.
  [[nodiscard]] Eigen::Vector3d point(double u) const;
  [[nodiscard]] double radius_at(double u) const { return radius[0] + u * (radius[1] - radius[0]); }
  [[nodiscard]] double turn_at(double u) const { return turn + u * bend.norm(); }
  [[nodiscard]] double arc_at(double u) const { return start + u * length; }
  [[nodiscard]] double girth_at(double u) const { return girth[0] + u * (girth[1] - girth[0]); }
};

/// The arm's tubes, one a section. `state` must fit the arm, else std::invalid_argument.
[[nodiscard]] std::vector<SectionTube> tube_arcs(const Arm& arm, const ArmState& state);

/// Which pairs of backbone points count: those between which the backbone turns by `turn` rad or more, and
/// those between which it is longer than half a circle of their mean radius by `gap` m or more.
struct PairRule {
  double turn = 0;
  double gap = no_distance;
};

/// A question about the least distance: values at or above `cap` do not matter, and any value below `enough`
/// will do.
struct DistanceWish {
  double cap = no_distance;
  double enough = -no_distance;
};

/// The least distance between the surfaces of `a` and `b` (`a` nearer to the base, or the same arc), m,
/// negative where they overlap, over the pairs of backbone points that count; the cap when there are none, or
/// none nearer.
///
/// Branch and bound: a piece of an arc of length l that turns by psi stays within l min(psi/8, 1/2) of its
/// chord, so the distance of two chords bounds that of the pieces, ever closer as they get shorter.
[[nodiscard]] double tube_distance(const SectionTube& a, const SectionTube& b, const PairRule& rule,
                                   const DistanceWish& wish = {});

/// Whether all these pairs are surely as far apart; false where it takes long to prove.
[[nodiscard]] bool stay_apart(const SectionTube& a, const SectionTube& b, const PairRule& rule,
                              double distance);

/// Whether some of these pairs are surely nearer; false where it takes long to prove.
[[nodiscard]] bool come_within(const SectionTube& a, const SectionTube& b, const PairRule& rule,
                               double distance);

/// The least distance from the tube's surface to the obstacle, m, negative where they overlap; of the tube
/// from the fraction `from` on. To a plane it is exact.
[[nodiscard]] double obstacle_distance(const SectionTube& tube, double from, const Obstacle& obstacle,
                                       const DistanceWish& wish);

/// Whether the tube surely stays as far from the obstacle; false where it takes long to prove.
[[nodiscard]] bool stays_clear(const SectionTube& tube, double from, const Obstacle& obstacle,
                               double distance);

/// Whether the tube surely comes nearer to the obstacle; false where it takes long to prove.
[[nodiscard]] bool comes_within(const SectionTube& tube, double from, const Obstacle& obstacle,
                                double distance);

}  // namespace flexura
