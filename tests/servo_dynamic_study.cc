// Servos an arm that swings, sags and rubs, with a wrong model of it, and prints the accuracy:
// servo_dynamic_study [TARGETS] [SEED] [THREADS] [PART] [WAY]. PART: calibrated or wrong. WAY: the name of a
// row. See docs/studies/servo-dynamic.md.
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/servo/servo_session.h"
#include "tests/support/calibration_bench.h"
#include "tests/support/servo_worlds.h"
#include "tests/support/study_rows.h"
#include "tests/support/swinging_bench.h"

namespace flexura {
namespace {

constexpr std::size_t targets_a_rig = 4;
constexpr double rough = 0.3;  // Size of the camera errors before `bundle`, as in servo_study.

// A servo method under study.
struct Method {
  std::string name;
  ServoLawKind law = ServoLawKind::shape;
  ServoJacobian jacobian = ServoJacobian::model;
  double rate = 4;
  std::string model = "dynamic";
};

std::vector<Method> methods() {
  return {{.name = "predictive", .law = ServoLawKind::predictive},
          {.name = "shape"},
          {.name = "points", .law = ServoLawKind::points},
          {.name = "shape, without swing in the model", .model = "static"},
          {.name = "points, without swing in the model", .law = ServoLawKind::points, .model = "static"},
          {.name = "shape, recursive", .jacobian = ServoJacobian::recursive}};
}

// The true arm of a target: 20 % stiffer or softer, with up to 40 g at its tip.
SwingingWorld random_world(TestRandom& random, double friction) {
  return {.stiffness = random.uniform(-1, 1) < 0 ? 0.8 : 1.2,
          .friction = friction,
          .payload = random.uniform(0, 0.04)};
}

// Errors of half a degree about each axis, and of 1 % of the focal length in the model, of random sign.
std::array<WrongStart, 2> half_a_degree(TestRandom& random) {
  std::array<WrongStart, 2> wrong;
  const auto either = [&](double size) { return random.uniform(-1, 1) < 0 ? -size : size; };
  for (WrongStart& one : wrong)
    one.pan = either(0.5 * degree), one.tilt = either(0.5 * degree), one.roll = either(0.5 * degree);
  return wrong;
}

// Results of one run.
struct Run {
  Arrival arrival;
  MotionTotals totals;
  bool is_run = false;
  std::vector<std::string> reports;  // Events of the servo.
};

class StudyRig {
 public:
  StudyRig(bool is_calibrated, double friction, std::uint64_t seed)
      : random_(seed),
        world_(random_world(random_, friction)),
        file_(study_rig(is_calibrated ? std::array{wrong_start(random_, rough), wrong_start(random_, rough)}
                                      : half_a_degree(random_))),
        gray_(swinging_world_file(file_, false, world_)) {
    nominal_ = rig_model(gray_.experiment().arm_model(), gray_.experiment().cameras());
    SwingingWorld still = world_;
    still.model = "static";
    static_ = parse_experiment(swinging_world_file(file_, false, still), "x.toml").arm_model();
    if (!is_calibrated) {
      for (CameraConfig& camera : nominal_.cameras)
        camera.lens.fx *= random_.uniform(-1, 1) < 0 ? 0.99 : 1.01;
      return;
    }
    CalibrationBench colored(swinging_world_file(file_, true, world_));
    const RigSessionResult result = colored.calibrate_bundle(colored.ports());
    if (!result.is_done) why_not_ = "not calibrated, " + result.reason;
    if (!why_not_.empty()) return;
    nominal_.cameras = result.found.model.cameras;
    for (std::size_t i = 0; i < 2; ++i) {
      const CameraPorts found = colored.ports().cameras[i], other = gray_.ports().cameras[i];
      (void)other.head->command(found.head->read().value().state).value();
      (void)other.stage->command(found.stage->read().value().state).value();
    }
    wait(30);
  }

  // Returns why there is no rig to servo; empty if there is one.
  [[nodiscard]] const std::string& why_not() const { return why_not_; }

  // Servos from rest in the straight shape to the shape that the true arm has at this command.
  Run go(const Method& method, const ArmState& command) {
    const ArmModel truth = true_arm(gray_.experiment());
    const ArmState target = truth.actuation().shape(command);
    ServoConfig config;
    config.law = method.law, config.jacobian = method.jacobian, config.rate = method.rate;
    config.step = 1.0 / 30, config.tolerance = 0.002, config.settle = 1, config.timeout = 8;
    config.goals = {{0, target}};
    (void)gray_.ports().arm->command(ArmState::straight(3), 3).value();
    wait(6);
    TruthWatcher watcher(gray_, nominal_.driven, config);
    RigModel nominal = nominal_;
    if (method.model == "static") nominal.actuation = static_->actuation();
    const ServoResult result = servo_in_session(gray_.ports(), nominal, config, watcher);
    Run run;
    run.totals = watcher.totals(), run.is_run = true, run.reports = watcher.reports();
    Arrival& arrival = run.arrival;
    arrival.is_done = result.is_done, arrival.reason = result.reason;
    arrival.settled = result.settled.value_or(std::nan("")), arrival.overshoot = result.overshoot;
    const double now = gray_.rig().clock().now();
    const ServoError left = servo_error(gray_.rig().arm().backbone(now), truth.backbone_of_shape(target),
                                        truth.shaped().length());
    arrival.rms = left.rms, arrival.most = left.most, arrival.tip = left.tip;
    return run;
  }

 private:
  void wait(double seconds) {
    ClockPort& clock = gray_.rig().clock();
    clock.wait_until(clock.now() + seconds);
  }
  // Returns the true arm at rest as the chain of arcs nearest to it.
  static ArmModel true_arm(const Experiment& experiment) {
    Setup truth = experiment;
    const RigConfig rig = experiment.true_rig();
    truth.arm = rig.arm, truth.drive = rig.drive;
    return truth.arm_model();
  }

  TestRandom random_;
  SwingingWorld world_;
  LoopRig file_;
  RigBench gray_;
  RigModel nominal_;
  std::optional<ArmModel> static_;  // The same arm without swing.
  std::string why_not_;
};

ArmState random_command(TestRandom& random) {
  ArmState state = ArmState::straight(3);
  for (Eigen::Vector2d& bend : state.bends) bend = random.vector<2>(-1.2, 1.2);
  return state;
}

void print_rows(const std::vector<Method>& ways, const std::vector<std::vector<Run>>& runs) {
  fmt::print(
      "| law | converged | to 2 %, s (median / 95 %) | overshoot, % (95 %) | left, rms, % (median / 95 %) | "
      "left of all, rms, % (median / 95 %) | energy, J (median) | tension, N (largest) | violations: bend / "
      "rate / view "
      "/ "
      "contact |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  for (std::size_t j = 0; j < ways.size(); ++j) {
    std::vector<double> settled, overshoot, rms, all, energy, tension;
    std::array<int, 4> violations = {};
    for (const auto& [arrival, totals, is_run] : runs[j]) {
      violations[0] += totals.bend_violations, violations[1] += totals.rate_violations;
      violations[2] += totals.view_violations, violations[3] += totals.contacts;
      if (is_run) all.push_back(100 * arrival.rms);
      if (!arrival.is_done) continue;
      settled.push_back(arrival.settled), overshoot.push_back(100 * std::max(0.0, arrival.overshoot));
      rms.push_back(100 * arrival.rms);
      energy.push_back(totals.energy), tension.push_back(totals.most_tension);
    }
    fmt::print("| {} | {}/{} | {} / {} | {} | {} / {} | {} / {} | {} | {} | {} / {} / {} / {} |\n",
               ways[j].name, rms.size(), runs[j].size(), number(quantile(settled, 0.5), 2),
               number(quantile(settled, 0.95), 2), number(quantile(overshoot, 0.95), 1),
               number(quantile(rms, 0.5), 3), number(quantile(rms, 0.95), 3), number(quantile(all, 0.5), 3),
               number(quantile(all, 0.95), 3), number(quantile(energy, 0.5), 2),
               number(quantile(tension, 1), 0), violations[0], violations[1], violations[2], violations[3]);
  }
  fmt::print("\n");
  for (std::size_t j = 0; j < ways.size(); ++j) {
    std::vector<Arrival> arrivals;
    for (const Run& run : runs[j]) arrivals.push_back(run.arrival);
    print_reasons(ways[j].name, arrivals);
  }
  fmt::print("\n");
}

void study(bool is_calibrated, double friction, const std::string& way, std::size_t targets,
           std::uint64_t seed, unsigned threads) {
  std::vector<Method> ways = methods();
  if (!way.empty()) std::erase_if(ways, [&](const Method& method) { return method.name != way; });
  const std::size_t rigs = (targets + targets_a_rig - 1) / targets_a_rig;
  std::vector<std::vector<Run>> runs(ways.size(), std::vector<Run>(targets));
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < rigs; i = next++) {
      StudyRig rig(is_calibrated, friction, seed + i);
      for (std::size_t k = i * targets_a_rig; k < std::min(targets, (i + 1) * targets_a_rig); ++k) {
        TestRandom random(1000 * seed + k);
        const ArmState command = random_command(random);
        for (std::size_t j = 0; j < ways.size(); ++j) {
          Run& run = runs[j][k];
          if (rig.why_not().empty())
            run = rig.go(ways[j], command);
          else
            run.arrival.reason = rig.why_not();
          std::fprintf(stderr, "target %zu, %s: %s, settled %.2f s, left %.3f %%\n", k, ways[j].name.c_str(),
                       run.arrival.reason.c_str(), run.arrival.settled, 100 * run.arrival.rms);
          for (const std::string& report : run.reports) std::fprintf(stderr, "  %s\n", report.c_str());
        }
      }
    }
  };
  std::vector<std::thread> pool;
  pool.reserve(threads);
  for (unsigned i = 0; i < threads; ++i) pool.emplace_back(work);
  for (std::thread& one : pool) one.join();
  print_rows(ways, runs);
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
  const double friction = count > 6 ? std::strtod(arguments[6], nullptr) : 0.02;
  const auto is_asked = [&](const char* name) { return part.empty() || part == name; };
  if (is_asked("calibrated")) {
    fmt::print("## Cameras as the calibration `bundle` leaves them\n\n");
    study(true, friction, way, targets, seed, threads);
  }
  if (is_asked("wrong")) {
    fmt::print("## Cameras half a degree (about each axis) and 1 % (of focal length) wrong\n\n");
    study(false, friction, way, targets, seed, threads);
  }
  return 0;
}
