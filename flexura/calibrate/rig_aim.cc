#include "flexura/calibrate/rig_aim.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

constexpr double half_pi = 1.57079632679489661923;

double focal_of(const Camera& camera, double zoom) {
  const Intrinsics lens = camera.lens().at(zoom);
  return std::sqrt(lens.fx * lens.fy);
}

// Returns the lens position at which a size that grows with the focal length equals `desired`, or is nearest
// to it.
template <class Size>
double zoom_where(const Camera& camera, double desired, int halvings, const Size& size) {
  auto [low, high] = zoom_ends(camera);
  if (!(desired > size(low))) return low;
  if (!(desired < size(high))) return high;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (size(middle) < desired ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double zoom_of(const Camera& camera, double focal) {
  return zoom_where(camera, focal, 100, [&](double zoom) { return focal_of(camera, zoom); });
}

// Moves two cameras towards the wanted configuration.
class Seeker {
 public:
  Seeker(const RigModel& model, const RigGoal& rig_goal)
      : goal_(rig_goal),
        stances_(rig_goal.now),
        models_{&model.cameras.at(rig_goal.now[0].camera), &model.cameras.at(rig_goal.now[1].camera)},
        cameras_{Camera(*models_[0]), Camera(*models_[1])} {
    if (rig_goal.now[0].camera == rig_goal.now[1].camera)
      throw std::invalid_argument("a target configuration needs two different cameras");
  }

  DesiredRig seek(const RigModel& model) {
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
      start_[i] = focal_of(cameras_[i], stances_[i].head.zoom) / depth(i);
    constexpr int rounds = 5;  // The pupils shift a little with the zooms.
    for (int round = 0; round < rounds; ++round) {
      zoom();
      if (goal_.may_use_stages) slide();
    }
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) settle(i);
    turn();
    DesiredRig result;
    draw_to_steps(model);
    note(result);
    result.stances = stances_;
    result.remainder = remainder(model, stances_, goal_.target);
    return result;
  }

 private:
  void aim(std::size_t i) { stances_[i].head = aimed(*models_[i], stances_[i], goal_.target); }
  [[nodiscard]] Eigen::Vector3d sight(std::size_t i) const {
    return goal_.target - cameras_[i].pose(stances_[i].stance()).position;
  }
  [[nodiscard]] double depth(std::size_t i) const { return sight(i).norm(); }

  void zoom() {
    double least = 0, most = std::numeric_limits<double>::infinity();
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      aim(i);
      const double a = focal_of(cameras_[i], zoom_of(cameras_[i], 0)) / depth(i);
      const double b =
          focal_of(cameras_[i], zoom_of(cameras_[i], std::numeric_limits<double>::infinity())) / depth(i);
      least = std::max(least, a), most = std::min(most, b);
    }
    const double desired = std::sqrt(start_[0] * start_[1]);
    magnification_ = std::min(std::max(desired, least), most);
    is_zoom_short_ = least > most;
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
      stances_[i].head.zoom = zoom_of(cameras_[i], magnification_ * depth(i));
  }

  // Newton steps of least length towards orthogonal lines of sight, within the travel of the stages.
  void slide() {
    constexpr int most = 50;
    constexpr double enough = 1e-13;
    for (int step = 0; step < most; ++step) {
      for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) aim(i);
      const Eigen::Vector3d a = sight(0), b = sight(1);
      const double cosine = a.normalized().dot(b.normalized());
      if (std::abs(cosine) < enough) return;
      Eigen::Vector<double, 6> slope;
      slope << by_stage(0, a, b, cosine), by_stage(1, b, a, cosine);
      for (Eigen::Index j = 0; j < 6; ++j)
        if (is_stopped(j, -cosine * slope[j])) slope[j] = 0;
      if (!(slope.squaredNorm() > enough)) return;
      const Eigen::Vector<double, 6> move = -cosine / slope.squaredNorm() * slope;
      for (Eigen::Index j = 0; j < 6; ++j) {
        const auto& limits = slide_of(j).limits;
        double& offset = stances_[static_cast<std::size_t>(j / 3)].stage.offset[j % 3];
        offset = std::clamp(offset + move[j], limits[0], limits[1]);
      }
    }
  }

  // d cosine / d stage offset, for the camera with the line of sight `own`.
  [[nodiscard]] Eigen::Vector3d by_stage(std::size_t i, const Eigen::Vector3d& own,
                                         const Eigen::Vector3d& other, double cosine) const {
    const Eigen::Vector3d by_pupil = (cosine * own.normalized() - other.normalized()) / own.norm();
    return cameras_[i].mount().rotation.transpose() * by_pupil;
  }
  [[nodiscard]] const AxisConfig& slide_of(Eigen::Index j) const {
    return cameras_[static_cast<std::size_t>(j / 3)].stage_axes()[static_cast<std::size_t>(j % 3)];
  }
  [[nodiscard]] bool is_stopped(Eigen::Index j, double way) const {
    const auto& limits = slide_of(j).limits;
    const double offset = stances_[static_cast<std::size_t>(j / 3)].stage.offset[j % 3];
    return way > 0 ? offset >= limits[1] : offset <= limits[0];
  }

  // Clamps and quantises stage and zoom.
  void settle(std::size_t i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      double& offset = stances_[i].stage.offset[j];
      offset = commandable(cameras_[i].stage_axes()[static_cast<std::size_t>(j)], offset);
    }
    stances_[i].head.zoom = commandable(cameras_[i].head_axes()[2], stances_[i].head.zoom);
  }

  // Turns both axes along the lines of sight, then each by half of what is missing to 90 degrees.
  void turn() {
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) aim(i);
    const Eigen::Vector3d a = sight(0).normalized(), b = sight(1).normalized();
    const Eigen::Vector3d across = a.cross(b);
    const double excess = std::atan2(across.norm(), a.dot(b)) - half_pi;
    if (!(across.norm() > 0)) return;
    const Eigen::Vector3d half = 0.5 * excess * across.normalized();
    look_along(0, so3_exp(half) * a), look_along(1, so3_exp(-half) * b);
  }
  void look_along(std::size_t i, const Eigen::Vector3d& direction) {
    stances_[i].head = cameras_[i].looking_along(direction, stances_[i].head.zoom);
  }

  // Chooses, of the positions around the wanted one, those with the most nearly orthogonal axes; among these,
  // those that aim best at the target.
  void draw_to_steps(const RigModel& model) {
    desired_ = stances_;
    constexpr unsigned ways = 16;
    constexpr double axes_first = 1e4;
    double least = std::numeric_limits<double>::infinity();
    for (unsigned way = 0; way < ways; ++way) {
      std::array<RigStance, 2> tried = desired_;
      for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
        const unsigned bits = way >> (2 * i);
        tried[i].head.pan = neighbour(cameras_[i].head_axes()[0], desired_[i].head.pan, (bits & 1) != 0);
        tried[i].head.tilt = neighbour(cameras_[i].head_axes()[1], desired_[i].head.tilt, (bits & 2) != 0);
      }
      const RigRemainder left = remainder(model, tried, goal_.target);
      double cost = axes_first * left.angle * left.angle;
      for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
        cost += left.aim[i].squaredNorm() / (depth(i) * depth(i));
      if (cost < least) least = cost, stances_ = tried;
    }
  }
  static double neighbour(const AxisConfig& axis, double position, bool is_above) {
    if (!(axis.resolution > 0)) return commandable(axis, position);
    const double step = position / axis.resolution;
    return commandable(axis, axis.resolution * (is_above ? std::ceil(step) : std::floor(step)));
  }

  void note(DesiredRig& result) const {
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      const std::array<double, 2> is = {stances_[i].head.pan, stances_[i].head.tilt},
                                  should = {desired_[i].head.pan, desired_[i].head.tilt};
      constexpr std::array<const char*, 2> names = {"pan", "tilt"};
      for (std::size_t j = 0; j < 2; ++j) {
        const AxisConfig& axis = cameras_[i].head_axes()[j];
        if (std::abs(is[j] - should[j]) > axis.resolution * (1 + 1e-9) + 1e-12)
          result.notes.push_back(fmt::format("{}: {} ends at {:.4f} rad, target {:.4f}", models_[i]->name,
                                             names[j], is[j], should[j]));
      }
    }
    if (is_zoom_short_)
      result.notes.emplace_back("the zoom ranges of the cameras do not allow equal sizes of the target");
    const double cosine = sight(0).normalized().dot(sight(1).normalized());
    constexpr double visible = 1e-3;
    if (std::abs(cosine) > visible)
      result.notes.push_back(
          fmt::format("at the limits of the stages, the angle between the lines of sight differs by {:.4f} "
                      "rad from 90 degrees: the axes miss the target",
                      std::abs(std::asin(std::clamp(cosine, -1.0, 1.0)))));
  }

  const RigGoal& goal_;
  std::array<RigStance, 2> stances_, desired_;
  std::array<const CameraConfig*, 2> models_;
  std::array<Camera, 2> cameras_;
  std::array<double, 2> start_ = {0, 0};
  double magnification_ = 0;
  bool is_zoom_short_ = false;
};

}  // namespace

Eigen::Vector3d arm_middle(const RigModel& model, const ArmState& state) {
  const Backbone backbone(model.arm, model.bent(state));
  return backbone.pose(0.5 * backbone.length()).position;
}

std::array<double, 2> zoom_ends(const Camera& camera) {
  auto [low, high] = camera.head_axes()[2].limits;
  low = std::max(low, camera.lens().first()), high = std::min(high, camera.lens().last());
  if (camera.lens().ratio(low) > camera.lens().ratio(high)) std::swap(low, high);
  return {low, high};
}

double zoom_at(const Camera& camera, double ratio) {
  return zoom_where(camera, ratio, 60, [&](double zoom) { return camera.lens().ratio(zoom); });
}

double zoom_by(const Camera& camera, double from, double ratio) {
  return zoom_at(camera, camera.lens().ratio(from) * ratio);
}

HeadState aimed(const CameraConfig& model, const RigStance& stance, const Eigen::Vector3d& p_WP) {
  const Camera camera(model);
  HeadState head = stance.head;
  // The pupil moves with the head; each round multiplies the error by the pupil's lever over the distance.
  constexpr int most = 60;
  for (int round = 0; round < most; ++round) {
    const HeadState next = camera.looking_along(p_WP - camera.pose({head, stance.stage}).position, head.zoom);
    const bool is_same = next == head;
    head = next;
    if (is_same) break;
  }
  return head;
}

Eigen::Vector3d stage_towards(const CameraConfig& model, const RigStance& stance,
                              const Eigen::Vector3d& p_WC) {
  const Camera camera(model);
  const Eigen::Vector3d now = camera.pose(stance.stance()).position;
  return stance.stage.offset + camera.mount().rotation.transpose() * (p_WC - now);
}

RigStance commanded(const Camera& camera, RigStance stance) {
  const auto& [pan, tilt, zoom] = camera.head_axes();
  stance.head = {commandable(pan, stance.head.pan), commandable(tilt, stance.head.tilt),
                 commandable(zoom, stance.head.zoom)};
  for (std::size_t j = 0; j < 3; ++j) {
    double& offset = stance.stage.offset[static_cast<Eigen::Index>(j)];
    offset = commandable(camera.stage_axes()[j], offset);
  }
  return stance;
}

HeadState turned_towards(HeadState head, const Intrinsics& lens, const Eigen::Vector2d& off) {
  head.pan -= std::atan(off.x() / lens.fx), head.tilt -= std::atan(off.y() / lens.fy);
  return head;
}

RigRemainder remainder(const RigModel& model, const std::array<RigStance, 2>& stances,
                       const Eigen::Vector3d& target) {
  RigRemainder left;
  std::array<Eigen::Vector3d, 2> axes;
  std::array<double, 2> sizes = {1, 1};
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    const Camera camera(model.cameras.at(stances[i].camera));
    const Pose X_WC = camera.pose(stances[i].stance());
    const Eigen::Vector3d p_CT = X_WC.inverse() * target;
    axes[i] = X_WC.rotation.col(2);
    left.aim[i] = -p_CT.head<2>();
    left.roll[i] = roll_of(X_WC.rotation).value_or(0);
    sizes[i] = focal_of(camera, stances[i].head.zoom) / p_CT.z();
  }
  left.angle = std::atan2(axes[0].cross(axes[1]).norm(), axes[0].dot(axes[1])) - half_pi;
  left.zoom_ratio = sizes[0] / sizes[1];
  return left;
}

DesiredRig desired_rig(const RigModel& model, const RigGoal& rig_goal) {
  return Seeker(model, rig_goal).seek(model);
}

}  // namespace flexura
