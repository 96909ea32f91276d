#include "flexura/kinematics/reach.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ranges>

#include "flexura/math/series.h"
#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

using std::numbers::pi;

double shortest(const Section& section) { return section.length * section.stretch_limits[0]; }
double longest(const Section& section) { return section.length * section.stretch_limits[1]; }

double total_bend(const Arm& arm) {
  double sum = 0.0;
  for (const Section& section : arm.sections) sum += section.max_bend;
  return sum;
}

// Returns the farthest position of any tip along a direction at the angle `beta` in [0, pi] from the base's
// z. At a fraction f of section i the tangent has turned by at most psi = (bends before) + f max_bend_i. So
// its component along the direction is at most cos(max(0, beta - psi)); the result is the integral of that.
double support(const Arm& arm, double beta) {
  double left = beta;  // beta - psi at the section's start.
  double sum = 0.0;
  for (const Section& section : arm.sections) {
    double mean = 1.0;
    if (left > 0.0) {
      const double turning =
          std::min(1.0, left / section.max_bend);  // Fraction of the section; 0 without a limit.
      const double turn = turning > 0.0 ? turning * section.max_bend : 0.0;
      mean = turning * std::cos(left - 0.5 * turn) * sinc(0.5 * turn) + (1.0 - turning);
      left -= section.max_bend;
    }
    sum += mean * (mean > 0.0 ? longest(section) : shortest(section));
  }
  return sum;
}

// Returns the distance of p beyond the support plane that it violates most. It is a lower bound on the
// distance of p from the convex hull of all tips. The hull is symmetric about z, so directions in the plane
// of z and p suffice.
double beyond_hull(const Arm& arm, const Eigen::Vector3d& p) {
  const double across = std::hypot(p.x(), p.y());
  const auto beyond = [&](double beta) {
    return across * std::sin(beta) + p.z() * std::cos(beta) - support(arm, beta);
  };
  constexpr int cuts = 64;
  int best = 0;
  for (int k = 1; k <= cuts; ++k) {
    if (beyond(pi * k / cuts) > beyond(pi * best / cuts)) best = k;
  }
  double low = pi * std::max(0, best - 1) / cuts;
  double high = pi * std::min(cuts, best + 1) / cuts;
  double largest = beyond(pi * best / cuts);
  for (int i = 0; i < 40; ++i) {
    const double left = low + (high - low) / 3;
    const double right = high - (high - low) / 3;
    const double at_left = beyond(left);
    const double at_right = beyond(right);
    largest = std::max({largest, at_left, at_right});
    (at_left > at_right ? high : low) = at_left > at_right ? right : left;
  }
  return largest;
}

// Returns the shortest chord of the whole arm as a chain of links, one per section's chord.
double hole_of_chain(const Arm& arm) {
  double all = 0.0;
  for (const Section& section : arm.sections) all += longest(section);
  double hole = 0.0;
  for (const Section& section : arm.sections) {
    const double chord = section.max_bend < 2 * pi ? shortest(section) * sinc(0.5 * section.max_bend) : 0.0;
    hole = std::max(hole, chord - (all - longest(section)));
  }
  return hole;
}

// Schur's comparison theorem: among all curves with these lengths and no more curvature anywhere, the plane
// arc bent fully to one side has the shortest chord. This holds if arc and chord together are convex.
double hole_by_schur(const Arm& arm) {
  const double turn = total_bend(arm);
  if (!(turn < 2 * pi)) return 0.0;
  Pose end;
  for (const Section& section : arm.sections) {
    if (section.can_stretch()) return 0.0;
    end = end * arc_pose({section.max_bend, 0.0}, longest(section));
  }
  const Eigen::Vector3d& p = end.position;
  const bool is_convex = turn <= pi || (p.x() >= 0.0 && turn <= pi + std::atan2(p.x(), p.z()));
  return is_convex ? p.norm() : 0.0;
}

double least_distance_in_space(const Arm& arm, const Eigen::Vector3d& p) {
  const double hole = std::max(hole_of_chain(arm), hole_by_schur(arm));
  return std::max({0.0, beyond_hull(arm, p), hole - p.norm()});
}

}  // namespace

double least_distance(const Arm& arm, const Eigen::Vector3d& p_BP) {
  if (arm.kind == ArmKind::spatial) return least_distance_in_space(arm, p_BP);
  // The plane is B's x-z.
  return std::hypot(p_BP.y(), least_distance_in_space(arm, {p_BP.x(), 0.0, p_BP.z()}));
}

double least_angle(const Arm& arm, const Eigen::Vector3d& d_B) {
  const double from_z = std::atan2(std::hypot(d_B.x(), d_B.y()), d_B.z());
  const double by_bends = std::max(0.0, from_z - total_bend(arm));
  const double out_of_plane = std::atan2(std::abs(d_B.y()), std::hypot(d_B.x(), d_B.z()));
  return arm.kind == ArmKind::planar ? std::max(by_bends, out_of_plane) : by_bends;
}

double least_angle(const Arm& arm, const Eigen::Matrix3d& R_BT) {
  double least =
      std::max(least_angle(arm, Eigen::Vector3d(R_BT.col(2))), so3_log(R_BT).norm() - total_bend(arm));
  if (arm.kind == ArmKind::planar) {
    // In a planar arm the y axis never rotates.
    const Eigen::Vector3d y = R_BT.col(1);
    least = std::max(least, std::atan2(std::hypot(y.x(), y.z()), y.y()));
  }
  return std::max(0.0, least);
}

double least_distance_along(const Arm& arm, const Pose& X_BT) {
  // Seen from the tip backwards, the arm has the same sections in reverse order.
  Arm reverse = arm;
  std::ranges::reverse(reverse.sections);
  const Pose turned{Eigen::Vector3d(-1.0, 1.0, -1.0).asDiagonal(), Eigen::Vector3d::Zero()};
  const Eigen::Vector3d base = (X_BT * turned).inverse().position;
  return std::max(least_distance(arm, X_BT.position), least_distance(reverse, base));
}

}  // namespace flexura
