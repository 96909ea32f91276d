#include "flexura/view/truth_extras.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "flexura/base/source.h"
#include "flexura/math/series.h"
#include "flexura/view/viewed_rig.h"

namespace flexura {
namespace {

constexpr double smallest = 1e-4;  // Smallest difference that is shown, m.
constexpr double largest = 1e6;    // Plausibility limit of a length, m.

InputError no_arm() { return input_error("the log", "the poses of its true arm do not form an arm"); }

// Logged values are validated.
Pose pose_of(const PoseMessage& message) {
  constexpr double rounding = 1e-3;
  const Eigen::Vector3d position(message.position.x, message.position.y, message.position.z);
  const QuaternionMessage& turn = message.orientation;
  const Eigen::Quaterniond quaternion(turn.w, turn.x, turn.y, turn.z);
  if (!(position.norm() < largest) || !(std::abs(quaternion.norm() - 1) < rounding)) throw no_arm();
  return {quaternion.normalized().toRotationMatrix(), position};
}

// Returns the arc that is tangent to z of one pose and ends at the position of another.
Arc arc_between(const Pose& X_WS, const Pose& X_WE) {
  const Eigen::Vector3d way = X_WS.inverse() * X_WE.position;
  const double across = way.head<2>().norm(), half = std::atan2(across, way.z());
  Arc arc;
  arc.X_WS = X_WS;
  arc.length = way.norm() / sinc(half);
  if (across > 0) arc.bend = way.head<2>() * (2 * half / across);
  const bool is_arc = arc.length > 0 && arc.length < largest;  // Both comparisons are false for NaN.
  if (!is_arc) throw no_arm();
  return arc;
}

}  // namespace

LoggedArm logged_arm(const PosesMessage& message) {
  if (message.poses.size() < 2) throw no_arm();
  LoggedArm arm;
  arm.reserve(message.poses.size());
  for (const PoseMessage& pose : message.poses) arm.push_back(pose_of(pose));
  return arm;
}

LoggedArm between(const LoggedArm& from, const LoggedArm& to, double part) {
  if (from.size() != to.size()) return part < 0.5 ? from : to;
  LoggedArm arm;
  arm.reserve(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) arm.push_back(interpolate(from[i], to[i], part));
  return arm;
}

std::vector<ArmSample> samples_of(const LoggedArm& arm) {
  std::vector<Arc> arcs;
  double s = 0;
  for (std::size_t i = 0; i + 1 < arm.size(); ++i) {
    Arc& arc = arcs.emplace_back(arc_between(arm[i], arm[i + 1]));
    arc.s = arc.s_rest = s, arc.rest_length = arc.length;
    s += arc.length;
  }
  return arm_samples(arcs, arm.back());
}

void add_true_arm(const std::vector<ArmSample>& truth, const Backbone& commanded, Extras& extras) {
  const auto is_truth = [](const GhostArm& ghost) { return ghost.id == true_arm.id; };
  if (std::ranges::any_of(extras.ghosts, is_truth)) return;
  const double length = commanded.length() / truth.back().s;
  double most = 0, last = 0;
  for (const ArmSample& sample : truth) {
    const Pose there = commanded.pose(std::min(sample.s * length, commanded.length()));
    last = (sample.X_WS.position - there.position).norm();
    most = std::max(most, last);
  }
  if (!(most > smallest)) return;
  extras.ghosts.push_back({true_arm.id, true_arm.label, true_arm.color, truth});
  if (!extras.title.empty()) return;
  extras.title = "Truth";
  extras.text = fmt::format("distance from the commanded shape: at most {:.1f} mm, at the tip {:.1f} mm",
                            1000 * most, 1000 * last);
}

}  // namespace flexura
