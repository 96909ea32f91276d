#include "flexura/calibrate/arc_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "flexura/base/degree.h"
#include "flexura/calibrate/rig_aim.h"
#include "flexura/calibrate/zoom_correlation.h"
#include "flexura/math/arrays.h"
#include "flexura/model/backbone.h"
#include "flexura/vision/eight_bits.h"
#include "flexura/vision/picture_file.h"

namespace flexura {
namespace {

// The centre of the circle on which an arm bent by `bend` towards a direction lies.
Eigen::Vector3d center_of(const Arm& arm, const ArmState& state, double bend,
                          const Eigen::Vector3d& towards) {
  return Backbone(arm, state).pose(0).position + arm.length() / bend * towards;
}

// A camera that looks from `from` along a direction, upright.
View view_along(const Camera& camera, double zoom, const Eigen::Vector3d& from,
                const Eigen::Vector3d& along) {
  View view;
  view.lens = Lens(camera.lens().at(zoom));
  view.X_WC.rotation = upright(along).value_or(Eigen::Matrix3d::Identity());
  view.X_WC.position = from;
  view.width = static_cast<int>(camera.config().sensor.width);
  view.height = static_cast<int>(camera.config().sensor.height);
  return view;
}

// In which the arc of a camera lies.
const char* name_of_plane(std::size_t i) { return i == 0 ? "XOY" : "ZOY"; }

// The smallest magnification that both cameras have, and something to spare for making it smaller still.
double common_magnification(const LookLoop& loop, const std::array<double, 2>& depths) {
  constexpr double spare = 1.15;
  double least = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const Camera& camera = loop.camera(i);
    least = std::max(least, camera.lens().at(zoom_ends(camera)[0]).fx / depths[i]);
  }
  return spare * least;
}

}  // namespace

std::optional<ArmState> arc_state(const Arm& arm, double bend, const Eigen::Vector3d& towards) {
  const Eigen::Vector3d local = arm.X_WB.rotation.transpose() * towards;
  constexpr double slanted = 1e-6;
  if (std::abs(local.z()) > slanted) return std::nullopt;
  if (arm.kind == ArmKind::planar && std::abs(local.y()) > slanted) return std::nullopt;
  ArmState state = ArmState::straight(arm.sections.size());
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const Section& section = arm.sections[i];
    const double share = bend * section.length / arm.length();
    if (share > section.max_bend) return std::nullopt;
    state.bends[i] = share * local.head<2>().normalized();
    const auto& [least, longest] = section.stretch_limits;
    state.stretches[i] = std::clamp(1.0, least, longest);
  }
  return state;
}

std::optional<std::string> plan_arcs(LookLoop& loop, bool aims_at_centers, ArcPlan& plan) {
  const Arm& arm = loop.believed().arm;
  const double bend = loop.config().arc;
  plan.radius = arm.length() / bend;
  plan.normals = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX()};
  // Towards the side from which each camera is believed to look; the arcs bend away from the other camera.
  for (std::size_t i = 0; i < 2; ++i)
    if (vector(loop.model(i).mount.position).dot(plan.normals[i]) < arm.X_WB.position.dot(plan.normals[i]))
      plan.normals[i] = -plan.normals[i];
  const std::array<Eigen::Vector3d, 2> towards = {-plan.normals[1], -plan.normals[0]};
  std::array<Eigen::Vector3d, 2> middles;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto state = arc_state(arm, bend, towards[i]);
    if (!state)
      return fmt::format("the arm cannot be bent into an arc of {:.0f} deg in {}", bend / degree,
                         name_of_plane(i));
    plan.arcs[i] = *state;
    plan.centers[i] = center_of(arm, *state, bend, towards[i]);
    middles[i] = aims_at_centers ? plan.centers[i] : Backbone(arm, *state).pose(0.5 * arm.length()).position;
  }
  plan.target = {middles[0].x(), 0.5 * (middles[0].y() + middles[1].y()), middles[1].z()};
  std::array<double, 2> distances{};
  for (std::size_t i = 0; i < 2; ++i) {
    distances[i] = (vector(loop.model(i).mount.position) - plan.centers[i]).dot(plan.normals[i]);
    if (distances[i] < 2 * plan.radius)
      return fmt::format(
          "camera {} is believed to stand {:.3g} m from the plane {}: expected twice the arc's radius at "
          "least",
          loop.name(i), distances[i], name_of_plane(i));
  }
  std::array<double, 2> depths{};
  for (std::size_t i = 0; i < 2; ++i)
    depths[i] = distances[i] - (plan.target - plan.centers[i]).dot(plan.normals[i]);
  const double magnification = common_magnification(loop, depths);
  for (std::size_t i = 0; i < 2; ++i) {
    const Camera& camera = loop.camera(i);
    const double least = zoom_ends(camera)[0];
    plan.zoom[i] = zoom_by(camera, least, magnification * depths[i] / camera.lens().at(least).fx);
    const Eigen::Vector3d onto =
        plan.target - plan.normals[i].dot(plan.target - plan.centers[i]) * plan.normals[i];
    plan.ideal[i] = view_along(camera, plan.zoom[i], onto + distances[i] * plan.normals[i], -plan.normals[i]);
    plan.pictures[i] = loop.config().draw(plan.ideal[i], plan.arcs[i]);
    loop.plan(i, name_of_plane(i), plan.arcs[i], plan.ideal[i], plan.pictures[i]);
  }
  return std::nullopt;
}

LookLoop::Trouble begin_with_arm(LookLoop& loop) {
  if (auto trouble = loop.begin()) return trouble;
  return loop.look_from_one_side();
}

LookLoop::Trouble zoom_as_planned(LookLoop& loop, const ArcPlan& plan) {
  for (std::size_t i = 0; i < 2; ++i) {
    RigStance stance = loop.stance(i);
    stance.head.zoom = plan.zoom[i];
    stance = loop.commandable_stance(i, stance);
    if (loop.stands_there(i, stance)) continue;
    loop.decide(i, "zoom as planned", 0, 0, "px",
                fmt::format("zoom to {:.5g}, as the simulator has it", stance.head.zoom));
    if (auto trouble = loop.go(i, stance)) return trouble;
  }
  return std::nullopt;
}

LookLoop::Trouble equalize_zooms(LookLoop& loop, const ArcPlan& plan) {
  std::array<double, 2> last = {1, 1};
  for (std::size_t i = 0; i < 2; ++i) {
    if (auto trouble = loop.show(plan.arcs[i])) return trouble;
    constexpr int rounds = 3;
    for (int round = 0; round < rounds; ++round) {
      ZoomCorrelation seen;
      auto trouble = loop.look(i, [&](RigSight& sight) {
        const Image<std::uint8_t> bytes = eight_bits(*sight.frame.picture, loop.model(i).sensor.white());
        seen = correlate_zoom(bytes.channels() == 1 ? bytes : gray_picture(bytes), plan.pictures[i]);
        sight.seen.reason = seen.reason;
        sight.values = {{"zoom over the ideal picture's", seen.ratio}, {"correlation", seen.peak}};
      });
      if (trouble) return trouble;
      if (!seen.reason.empty()) return fmt::format("zoom of camera {}: {}", loop.name(i), seen.reason);
      last[i] = seen.ratio;
      RigStance next = loop.stance(i);
      next.head.zoom = zoom_by(loop.camera(i), next.head.zoom, 1 / seen.ratio);
      next = loop.commandable_stance(i, next);
      const double off = std::abs(std::log(seen.ratio)), accepted = loop.config().zoom_accepted;
      std::string end;
      if (off <= accepted) {
        end = "it holds";
      } else if (loop.stands_there(i, next)) {
        end = "nothing nearer can be commanded";
      } else if (round + 1 == rounds) {
        end = fmt::format("it is left there after {} looks: correlation hardly tells zooms closer", rounds);
      }
      loop.decide(i, "zoom", seen.ratio - 1, accepted, "share",
                  end.empty()
                      ? fmt::format("zoom to {:.5g}, for a correlation of {:.3f}", next.head.zoom, seen.peak)
                      : fmt::format("the correlation is {:.3f}: {}", seen.peak, end));
      if (!end.empty() && off > accepted)
        loop.result().notes.push_back(
            fmt::format("zoom of camera {}: {:.2g} % off the ideal picture's as last correlated, where "
                        "{:.2g} % are accepted: {}",
                        loop.name(i), 100 * off, 100 * accepted, end));
      if (!end.empty()) break;
      if (auto moved = loop.go(i, next)) return moved;
    }
  }
  loop.result().zoom_ratio = last[0] / last[1];
  return std::nullopt;
}

}  // namespace flexura
