#include "flexura/mechanics/contact_law.h"

#include <cmath>

#include "flexura/math/so3.h"

namespace flexura {
namespace {

// Below this part of the force at rest, a contact that comes apart fades out.
constexpr double fading = 0.1;

// x where it is above `fading`, 0 below -fading, with a slope between.
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
  double depth_rate = 0, normal_speed = 0, speed = 0;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // Of the ball's surface.
  ContactPress press;
};

TouchForce evaluate(const ContactLaw& law, const Touch& touch, Sliding& sliding) {
  const Eigen::Vector3d& n = touch.nearest.normal;
  TouchForce result;
  result.depth = touch.radius - touch.nearest.distance;
  result.point = touch.center - touch.radius * n;
  if (!(result.depth > 0)) return result;
  sliding.velocity = touch.twist.head<3>() + touch.twist.tail<3>().cross(result.point);
  sliding.normal_speed = n.dot(sliding.velocity);
  sliding.depth_rate = -sliding.normal_speed;
  sliding.press = press(law, result.depth, sliding.depth_rate);
  result.normal_force = touch.run * sliding.press.force;
  result.slip = sliding.velocity - sliding.normal_speed * n;
  sliding.speed = std::sqrt(result.slip.squaredNorm() + law.slip_speed * law.slip_speed);
  result.force = result.normal_force * (n - law.friction / sliding.speed * result.slip);
  return result;
}

}  // namespace

std::string law_problem(const ContactLaw& law) {
  const auto is_above = [](double value) { return value > 0 && std::isfinite(value); };
  if (!is_above(law.stiffness)) return "the stiffness of contacts must be above 0 and finite";
  if (!(law.damping >= 0) || !std::isfinite(law.damping))
    return "the damping of contacts must be at least 0 and finite";
  if (!(law.friction >= 0) || !std::isfinite(law.friction))
    return "the friction of contacts must be at least 0 and finite";
  if (!is_above(law.slip_speed)) return "the slip speed of contacts must be above 0 and finite";
  if (!is_above(law.transition)) return "the transition of contacts must be above 0 and finite";
  return "";
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

TouchForce touch_force(const ContactLaw& law, const Touch& touch) {
  Sliding sliding;
  return evaluate(law, touch, sliding);
}

// The wrench is [f; c x f] with c = p - r n, of the centre p and the normal n(p). A small twist moves p by
// Jp, and n by H Jp, where H is the derivative of the normal.
TouchForce touch_force(const ContactLaw& law, const Touch& touch, NodePull& pull) {
  using Rows = Eigen::Matrix<double, 3, 6>;
  Sliding sliding;
  const TouchForce result = evaluate(law, touch, sliding);
  pull = NodePull{};
  if (!(result.depth > 0)) return result;
  const Eigen::Vector3d &n = touch.nearest.normal, &c = result.point, &slip = result.slip;
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - n * n.transpose();
  Rows at_center, at_point;
  at_center << Eigen::Matrix3d::Identity(), -skew(touch.center);
  at_point << Eigen::Matrix3d::Identity(), -skew(c);

  const double run = touch.run, rub = law.friction / sliding.speed;
  const Eigen::Vector3d along = n - rub * slip;  // f = normal_force along.
  // d along = dn - rub_by_slip d slip.
  const Eigen::Matrix3d rub_by_slip =
      rub * (Eigen::Matrix3d::Identity() - slip * slip.transpose() / (sliding.speed * sliding.speed));

  // By twist: the surface's velocity alone changes.
  const Eigen::Matrix<double, 1, 6> rate_by_twist = -n.transpose() * at_point;
  const Rows force_by_twist = run * sliding.press.by_rate * along * rate_by_twist -
                              result.normal_force * rub_by_slip * (across * at_point);
  pull.by_twist << force_by_twist, skew(c) * force_by_twist;

  // By pose.
  const Rows normal_by_pose = touch.nearest.curvature * at_center;
  const Rows point_by_pose = at_center - touch.radius * normal_by_pose;
  const Rows velocity_by_pose = skew(touch.twist.tail<3>()) * point_by_pose;
  const Eigen::Matrix<double, 1, 6> speed_by_pose =
      sliding.velocity.transpose() * normal_by_pose + n.transpose() * velocity_by_pose;
  const Rows slip_by_pose = velocity_by_pose - sliding.normal_speed * normal_by_pose - n * speed_by_pose;
  const Eigen::Matrix<double, 1, 6> press_by_pose =
      -run * (sliding.press.by_depth * n.transpose() * at_center + sliding.press.by_rate * speed_by_pose);
  const Rows force_by_pose =
      along * press_by_pose + result.normal_force * (normal_by_pose - rub_by_slip * slip_by_pose);
  pull.by_pose << force_by_pose, skew(c) * force_by_pose - skew(result.force) * point_by_pose;

  // What holds: the spring and the damper along the normal, friction across.
  const Eigen::Matrix<double, 1, 6> row = n.transpose() * at_point;
  const Rows slide = across * at_point;
  pull.is_held = true;
  pull.stiffness = run * sliding.press.by_depth * row.transpose() * row;
  pull.damping = run * sliding.press.by_rate * row.transpose() * row +
                 result.normal_force * slide.transpose() * rub_by_slip * slide;
  pull.wrench = result.wrench();
  return result;
}

}  // namespace flexura
