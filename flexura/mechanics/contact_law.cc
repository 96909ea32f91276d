#include "flexura/mechanics/contact_law.h"

#include <cmath>

#include "flexura/math/so3.h"

namespace flexura {
namespace {

// Below this part of the static force, a separating contact fades out.
constexpr double fading = 0.1;

// Positive part of x, smoothed between -fading and fading, with its derivative.
void positive_part(double x, double& value, double& slope) {
  if (x >= fading) {
    value = x;
    slope = 1;
  } else if (x <= -fading) {
    value = slope = 0;
  } else {
    value = (x + fading) * (x + fading) / (4 * fading);
    slope = (x + fading) / (2 * fading);
  }
}

struct Sliding {
  double normal_speed = 0, speed = 0;                  // Normal and smoothed tangential (slip) speed.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // Velocity of the ball's surface relative to the body.
  ContactPress press;
};

Sliding sliding_of(const ContactLaw& law, const Touch& touch, const TouchForce& at) {
  Sliding sliding;
  sliding.velocity = touch.twist.head<3>() + touch.twist.tail<3>().cross(at.point);
  sliding.normal_speed = touch.nearest.normal.dot(sliding.velocity);
  sliding.press = press(law, at.depth, -sliding.normal_speed);
  const Eigen::Vector3d slip = sliding.velocity - sliding.normal_speed * touch.nearest.normal;
  sliding.speed = std::sqrt(slip.squaredNorm() + law.slip_speed * law.slip_speed);
  return sliding;
}

// Friction per newton of normal force, derivative by the slip, negated.
Eigen::Matrix3d rub_by_slip(const ContactLaw& law, const Sliding& sliding, const Eigen::Vector3d& slip) {
  const Eigen::Vector3d part = slip / sliding.speed;
  return law.friction / sliding.speed * (Eigen::Matrix3d::Identity() - part * part.transpose());
}

}  // namespace

// Within these limits, forces and their derivatives do not overflow.
std::string law_problem(const ContactLaw& law) {
  constexpr double least = 1e-30, most = 1e30;
  const auto is_above = [](double value) { return value >= least && value <= most; };
  const auto is_not_below = [](double value) { return value >= 0 && value <= most; };
  if (!is_above(law.stiffness)) return "the stiffness of contacts must be above 0 and at most 1e30";
  if (!is_not_below(law.damping)) return "the damping of contacts must be at least 0 and at most 1e30";
  if (!is_not_below(law.friction)) return "the friction of contacts must be at least 0 and at most 1e30";
  if (!is_above(law.slip_speed)) return "the slip speed of contacts must be above 0 and at most 1e30";
  if (!is_above(law.transition)) return "the transition of contacts must be above 0 and at most 1e30";
  return "";
}

TouchForce touch_force(const ContactLaw& law, const Touch& touch) {
  const Eigen::Vector3d& n = touch.nearest.normal;
  TouchForce result;
  result.depth = touch.radius - touch.nearest.distance;
  result.point = touch.center - touch.radius * n;
  if (!(result.depth > 0)) return result;
  const Sliding sliding = sliding_of(law, touch, result);
  result.normal_force = touch.run * sliding.press.force;
  result.slip = sliding.velocity - sliding.normal_speed * n;
  result.force = result.normal_force * (n - law.friction / sliding.speed * result.slip);
  return result;
}

ContactPress press(const ContactLaw& law, double depth, double rate) {
  if (!(depth > 0)) return {};
  double spring = 0, slope = 0, share = 0, share_slope = 0;
  if (depth < law.transition) {
    spring = law.stiffness * depth * depth / (2 * law.transition);
    slope = law.stiffness * depth / law.transition;
  } else {
    spring = law.stiffness * (depth - 0.5 * law.transition);
    slope = law.stiffness;
  }
  positive_part(1 + law.damping * rate, share, share_slope);
  return {.force = spring * share, .by_depth = slope * share, .by_rate = spring * share_slope * law.damping};
}

// The force is normal_force * along, with along = n - friction slip / speed.
TouchChange::Rows force_change(const ContactLaw& law, const Touch& touch, const TouchForce& at,
                               const TouchChange& change) {
  const Sliding sliding = sliding_of(law, touch, at);
  const Eigen::Vector3d& n = touch.nearest.normal;
  const Eigen::Vector3d along = n - law.friction / sliding.speed * at.slip;
  const TouchChange::Row speed =
      sliding.velocity.transpose() * change.normal + n.transpose() * change.velocity;
  const TouchChange::Row press =
      touch.run * (sliding.press.by_depth * change.depth - sliding.press.by_rate * speed);
  const TouchChange::Rows slip = change.velocity - sliding.normal_speed * change.normal - n * speed;
  return along * press + at.normal_force * (change.normal - rub_by_slip(law, sliding, at.slip) * slip);
}

TouchHold hold_of(const ContactLaw& law, const Touch& touch, const TouchForce& at) {
  const Sliding sliding = sliding_of(law, touch, at);
  const Eigen::Vector3d& n = touch.nearest.normal;
  const Eigen::Matrix3d along = n * n.transpose(), across = Eigen::Matrix3d::Identity() - along;
  return {.stiffness = touch.run * sliding.press.by_depth * along,
          .damping = touch.run * sliding.press.by_rate * along +
                     at.normal_force * across * rub_by_slip(law, sliding, at.slip) * across};
}

// A small twist moves the centre p by Jp, and the normal n(p) by H Jp, where H is its derivative; the
// touching point is p - r n.
TouchForce touch_force(const ContactLaw& law, const Touch& touch, NodePull& pull) {
  using Rows = Eigen::Matrix<double, 3, 6>;
  const TouchForce result = touch_force(law, touch);
  pull = NodePull{};
  if (!(result.depth > 0)) return result;
  const Eigen::Vector3d& n = touch.nearest.normal;
  Rows at_center, at_point;
  at_center << Eigen::Matrix3d::Identity(), -skew(touch.center);
  at_point << Eigen::Matrix3d::Identity(), -skew(result.point);

  TouchChange change;
  change.depth.setZero(6);
  change.normal.setZero(3, 6);
  change.velocity = at_point;
  // The wrench is [f; c x f].
  Rows force = force_change(law, touch, result, change);
  pull.by_twist << force, skew(result.point) * force;
  change.depth = -n.transpose() * at_center;
  change.normal = touch.nearest.curvature * at_center;
  const Rows point = at_center - touch.radius * change.normal;
  change.velocity = skew(touch.twist.tail<3>()) * point;
  force = force_change(law, touch, result, change);
  pull.by_pose << force, skew(result.point) * force - skew(result.force) * point;

  const TouchHold hold = hold_of(law, touch, result);
  pull.is_held = true;
  pull.stiffness = at_point.transpose() * hold.stiffness * at_point;
  pull.damping = at_point.transpose() * hold.damping * at_point;
  pull.wrench = result.wrench();
  return result;
}

}  // namespace flexura
