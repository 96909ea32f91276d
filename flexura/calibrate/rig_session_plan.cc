#include "flexura/calibrate/rig_session_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "flexura/base/degree.h"
#include "flexura/calibrate/rig_aim.h"
#include "flexura/camera/camera.h"
#include "flexura/math/arrays.h"

namespace flexura {

namespace {

// Whether a ray hits a screen.
bool meets(const ScreenConfig& screen, const Eigen::Vector3d& from, const Eigen::Vector3d& way) {
  const Eigen::Vector3d normal = vector(screen.normal).normalized();
  Eigen::Vector3d right = Eigen::Vector3d::UnitY().cross(normal);
  if (right.norm() < 1e-9) right = Eigen::Vector3d::UnitX();
  right.normalize();
  const Eigen::Vector3d up = normal.cross(right);
  const double distance = (vector(screen.center) - from).dot(normal) / way.dot(normal);
  if (!(distance > 0) || !std::isfinite(distance)) return false;
  const Eigen::Vector3d at = from + distance * way - vector(screen.center);
  return std::abs(at.dot(right)) <= 0.5 * screen.width && std::abs(at.dot(up)) <= 0.5 * screen.height;
}

// Whether a screen is behind a picture's corners and the midpoints of its edges.
bool is_filled(const View& view, const std::vector<ScreenConfig>& screens) {
  for (const double u : {0.0, 0.5, 1.0}) {
    for (const double v : {0.0, 0.5, 1.0}) {
      const auto ray = view.lens.unproject({u * (view.width - 1), v * (view.height - 1)});
      if (!ray) return false;
      const Eigen::Vector3d way = view.X_WC.rotation * ray->homogeneous();
      if (std::ranges::none_of(
              screens, [&](const ScreenConfig& screen) { return meets(screen, view.X_WC.position, way); }))
        return false;
    }
  }
  return true;
}

}  // namespace

bool is_like(const RigModel& model, const ViewCandidate& candidate, const ViewCandidate& look) {
  constexpr double turn = 2 * degree, way = 0.05, larger = 0.1;  // rad; m; share.
  const auto is_near = [&](const RigStance& a, const RigStance& b) {
    if (a.camera != b.camera || !(std::abs(a.head.pan - b.head.pan) < turn) ||
        !(std::abs(a.head.tilt - b.head.tilt) < turn) || !((a.stage.offset - b.stage.offset).norm() < way))
      return false;
    // Positions may be motor counts, which differ between lenses.
    const CameraConfig& camera = model.cameras.at(a.camera);
    const ZoomTable lens(camera.lens, camera.sensor.width, camera.sensor.height);
    return std::abs(std::log(lens.ratio(a.head.zoom) / lens.ratio(b.head.zoom))) <= std::log1p(larger);
  };
  double bent = 0;
  for (std::size_t i = 0; i < candidate.pose.bends.size(); ++i)
    bent = std::max(bent, (candidate.pose.bends[i] - look.pose.bends.at(i)).norm());
  return bent < turn && std::ranges::any_of(
                            candidate.stances,
                            [&](const RigStance& stance) { return is_near(stance, look.stances.front()); });
}

Eigen::Vector3d RigSessionPlan::target(const RigModel& model) const {
  if (config_.target) return *config_.target;
  return config_.etalon ? EtalonFigure(*config_.etalon).middle() : arm_middle(model, config_.poses.front());
}

RigStance RigSessionPlan::first(const RigStance& begins) const {
  RigStance stance = begins;
  if (config_.etalon) stance.head.zoom = zoom_ends(Camera(nominal_.cameras[begins.camera]))[0];
  return stance;
}

DesiredRig RigSessionPlan::desired(const RigModel& model, const std::array<RigStance, 2>& stands) const {
  RigGoal rig_goal;
  rig_goal.target = target(model), rig_goal.now = stands, rig_goal.may_use_stages = config_.may_use_stages;
  for (RigStance& stance : rig_goal.now) {
    // From the initial positions of stage and zoom, as looks have moved them since.
    const Camera camera(nominal_.cameras[stance.camera]);
    stance.stage = camera.initial_stage(), stance.head.zoom = camera.initial_head().zoom;
    stance = first(stance);
  }
  return desired_rig(model, rig_goal);
}

std::vector<ViewGoal> RigSessionPlan::goals(const RigVariables& variables, const RigCalibration& found,
                                            const DesiredRig& desired) const {
  const OpticalAxis a = optical_axis(variables, found.x, {desired.stances[0], {}}),
                    b = optical_axis(variables, found.x, {desired.stances[1], {}});
  return {{axes_angle(a, b), config_.desired.angle},
          {log_focal(a), config_.desired.focal[0]},
          {log_focal(b), config_.desired.focal[1]},
          {log_zoom_ratio(a, b, target(found.model)), config_.desired.zoom_ratio}};
}

void RigSessionPlan::know(const RigVariables& variables, const RigCalibration& found,
                          const DesiredRig& desired, RigStep& step) const {
  const std::vector<ViewGoal> known = goals(variables, found, desired);
  step.desired = desired.stances;
  step.angle = known[0].quantity.value;
  const auto sigma = [&](std::size_t i) { return known[i].quantity.sigma(found.covariance); };
  step.sigmas = {sigma(0), {sigma(1), sigma(2)}, sigma(3)};
  for (std::size_t i = 0; i < 2; ++i) {
    const LensConfig& lens = found.model.cameras[config_.cameras[i]].lens;
    step.focal[i] = std::sqrt(lens.fx * lens.fy.value_or(lens.fx));
  }
}

// Three zooms of a camera, from the shortest ratio to the longest that shows the whole cylinder. Each has the
// distance from the image's middle at which the cylinder still fits.
std::array<std::array<double, 2>, 3> RigSessionPlan::etalon_zooms(const RigModel& model,
                                                                  std::size_t camera) const {
  constexpr double longer = 1.05, most = 20, margin = 20, spread = 0.6;
  const Camera optics(model.cameras[camera]);
  const EtalonFigure etalon(*config_.etalon);
  // Share of half the picture by which the cylinder may be off the middle; empty if it does not fit.
  const auto room = [&](double ratio) -> std::optional<double> {
    RigStance stance{.camera = camera, .head = optics.initial_head(), .stage = optics.initial_stage()};
    stance.head.zoom = zoom_at(optics, ratio);
    stance.head = aimed(model.cameras[camera], stance, etalon.middle());
    const View view = view_of(model, stance);
    const auto points = etalon.outline(view, margin);
    if (!points) return std::nullopt;
    const Eigen::Vector2d half(0.5 * view.width, 0.5 * view.height);
    Eigen::Vector2d reach(0, 0);
    for (const Eigen::Vector2d& point : *points) reach = reach.cwiseMax((point - half).cwiseAbs());
    return std::clamp((1 - (reach.array() + 1.5 * margin) / half.array()).minCoeff(), 0.0, spread);
  };
  const double start = optics.lens().ratio(zoom_ends(optics)[0]),
               end = optics.lens().ratio(zoom_ends(optics)[1]);
  double fits = start;
  for (double ratio = start * longer; ratio <= std::min(end, most * start) && room(ratio); ratio *= longer)
    fits = ratio;
  std::array<std::array<double, 2>, 3> zooms{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double ratio = start * std::pow(fits / start, 0.5 * static_cast<double>(i));
    zooms[i] = {ratio, room(ratio).value_or(0)};
  }
  return zooms;
}

ViewGrid RigSessionPlan::grid(const RigModel& model) const {
  ViewGrid grid;
  grid.poses = config_.poses, grid.spread = 0.6;
  grid.zooms.clear();
  const Camera camera(nominal_.cameras[config_.cameras[0]]);
  const double start = camera.lens().ratio(camera.initial_head().zoom);
  for (const double ratio : config_.zooms) {
    // Limited by the lens.
    const double reached = camera.lens().ratio(zoom_at(camera, start * ratio));
    if (std::ranges::find(grid.zooms, reached) == grid.zooms.end()) grid.zooms.push_back(reached);
  }
  if (config_.etalon) {
    grid.poses.resize(1), grid.zooms = {0, 1, 2}, grid.target = EtalonFigure(*config_.etalon).middle();
    std::vector<std::array<std::array<double, 2>, 3>> zooms;
    zooms.reserve(model.cameras.size());
    for (std::size_t i = 0; i < model.cameras.size(); ++i) zooms.push_back(etalon_zooms(model, i));
    grid.own = [zooms](std::size_t i, double zoom) { return zooms[i][static_cast<std::size_t>(zoom)]; };
  }
  double travel = 0;
  for (const std::size_t i : config_.cameras) {
    const auto& [least, most] = nominal_.cameras[i].mount.stage.x.limits;
    const double distance = (vector(nominal_.cameras[i].mount.position) - target(nominal_)).norm();
    travel = std::max(travel, std::min(config_.slide * distance, std::max(most, -least)));
  }
  if (config_.may_use_stages && travel > 0) grid.slides = {{0, 0, 0}, {travel, 0, 0}, {-travel, 0, 0}};
  return grid;
}

std::pair<std::optional<ViewCandidate>, std::string> RigSessionPlan::next(
    const RigProblem& problem, const RigCalibration& found, const DesiredRig& desired,
    const std::array<RigStance, 2>& stands, const std::vector<ViewCandidate>& missed) const {
  std::vector<ViewCandidate> candidates = view_candidates(found.model, grid(found.model));
  for (ViewCandidate& candidate : candidates) {
    if (!config_.may_use_stages)
      for (RigStance& stance : candidate.stances)
        for (const RigStance& now : stands)
          if (now.camera == stance.camera) stance.stage = now.stage;
    std::erase_if(candidate.stances, [&](const RigStance& stance) {
      return std::ranges::find(config_.cameras, stance.camera) == config_.cameras.end();
    });
  }
  std::erase_if(candidates, [&](const ViewCandidate& candidate) {
    return std::ranges::any_of(missed,
                               [&](const ViewCandidate& one) { return is_like(nominal_, candidate, one); });
  });
  // Outside a screen the background is as dark as the cylinder.
  const auto lacks_screen = [&](const ViewCandidate& candidate) {
    return !std::ranges::all_of(candidate.stances, [&](const RigStance& stance) {
      return is_filled(view_of(found.model, stance), config_.screens);
    });
  };
  if (config_.etalon && !std::ranges::all_of(candidates, lacks_screen))
    std::erase_if(candidates, lacks_screen);
  ViewConfig view;
  if (config_.etalon) view.sigma = 0.05;  // Borders and lines, px.
  view.markers = std::max<std::size_t>(config_.picture.markers.size(), 2), view.fewest = config_.fewest;
  const auto choice =
      next_best_view(problem, found, candidates, goals(problem.variables(), found, desired), view);
  if (!choice) return {std::nullopt, "another pose: no view is expected to show the arm"};
  const ViewCandidate& best = candidates[choice->candidate];
  const auto pose =
      std::ranges::find_if(config_.poses, [&](const ArmState& one) { return one.bends == best.pose.bends; });
  const HeadState &a = best.stances[0].head, &b = best.stances[1].head;
  return {
      best,
      fmt::format(
          "pose {}, the most informative of {} views: pan, tilt and zoom {:.2f} deg, {:.2f} "
          "deg, {:.3g} and {:.2f} deg, {:.2f} deg, {:.3g}; the angle's standard deviation will be {:.4f} deg",
          pose - config_.poses.begin() + 1, candidates.size(), a.pan / degree, a.tilt / degree, a.zoom,
          b.pan / degree, b.tilt / degree, b.zoom, choice->sigmas[0] / degree)};
}

RigCommander::Error RigSessionPlan::error_with(const RigModel& model, const DesiredRig& desired,
                                               const RigStep& step, const ArmState& home) const {
  constexpr double known = 3 * degree, steepest = 50 * degree;
  if (step.sigmas.angle > known) return std::nullopt;
  std::array<Eigen::Vector3d, 2> sights;  // From each camera to the target, m.
  for (std::size_t i = 0; i < 2; ++i)
    sights[i] = target(model) - view_of(model, desired.stances[i]).X_WC.position;
  const double cosine = sights[0].normalized().dot(sights[1].normalized()),
               angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  if (std::min(angle, std::numbers::pi - angle) < steepest)
    return fmt::format(
        "both cameras look {}: their lines of sight are {:.1f} deg apart at the limits of the stages, so "
        "heads alone cannot make the axes orthogonal",
        angle < std::numbers::pi / 2 ? "from one side" : "from opposite sides", angle / degree);
  std::string why;
  for (const std::string& note : desired.notes) why += "; " + note;
  constexpr double far_off = 0.5 * degree, likely = 4;  // Standard deviations.
  const double left = std::abs(desired.remainder.angle);
  double step_of_heads = 0;
  for (const std::size_t i : config_.cameras) {
    const HeadConfig& head = model.cameras[i].head;
    step_of_heads = std::max({step_of_heads, head.pan.resolution, head.tilt.resolution});
  }
  if (left > far_off + step_of_heads + likely * step.sigmas.angle)
    return fmt::format(
        "at the limits of heads and stages, the angle between the axes would differ by {:.1f} deg from 90 "
        "deg{}",
        left / degree, why);
  // The heads make up for the stages and then look beside the arm.
  constexpr double most_aside = 0.1;  // Share of the distance.
  for (std::size_t i = 0; i < 2; ++i) {
    const double aside = desired.remainder.aim[i].norm();
    if (aside > most_aside * sights[i].norm())
      return fmt::format(
          "at the limits of the stages, the lines of sight are {:.1f} deg apart. With orthogonal axes, the "
          "axis of camera {} would pass at {:.2f} m from the {}. Mount the cameras more nearly at a right "
          "angle, or allow more travel of the stages{}",
          angle / degree, model.cameras[desired.stances[i].camera].name, aside,
          config_.etalon ? "cylinder" : "arm", why);
  }
  for (const RigStance& stance : desired.stances)
    if (!is_in_view(model, stance, config_.poses.empty() ? home : config_.poses.front()))
      return fmt::format("camera {} would not see the {} in the target configuration{}",
                         model.cameras[stance.camera].name, config_.etalon ? "cylinder" : "arm", why);
  return std::nullopt;
}

bool RigSessionPlan::is_in_view(const RigModel& model, const RigStance& stance, const ArmState& shown) const {
  const View view = view_of(model, stance);
  if (config_.etalon) return EtalonFigure(*config_.etalon).expected(view, 0).has_value();
  const MarkerScene scene =
      expected_markers(model.arm, model.bent(shown), config_.picture.markers, view, nominal_.arm);
  return markers_inside(scene, view, 0) >= config_.fewest;
}

std::vector<Eigen::Vector2d> RigSessionPlan::search_directions() const {
  std::vector<Eigen::Vector2d> ways;
  for (const double size : {0.5, 1.0}) {
    for (const auto& [pan, tilt] :
         {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}})
      ways.emplace_back(size * config_.search * Eigen::Vector2d(pan, tilt));
  }
  return ways;
}

}  // namespace flexura
