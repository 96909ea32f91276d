// Servos a simulated arm to random shapes by each law, including rendering and image processing, and prints
// the accuracy: servo_study [TARGETS] [SEED] [THREADS] [PART] [WAY]. PART: calibrated, wrong, recorded,
// turned, sagging or exact. WAY: a servo method, by the name of its row. See docs/studies/servo.md.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/camera/view.h"
#include "flexura/servo/servo_session.h"
#include "flexura/tasks/servo/servo_run.h"
#include "tests/support/calibration_bench.h"
#include "tests/support/exact_loops.h"
#include "tests/support/loop_files.h"
#include "tests/support/servo_bench.h"
#include "tests/support/servo_worlds.h"
#include "tests/support/study_pool.h"
#include "tests/support/study_rows.h"

namespace flexura {
namespace {

constexpr std::size_t targets_a_rig = 4;
// Size of the initial camera errors, as a share of those that the paper's methods start from. At the full
// size many arms do not fit into the pictures.
constexpr double rough = 0.3;

enum class Cameras { calibrated, wrong, recorded };

// A servo method under study.
struct Method {
  std::string name;
  ServoLawKind law = ServoLawKind::shape;
  ServoJacobian jacobian = ServoJacobian::model;
  bool has_bands = false;  // Colour pictures of an arm with bands.
  bool is_near = false;    // Start within 0.15 rad of each target bend.
  bool is_turned = false;  // Drives mounted a quarter turn round, with 1.3 times the bend.
};

std::vector<Method> laws() {
  return {{.name = "shape"},
          {.name = "points", .law = ServoLawKind::points},
          {.name = "chords", .law = ServoLawKind::chords},
          {.name = "potential", .law = ServoLawKind::potential},
          {.name = "silhouettes", .law = ServoLawKind::silhouettes},
          {.name = "moments, starts within 0.15 rad", .law = ServoLawKind::moments, .is_near = true}};
}

std::vector<Method> all_methods() {
  std::vector<Method> methods = laws();
  methods.push_back(
      {.name = "points, broyden", .law = ServoLawKind::points, .jacobian = ServoJacobian::broyden});
  methods.push_back(
      {.name = "points, recursive", .law = ServoLawKind::points, .jacobian = ServoJacobian::recursive});
  methods.push_back({.name = "shape, with bands", .has_bands = true});
  return methods;
}

// Returns the methods for the turned arm, with the model Jacobian and with learned ones.
std::vector<Method> methods_of_turned_arm() {
  std::vector<Method> methods;
  for (const ServoLawKind law : {ServoLawKind::shape, ServoLawKind::points, ServoLawKind::potential}) {
    const auto kind = static_cast<std::size_t>(law);
    for (const ServoJacobian learned :
         {ServoJacobian::model, ServoJacobian::broyden, ServoJacobian::recursive})
      methods.push_back(
          {.name = names_of(&law)[kind] + ", " + names_of(&learned)[static_cast<std::size_t>(learned)],
           .law = law,
           .jacobian = learned,
           .is_turned = true});
  }
  return methods;
}

std::vector<Method> laws_of_sagging_arm() {
  return {{.name = "shape"},
          {.name = "points", .law = ServoLawKind::points},
          {.name = "shape, broyden", .jacobian = ServoJacobian::broyden}};
}

ArmState random_target(TestRandom& random) {
  ArmState state = ArmState::straight(3);
  for (Eigen::Vector2d& bend : state.bends) bend = random.vector<2>(-1.2, 1.2);
  return state;
}

ArmState start_for(const Method& method, const ArmState& target, TestRandom& random) {
  ArmState start = method.is_near ? target : ArmState::straight(target.bends.size());
  for (Eigen::Vector2d& bend : start.bends)
    if (method.is_near) bend += random.vector<2>(-0.15, 0.15);
  return start;
}

// Returns errors of 0.5 degrees about each axis, of random sign.
std::array<WrongStart, 2> half_a_degree(TestRandom& random) {
  std::array<WrongStart, 2> wrong;
  constexpr double half = 0.5 * degree;
  const auto either = [&](double size) { return random.uniform(-1, 1) < 0 ? -size : size; };
  for (WrongStart& one : wrong) one.pan = either(half), one.tilt = either(half), one.roll = either(half);
  return wrong;
}

// Returns the servo error that wrong cameras leave at best. The arm is moved until an estimator with the
// camera models `nominal` and the camera prior `view_prior` measures the target shape. It gets exact images
// by the true cameras.
double floor_of(const Arm& arm, const ArmState& desired, const std::array<View, 2>& truth,
                const std::array<View, 2>& nominal, const ViewPrior& view_prior) {
  ShapePrior prior;
  prior.arm = arm;
  EstimatorConfig config;
  config.most_rms = 1000;
  ShapeEstimator estimator(prior, config);
  ArmState state = desired;
  for (int turn = 0; turn < 30; ++turn) {
    std::vector<Observation> seen(2);
    const Backbone backbone(arm, state);
    for (std::size_t i = 0; i < 2; ++i) {
      seen[i].view = nominal[i], seen[i].view_prior = view_prior;
      constexpr int count = 80;
      for (int k = 0; k <= count; ++k) {
        const auto pixel = truth[i].project(backbone.pose(backbone.length() * k / count).position);
        if (pixel) seen[i].points.push_back({*pixel, 0.1});
      }
      for (const std::size_t end : {std::size_t{0}, std::size_t{1}})
        if (const auto pixel =
                truth[i].project(backbone.pose(static_cast<double>(end) * backbone.length()).position))
          seen[i].ends[end] = SeenEnd{*pixel, 0.1};
    }
    const ShapeEstimate estimate = estimator.follow(seen, {arm, desired});
    if (!estimate.is_found) return std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < state.bends.size(); ++i)
      state.bends[i] += desired.bends[i] - estimate.shape.state.bends[i];
  }
  return servo_error(arm, state, desired).rms;
}

// Returns the smallest margin of the commanded bends to their limits, as a share of the limit.
double nearest_limit(const Arm& arm, const ServoResult& result) {
  double nearest = 1;
  for (const ServoStep& step : result.steps)
    for (std::size_t i = 0; i < step.sent.bends.size(); ++i)
      nearest = std::min(nearest, 1 - step.sent.bends[i].norm() / arm.sections[i].max_bend);
  return nearest;
}

// The rig of one group of targets, calibrated if required, both with coloured bands and in gray.
class StudyRig {
 public:
  StudyRig(Cameras cameras, const ServoWorld& world, std::uint64_t seed)
      : random_(seed),
        cameras_(cameras),
        file_(study_rig(wrong(cameras))),
        colored_(servo_world_file(file_, true, world)),
        gray_(servo_world_file(file_, false, world)) {
    nominal_ = rig_model(gray_.experiment().arm_model(), gray_.experiment().cameras());
    if (cameras == Cameras::wrong || cameras == Cameras::recorded) {
      // In addition, the model's focal lengths are wrong by 1 %.
      for (CameraConfig& camera : nominal_.cameras)
        camera.lens.fx *= random_.uniform(-1, 1) < 0 ? 0.99 : 1.01;
      return;
    }
    const RigSessionResult result = colored_.calibrate_bundle(colored_.ports());
    if (!result.is_done) why_not_ = "not calibrated, " + result.reason;
    if (!why_not_.empty()) return;
    nominal_ = result.found.model;
    for (std::size_t i = 0; i < 2; ++i) {
      const CameraPorts found = colored_.ports().cameras[i], other = gray_.ports().cameras[i];
      (void)other.head->command(found.head->read().value().state).value();
      (void)other.stage->command(found.stage->read().value().state).value();
    }
    constexpr double patience = 30;  // s, simulated
    gray_.rig().clock().wait_until(gray_.rig().clock().now() + patience);
  }

  // Returns why there is no rig to servo; empty if there is one.
  [[nodiscard]] const std::string& why_not() const { return why_not_; }

  Arrival go(const Method& method, const ArmState& target, TestRandom& random) {
    RigBench& bench = method.has_bands ? static_cast<RigBench&>(colored_) : gray_;
    ServoConfig config;
    config.law = method.law, config.jacobian = method.jacobian;
    config.step = 1.0 / 30, config.tolerance = 0.002, config.settle = 1, config.timeout = 8;
    const Arm arm = bench.experiment().arm.arm();
    config.markers = band_places(bench.experiment(), nominal_.arm);
    // The target is a shape made of arcs, whatever actuation the model assumes.
    config.goals = {{0, Actuation(nominal_.driven.sections.empty() ? arm : nominal_.driven).shape(target)}};
    if (cameras_ == Cameras::recorded) config.goals = {{0, pictures_of(bench, target)}};
    rest_at(bench, start_for(method, target, random));
    ServoNotes notes;
    RigPorts ports = bench.ports();
    TurnedArm turned(*ports.arm, std::numbers::pi / 2, 1.3);
    if (method.is_turned) ports.arm = &turned;
    const ServoResult result = servo_in_session(ports, nominal_, config, notes);
    Arrival arrival;
    arrival.is_done = result.is_done, arrival.reason = result.reason;
    arrival.settled = result.settled.value_or(0), arrival.overshoot = result.overshoot;
    const ServoError left = servo_error(bench.rig().arm().backbone(bench.rig().clock().now()),
                                        Backbone(arm, target), arm.length());
    arrival.rms = left.rms, arrival.most = left.most, arrival.tip = left.tip;
    arrival.limit = nearest_limit(arm, result);
    if (cameras_ == Cameras::wrong) {
      const auto truth = true_views(bench), nominal = nominal_views(bench);
      arrival.without_prior = floor_of(arm, target, truth, nominal, {});
      arrival.with_prior = floor_of(arm, target, truth, nominal, config.camera_prior);
    }
    return arrival;
  }

 private:
  std::array<WrongStart, 2> wrong(Cameras cameras) {
    if (cameras == Cameras::calibrated) return {wrong_start(random_, rough), wrong_start(random_, rough)};
    return half_a_degree(random_);
  }
  static void rest_at(RigBench& bench, const ArmState& state) {
    (void)bench.ports().arm->command(state, 3).value();
    bench.rig().clock().wait_until(bench.rig().clock().now() + 4);
  }
  static RecordedViews pictures_of(RigBench& bench, const ArmState& target) {
    rest_at(bench, target);
    RecordedViews views;
    for (std::size_t i = 0; i < 2; ++i) {
      (void)bench.ports().cameras[i].camera->newest();
      views[i] = *bench.ports().cameras[i].camera->wait(1).value()->picture;
    }
    return views;
  }
  static std::array<View, 2> true_views(RigBench& bench) {
    const double now = bench.rig().clock().now();
    return {bench.rig().camera(0).view(now), bench.rig().camera(1).view(now)};
  }
  std::array<View, 2> nominal_views(RigBench& bench) {
    std::array<View, 2> views;
    for (std::size_t i = 0; i < 2; ++i) {
      const CameraPorts camera = bench.ports().cameras[i];
      views[i] = view_of(nominal_, {.camera = i,
                                    .head = camera.head->read().value().state,
                                    .stage = camera.stage->read().value().state});
    }
    return views;
  }

  TestRandom random_;
  Cameras cameras_;
  LoopRig file_;
  CalibrationBench colored_;
  RigBench gray_;
  RigModel nominal_;
  std::string why_not_;
};

void study(Cameras cameras, const ServoWorld& world, std::vector<Method> methods, const std::string& way,
           std::size_t targets, std::uint64_t seed, unsigned threads) {
  if (!way.empty()) std::erase_if(methods, [&](const Method& method) { return method.name != way; });
  const std::size_t rigs = (targets + targets_a_rig - 1) / targets_a_rig;
  std::vector<std::vector<Arrival>> arrivals(methods.size(), std::vector<Arrival>(targets));
  for_each_parallel(rigs, threads, [&](std::size_t i) {
    StudyRig rig(cameras, world, seed + i);
    for (std::size_t k = i * targets_a_rig; k < std::min(targets, (i + 1) * targets_a_rig); ++k) {
      TestRandom random(1000 * seed + k);
      const ArmState target = random_target(random);
      for (std::size_t j = 0; j < methods.size(); ++j) {
        Arrival& arrival = arrivals[j][k];
        arrival =
            rig.why_not().empty() ? rig.go(methods[j], target, random) : Arrival{.reason = rig.why_not()};
        if (!arrival.is_done)
          std::fprintf(stderr, "target %zu, %s: %s\n", k, methods[j].name.c_str(), arrival.reason.c_str());
      }
    }
    std::fprintf(stderr, "rig %zu of %zu\n", i + 1, rigs);
  });
  fmt::print(
      "| law | converged | time to 2 % error, s (median / 95 %) | overshoot, % (95 %) | final RMS error, % "
      "(median / 95 %) | largest final error along the arm, % | final tip error, % (95 %) | distance to a "
      "limit | error with exact target pictures, without prior, % (median / 95 %) | with camera prior, % "
      "(median / 95 %) |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  for (std::size_t j = 0; j < methods.size(); ++j)
    print_row(methods[j].name, arrivals[j], cameras == Cameras::wrong);
  fmt::print("\n");
  for (std::size_t j = 0; j < methods.size(); ++j) print_reasons(methods[j].name, arrivals[j]);
  fmt::print("\n");
}

// Servos to the same targets without pictures, with secant derivatives over the whole way and with local
// ones.
void study_exact(const std::string& way, std::size_t targets, std::uint64_t seed) {
  RigBench bench(servo_world_file(study_rig({}), false));
  ExactLoop loop{.arm = bench.experiment().arm.arm(),
                 .views = {bench.rig().camera(0).view(0), bench.rig().camera(1).view(0)}};
  constexpr double noise = 0.1;  // px
  fmt::print(
      "| law | derivatives | converged | time to 2 % error, s (median / 95 % / all) | with noise: converged "
      "| with noise: time to 2 % error, s |\n| --- | --- | ---: | ---: | ---: | ---: |\n");
  for (const Method& method : laws()) {
    if (!way.empty() && method.name != way) continue;
    std::vector<std::pair<ArmState, ArmState>> ways;
    for (std::size_t k = 0; k < targets; ++k) {
      TestRandom random(1000 * seed + k);
      const ArmState target = random_target(random);
      ways.emplace_back(start_for(method, target, random), target);
    }
    const bool has_both = method.law != ServoLawKind::shape && method.law != ServoLawKind::potential;
    for (const bool has_secants : {true, false}) {
      if (!has_secants && !has_both) continue;
      loop.has_secants = has_secants;
      const char* which = has_secants && has_both ? "half-way to the target" : "at the current shape";
      fmt::print("{}\n", exact_row(loop, method.law, method.name + " | " + which, ways, noise));
    }
  }
  fmt::print("\n");
}

}  // namespace
}  // namespace flexura

int main(int count, char** arguments) {
  using namespace flexura;
  const std::size_t targets = count > 1 ? std::strtoull(arguments[1], nullptr, 10) : 200;
  const std::uint64_t seed = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1;
  const auto threads = static_cast<unsigned>(count > 3 ? std::strtoul(arguments[3], nullptr, 10) : 2);
  const std::string part = count > 4 ? arguments[4] : "";
  const std::string way = count > 5 ? arguments[5] : "";
  const auto is_asked = [&](const char* name) { return part.empty() || part == name; };
  if (is_asked("calibrated")) {
    fmt::print("## Cameras calibrated by `bundle`\n\n");
    study(Cameras::calibrated, {}, all_methods(), way, targets, seed, threads);
  }
  if (is_asked("wrong")) {
    fmt::print("## Camera errors of half a degree about each axis and 1 % of the focal length\n\n");
    study(Cameras::wrong, {}, all_methods(), way, targets, seed, threads);
  }
  if (is_asked("recorded")) {
    fmt::print("## Target pictures recorded by cameras with these errors\n\n");
    study(Cameras::recorded, {}, laws(), way, targets, seed, threads);
  }
  if (is_asked("turned")) {
    fmt::print("## Calibrated cameras, arm rotated by a quarter turn with 1.3 times the commanded bends\n\n");
    study(Cameras::calibrated, {}, methods_of_turned_arm(), way, targets, seed, threads);
  }
  if (is_asked("sagging")) {
    fmt::print("## Sagging arm, model of one arc per section, camera errors of half a degree and 1 %\n\n");
    study(Cameras::wrong, {.sags = true}, laws_of_sagging_arm(), way, targets, seed, threads);
    fmt::print("## Sagging arm, model of three arcs per section, calibrated cameras and bend profile\n\n");
    study(Cameras::calibrated, {.arcs = 3, .sags = true}, laws_of_sagging_arm(), way, targets, seed, threads);
    fmt::print("## Sagging arm, model of rods that are 20 % stiffer, calibrated cameras\n\n");
    study(Cameras::calibrated, {.arcs = 3, .sags = true, .knows = true}, laws_of_sagging_arm(), way, targets,
          seed, threads);
  }
  if (is_asked("exact")) study_exact(way, targets, seed);
  return 0;
}
