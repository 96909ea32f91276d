// Servos an arm that swings, sags and rubs, with a wrong model of it, and prints the accuracy:
// servo_dynamic_study [TARGETS] [TRAJECTORIES] [SEED] [THREADS] [PART] [LAW] [RUNS]. PART: calibrated or
// wrong. LAW: the name of a row. RUNS: a file of runs, which are not repeated. "" stands for all parts, all
// laws, or no file. See docs/studies/servo-dynamic.md.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/servo/servo_session.h"
#include "tests/support/calibration_bench.h"
#include "tests/support/servo_worlds.h"
#include "tests/support/study_pool.h"
#include "tests/support/swinging_bench.h"
#include "tests/support/swinging_runs.h"

namespace flexura {
namespace {

constexpr std::size_t rigs = 10;  // Targets and trajectories are dealt out to rigs.
constexpr double rough = 0.3;     // Size of the camera errors before `bundle`, as in examples/20_servo_study.
constexpr double trajectory_time = 6;  // s
constexpr double push = 0.5;           // At the tip, N.

// A servo method under study.
struct Method {
  std::string name;
  ServoLawKind law = ServoLawKind::shape;
  ServoJacobian jacobian = ServoJacobian::model;
  std::string model = "dynamic";
};

std::vector<Method> methods() {
  return {{.name = "predictive", .law = ServoLawKind::predictive},
          {.name = "computed torque", .law = ServoLawKind::computed_torque},
          {.name = "shape potential", .law = ServoLawKind::shape_potential},
          {.name = "shape"},
          {.name = "points", .law = ServoLawKind::points},
          {.name = "image potential", .law = ServoLawKind::potential},
          {.name = "shape, recursive", .jacobian = ServoJacobian::recursive},
          {.name = "points, broyden", .law = ServoLawKind::points, .jacobian = ServoJacobian::broyden},
          {.name = "shape, without swing in the model", .model = "static"},
          {.name = "points, without swing in the model", .law = ServoLawKind::points, .model = "static"}};
}

// The true arm of a rig: 20 % stiffer or softer, with up to 40 g at its tip.
SwingingWorld random_world(TestRandom& random) {
  return {.stiffness = random.uniform(-1, 1) < 0 ? 0.8 : 1.2, .payload = random.uniform(0, 0.04)};
}

// Errors of half a degree about each axis, and of 1 % of the focal length in the model, of random sign.
std::array<WrongStart, 2> half_a_degree(TestRandom& random) {
  std::array<WrongStart, 2> wrong;
  const auto either = [&](double size) { return random.uniform(-1, 1) < 0 ? -size : size; };
  for (WrongStart& one : wrong)
    one.pan = either(0.5 * degree), one.tilt = either(0.5 * degree), one.roll = either(0.5 * degree);
  return wrong;
}

// What an arm is servoed to.
struct Wanted {
  std::vector<ArmState> commands;  // Whose true shapes at rest are the target, `interval` s apart.
  double interval = 0.1;
  std::optional<double> pushed_at;  // s after the servo's start.
  Eigen::Vector3d push = Eigen::Vector3d::Zero();
};

class StudyRig {
 public:
  StudyRig(bool is_calibrated, std::uint64_t seed)
      : random_(seed),
        world_(random_world(random_)),
        file_(study_rig(is_calibrated ? std::array{wrong_start(random_, rough), wrong_start(random_, rough)}
                                      : half_a_degree(random_))),
        text_(swinging_world_file(file_, false, world_)) {
    const Experiment gray = parse_experiment(text_, "x.toml");
    nominal_ = rig_model(gray.arm_model(), gray.cameras());
    truth_.emplace(true_arm(gray));
    SwingingWorld still = world_;
    still.model = "static";
    static_.emplace(parse_experiment(swinging_world_file(file_, false, still), "x.toml").arm_model());
    if (is_calibrated) {
      calibrate();
    } else {
      for (CameraConfig& camera : nominal_.cameras)
        camera.lens.fx *= random_.uniform(-1, 1) < 0 ? 0.99 : 1.01;
    }
  }

  // Servos a new rig from rest in the straight shape.
  SwingingRun go(const Method& method, const Wanted& wanted) const {
    SwingingRun run;
    run.arrival.reason = why_not_;
    if (!why_not_.empty()) return run;
    RigBench bench(text_);
    aim(bench);
    ServoConfig config;
    config.law = method.law, config.jacobian = method.jacobian;
    config.step = 1.0 / 30, config.tolerance = 0.002, config.settle = 1, config.timeout = 5;
    for (std::size_t k = 0; k < wanted.commands.size(); ++k)
      config.goals.push_back(
          {static_cast<double>(k) * wanted.interval, truth_->actuation().shape(wanted.commands[k])});
    RigModel nominal = nominal_;
    if (method.model == "static") nominal.actuation = static_->actuation();
    TruthWatcher watcher(bench, nominal_.driven, config);
    const double start = bench.rig().clock().now();
    if (wanted.pushed_at)
      watcher.push_tip(wanted.push, start + *wanted.pushed_at, start + *wanted.pushed_at + 0.1);
    const ServoResult result = servo_in_session(bench.ports(), nominal, config, watcher);
    run.totals = watcher.totals();
    Arrival& arrival = run.arrival;
    arrival.is_done = result.is_done, arrival.reason = result.reason;
    arrival.settled = result.settled.value_or(std::nan("")), arrival.overshoot = result.overshoot;
    const Goals goals(*truth_, config);
    const double end = watcher.samples().empty() ? start : watcher.samples().back().time;
    if (wanted.commands.size() == 1) {
      arrival.rms = goals.distance(watcher.samples(), start, end - 1, 0);
    } else {
      // Where a servo ended early, the rest of the time counts with the arm as it was.
      arrival.rms = goals.distance(watcher.samples(), start, start, 0);
      run.tracked = arrival.rms;
      for (double lag = 0; lag <= 0.6; lag += 1.0 / 60)
        if (const double off = goals.distance(watcher.samples(), start, start, lag); off <= run.tracked)
          run.tracked = off, run.lag = lag;
    }
    for (const std::string& report : watcher.reports()) std::fprintf(stderr, "  %s\n", report.c_str());
    return run;
  }

 private:
  // Points along the target shapes over time.
  class Goals {
   public:
    Goals(const ArmModel& truth, const ServoConfig& config) : length_(truth.shaped().length()) {
      for (const ServoGoal& goal : config.goals) {
        times_.push_back(goal.time);
        points_.push_back(TruthWatcher::points_of(truth.backbone_of_shape(std::get<ArmState>(goal.shape))));
      }
    }
    // Returns the distance of the arm's samples since `from` from the target `lag` earlier, root mean square
    // over arm and time, share of the length.
    [[nodiscard]] double distance(const std::vector<TruthWatcher::Sample>& samples, double start, double from,
                                  double lag) const {
      double sum = 0, count = 0;
      const auto add = [&](double time, const Eigen::Matrix3Xd& points) {
        if (time < from || (times_.size() > 1 && time > start + times_.back() + lag)) return;
        sum += (points - at(time - start - lag)).squaredNorm();
        count += static_cast<double>(points.cols());
      };
      for (const TruthWatcher::Sample& sample : samples) add(sample.time, sample.points);
      if (times_.size() > 1 && !samples.empty())
        for (double time = samples.back().time + 1.0 / 30; time <= start + times_.back() + lag;
             time += 1.0 / 30)
          add(time, samples.back().points);
      return std::sqrt(sum / count) / length_;
    }

   private:
    [[nodiscard]] Eigen::Matrix3Xd at(double time) const {
      std::size_t k = 0;
      while (k + 1 < times_.size() && times_[k + 1] <= time) ++k;
      if (k + 1 == times_.size() || time <= times_[k]) return points_[k];
      const double share = (time - times_[k]) / (times_[k + 1] - times_[k]);
      return (1 - share) * points_[k] + share * points_[k + 1];
    }
    double length_;
    std::vector<double> times_;
    std::vector<Eigen::Matrix3Xd> points_;
  };

  void calibrate() {
    CalibrationBench colored(swinging_world_file(file_, true, world_));
    NobodyWatches nobody;
    const RigSessionResult result = colored.calibrate_bundle(
        colored.ports(), rig_model(colored.experiment().arm_model(), colored.experiment().cameras()), nobody);
    if (!result.is_done) {
      why_not_ = "not calibrated, " + result.reason;
      return;
    }
    nominal_.cameras = result.found.model.cameras;
    for (std::size_t i = 0; i < 2; ++i)
      stances_[i] = {i, colored.ports().cameras[i].head->read().value().state,
                     colored.ports().cameras[i].stage->read().value().state};
    has_stances_ = true;
  }
  // Moves the cameras to where the calibration left them.
  void aim(RigBench& bench) const {
    if (!has_stances_) return;
    for (std::size_t i = 0; i < 2; ++i) {
      (void)bench.ports().cameras[i].head->command(stances_[i].head).value();
      (void)bench.ports().cameras[i].stage->command(stances_[i].stage).value();
    }
    ClockPort& clock = bench.rig().clock();
    clock.wait_until(clock.now() + 30);
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
  std::string text_;
  RigModel nominal_;
  std::optional<ArmModel> truth_, static_;  // The true arm at rest; the model without swing.
  std::array<RigStance, 2> stances_;
  bool has_stances_ = false;
  std::string why_not_;
};

// A shape within +-1.2 rad in each direction. The tip is pushed on the way.
Wanted random_target(TestRandom& random) {
  ArmState state = ArmState::straight(3);
  for (Eigen::Vector2d& bend : state.bends) bend = random.vector<2>(-1.2, 1.2);
  return {.commands = {state},
          .interval = 0.1,
          .pushed_at = random.uniform(0.3, 0.8),
          .push = push * random.vector<3>(-1, 1).normalized()};
}

// Two sine waves in each direction, which begin slowly at the straight shape.
Wanted random_trajectory(TestRandom& random) {
  Wanted wanted;
  struct Wave {
    double amplitude, rate, phase;
  };
  std::array<std::array<Wave, 2>, 6> waves;
  for (auto& pair : waves)
    for (Wave& wave : pair)
      wave = {random.uniform(-0.5, 0.5), random.uniform(0.5, 2), random.uniform(0, 2 * std::numbers::pi)};
  for (double time = 0; time <= trajectory_time + 1e-9; time += wanted.interval) {
    ArmState state = ArmState::straight(3);
    const double share = std::min(1.0, time / 2), begun = share * share * (3 - 2 * share);
    for (std::size_t i = 0; i < 6; ++i)
      for (const Wave& wave : waves[i])
        state.bends[i / 2][static_cast<Eigen::Index>(i % 2)] +=
            begun * wave.amplitude * std::sin(wave.rate * time + wave.phase);
    wanted.commands.push_back(state);
  }
  return wanted;
}

struct Extent {
  std::size_t targets = 0, trajectories = 0;
  std::uint64_t seed = 1;
  unsigned threads = 1;
};

void study(bool is_calibrated, const Extent& extent, const std::string& law, SwingingRuns& runs) {
  const std::string part = fmt::format("{}, seed {}", is_calibrated ? "calibrated" : "wrong", extent.seed);
  std::vector<Method> ways = methods();
  if (!law.empty()) std::erase_if(ways, [&](const Method& method) { return method.name != law; });
  for_each_parallel(rigs, extent.threads, [&](std::size_t i) {
    std::unique_ptr<StudyRig> rig;
    const auto servo = [&](const std::string& kind, std::size_t k, const Wanted& wanted) {
      for (const Method& method : ways) {
        const SwingingRunKey key{part, kind, method.name, k};
        if (runs.has(key)) continue;
        if (!rig) rig = std::make_unique<StudyRig>(is_calibrated, extent.seed + i);
        const SwingingRun run = rig->go(method, wanted);
        runs.add(key, run);
        std::fprintf(stderr, "%s, %s %zu, %s: %s, settled %.2f s, left %.3f %%, lag %.2f s\n", part.c_str(),
                     kind.c_str(), k, method.name.c_str(), run.arrival.reason.c_str(), run.arrival.settled,
                     100 * run.arrival.rms, run.lag);
      }
    };
    for (std::size_t k = i; k < std::max(extent.targets, extent.trajectories); k += rigs) {
      TestRandom random(1000 * extent.seed + k), other(2000 * extent.seed + k);
      if (k < extent.targets) servo("target", k, random_target(random));
      if (k < extent.trajectories) servo("trajectory", k, random_trajectory(other));
    }
  });
  std::vector<std::string> laws;
  for (const Method& method : ways) laws.push_back(method.name);
  fmt::print("### Target shapes\n\n");
  print_targets(runs, part, laws);
  fmt::print("### Moving targets\n\n");
  print_trajectories(runs, part, laws);
}

}  // namespace
}  // namespace flexura

int main(int count, char** arguments) {
  using namespace flexura;
  const auto number = [&](int i, std::uint64_t otherwise) {
    return count > i ? std::strtoull(arguments[i], nullptr, 10) : otherwise;
  };
  const auto text = [&](int i) { return std::string(count > i ? arguments[i] : ""); };
  const Extent extent{number(1, 200), number(2, 50), number(3, 1), static_cast<unsigned>(number(4, 2))};
  const std::string part = text(5), law = text(6);
  SwingingRuns runs(text(7));
  const auto is_asked = [&](const char* name) { return part.empty() || part == name; };
  if (is_asked("calibrated")) {
    fmt::print("## Cameras calibrated by `bundle`\n\n");
    study(true, extent, law, runs);
  }
  if (is_asked("wrong")) {
    fmt::print("## Camera errors of half a degree about each axis and 1 % of the focal length\n\n");
    study(false, extent, law, runs);
  }
  return 0;
}
