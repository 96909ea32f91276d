// Calibrates random rigs from rough guesses with adaptively planned pictures and prints the accuracy:
// calibration_study [TRIALS] [SEED]. See docs/studies/calibration.md.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "flexura/calibrate/rig_aim.h"
#include "flexura/calibrate/rig_calibration.h"
#include "flexura/calibrate/rig_views.h"
#include "tests/support/rig_figures.h"
#include "tests/support/rig_trials.h"
#include "tests/support/spread_tables.h"

namespace flexura {
namespace {

constexpr std::size_t pictures = 12;

struct Outcome {
  bool is_found = false;
  int starts = 0;
  double rms = 0;
  RigFigures figures;
  double off_square = 0;  // True deviation of the final angle between the axes from 90 degrees, rad.
  double zoom_off = 0;    // True deviation of the final zoom ratio from 1.
  double turned = 0;      // Range of pan or tilt of the head that turned less, rad.
};

std::vector<ArmState> poses() {
  constexpr double bends[8][6] = {{0.5, 0, 0.5, 0, 0.5, 0},         {0, 0.5, 0, 0.5, 0, 0.5},
                                  {-0.6, 0.3, 0.7, 0.1, 0.5, -0.8}, {0.4, -0.7, -0.3, -0.4, 0.9, 0.2},
                                  {1, 0.2, 1, -0.3, 1, 0.4},        {-0.3, 1, 0.2, 1, -0.4, 1},
                                  {-1, -0.8, 0.9, 0.8, 1, -1},      {0.8, -1, 0.9, -0.9, -0.7, 1.2}};
  std::vector<ArmState> poses;
  for (const auto& row : bends) {
    ArmState& pose = poses.emplace_back(ArmState::straight(3));
    for (std::size_t i = 0; i < 3; ++i) pose.bends[i] = {row[2 * i], row[2 * i + 1]};
  }
  return poses;
}

// Returns a true rig whose estimated camera parameters deviate from the model, uniformly within the prior
// standard deviations of the calibration.
RigModel wrong_rig(const RigModel& nominal, const RigTrialConfig& config, TestRandom& random) {
  RigModel rig = true_rig(nominal, config, random);
  const CameraPrior prior;
  const auto move = [&](double& number, double most) { number += random.uniform(-most, most); };
  for (CameraConfig& camera : rig.cameras) {
    HeadConfig& head = camera.head;
    for (double& place : head.tilt_axis) move(place, prior.tilt_axis);
    for (double& place : head.pupil) move(place, prior.pupil);
    move(head.pupil_shift, prior.pupil_shift);
    LensConfig& lens = camera.lens;
    lens.fy = lens.fy.value_or(lens.fx) * (1 + random.uniform(-prior.aspect, prior.aspect));
    for (std::size_t i = 0; i < lens.distortion.size(); ++i) move(lens.distortion[i], prior.distortion[i]);
  }
  return rig;
}

// Runs the session as a task would: three pictures aimed with the initial guess, eight planned ones, the
// final move and a last picture that verifies it.
class Session {
 public:
  Session(const RigTrialConfig& config, std::uint64_t seed)
      : config_(config),
        random_(seed),
        nominal_(nominal_rig()),
        prior_(rough_prior(nominal_)),
        trial_(wrong_rig(nominal_, config, random_), config, random_) {
    if (config.are_heads_exact)
      for (CameraPrior& camera : prior_.cameras) camera.steps = 0;
    if (config_.are_bends_alike) prior_.arm.bend = prior_.arm.bend_share = 0;
  }

  Outcome run() {
    const std::vector<ArmState> shown = poses();
    const std::size_t front = trial_.add_stance({0, {}, {}}), side = trial_.add_stance({1, {}, {}});
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t pose = trial_.add_pose(shown[i]);
      trial_.add_image(front, pose), trial_.add_image(side, pose);
    }
    for (std::size_t i = 3; i + 1 < pictures; ++i) look(next(shown));
    const ArmState& last = shown.front();
    const DesiredRig desired = desired_rig(calibrate().model, rig_goal(last));
    look({last, {desired.stances[0], desired.stances[1]}});
    RigProblem problem(nominal_, prior_, trial_.seen());
    const RigCalibration found = calibrate_rig(problem);
    Outcome outcome{found.is_found, found.starts, found.rms, figures_of(trial_, problem, found)};
    const std::size_t end = trial_.seen().stances.size();
    const RigRemainder left = remainder(trial_.truth(), {trial_.stance(end - 2), trial_.stance(end - 1)},
                                        arm_middle(trial_.truth(), last));
    outcome.off_square = left.angle, outcome.zoom_off = left.zoom_ratio - 1;
    outcome.turned = std::min(turned(0), turned(1));
    return outcome;
  }

 private:
  // Returns the range over which a camera's head was turned, rad.
  double turned(std::size_t camera) const {
    double most = 0;
    for (const RigStance& a : trial_.seen().stances)
      for (const RigStance& b : trial_.seen().stances)
        if (a.camera == camera && b.camera == camera)
          most = std::max({most, a.head.pan - b.head.pan, a.head.tilt - b.head.tilt});
    return most;
  }

  void look(const ViewCandidate& what) {
    const std::size_t pose = trial_.add_pose(what.pose);
    for (const RigStance& stance : what.stances) trial_.add_image(trial_.add_stance(stance), pose);
  }

  RigCalibration calibrate() {
    RigProblem problem(nominal_, prior_, trial_.seen());
    return calibrate_rig(problem);
  }

  RigGoal rig_goal(const ArmState& pose) const {
    RigGoal rig_goal;
    rig_goal.target = arm_middle(nominal_, pose);
    rig_goal.now = {RigStance{0, {0, 0, 1.2}, {}}, RigStance{1, {0, 0, 1.2}, {}}};
    return rig_goal;
  }

  ViewCandidate next(const std::vector<ArmState>& shown) {
    RigProblem problem(nominal_, prior_, trial_.seen());
    const RigCalibration found = calibrate_rig(problem);
    const RigVariables& variables = problem.variables();
    const DesiredRig desired = desired_rig(found.model, rig_goal(shown.front()));
    const OpticalAxis a = optical_axis(variables, found.x, {desired.stances[0], {}}),
                      b = optical_axis(variables, found.x, {desired.stances[1], {}});
    const std::vector<ViewGoal> goals = {{axes_angle(a, b), 0.01 * degree},
                                         {log_focal(a), 0.0007},
                                         {log_focal(b), 0.0007},
                                         {log_zoom_ratio(a, b, rig_goal(shown.front()).target), 0.003}};
    const auto candidates = view_candidates(
        found.model,
        {.poses = shown, .zooms = {1, 2.5}, .slides = {{0, 0, 0}, {0.4, 0, 0}, {-0.4, 0, 0}}, .spread = 0.6});
    ViewConfig config;
    config.sigma = config_.noise, config.points = config_.points / 2;
    const auto choice = next_best_view(problem, found, candidates, goals, config);
    return candidates.at(choice ? choice->candidate : 0);
  }

  RigTrialConfig config_;
  TestRandom random_;
  RigModel nominal_;
  RigPrior prior_;
  RigTrial trial_;
};

void print(const std::string& title, const std::vector<Outcome>& all) {
  std::vector<Outcome> found;
  for (const Outcome& one : all)
    if (one.is_found) found.push_back(one);
  int first = 0;
  for (const Outcome& one : found) first += one.starts == 1 ? 1 : 0;
  fmt::print(
      "## {}\n\n{} of {} calibrations converged with {} pictures per camera, {} of them from the first "
      "initial values.\n\n",
      title, found.size(), all.size(), pictures, first);
  if (found.empty()) return;
  const auto of_found = [&](const std::function<double(const Outcome&)>& what) {
    std::vector<double> values;
    std::ranges::transform(found, std::back_inserter(values), what);
    return values;
  };
  fmt::print("{}", spread_head);
  const auto row = [&](const std::string& name, double unit, int digits,
                       const std::function<double(const Outcome&)>& what) {
    fmt::print("{}", spread_row(name, of_found(what), unit, digits));
  };
  row("angle between the axes: error, deg", degree, 4,
      [](const Outcome& o) { return o.figures.angle.error; });
  row("angle between the axes: estimated standard deviation, deg", degree, 4,
      [](const Outcome& o) { return o.figures.angle.sigma; });
  row("angle between the axes: error / standard deviation", 1, 2,
      [](const Outcome& o) { return o.figures.angle.error / o.figures.angle.sigma; });
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    const std::string name = i == 0 ? "focal length of the front camera" : "focal length of the side camera";
    row(name + ": error, %", 0.01, 3, [i](const Outcome& o) { return o.figures.focal[i].error; });
    row(name + ": estimated standard deviation, %", 0.01, 3,
        [i](const Outcome& o) { return o.figures.focal[i].sigma; });
    row(name + ": error / standard deviation", 1, 2,
        [i](const Outcome& o) { return o.figures.focal[i].error / o.figures.focal[i].sigma; });
  }
  row("ratio of both zooms: error, %", 0.01, 3, [](const Outcome& o) { return o.figures.zoom_ratio.error; });
  row("ratio of both zooms: error / standard deviation", 1, 2,
      [](const Outcome& o) { return o.figures.zoom_ratio.error / o.figures.zoom_ratio.sigma; });
  row("distance of the axes from the arm's middle: error, mm", 1e-3, 3,
      [](const Outcome& o) { return o.figures.aim; });
  row("RMS residual / noise", 1, 4, [](const Outcome& o) { return o.rms; });
  row("deviation of the true axes from 90 deg, deg", degree, 4,
      [](const Outcome& o) { return o.off_square; });
  row("deviation of the true zoom ratio from 1, %", 0.01, 3, [](const Outcome& o) { return o.zoom_off; });
  fmt::print("\n");
}

void print_aims(const std::string& kind, bool are_heads_exact, const std::vector<Outcome>& all) {
  const auto row = [&](const std::string& name, double most, double unit, const std::vector<Outcome>& of,
                       const std::function<double(const Outcome&)>& what) {
    std::vector<double> values;
    for (const Outcome& one : of)
      if (one.is_found) values.push_back(what(one));
    fmt::print("{}", aim_row(kind, {name, most, unit, values}, of.size()));
  };
  const auto focal = [](const Outcome& one) {
    return std::max(std::abs(one.figures.focal[0].error), std::abs(one.figures.focal[1].error));
  };
  row("error of the angle between the axes within 0.01 deg", 0.01 * degree, degree, all,
      [](const Outcome& one) { return one.figures.angle.error; });
  row("errors of focal lengths within 0.3 %", 0.003, 0.01, all, focal);
  if (are_heads_exact) {
    std::vector<Outcome> turned = all;
    std::erase_if(turned, [](const Outcome& one) { return one.turned < 10 * degree; });
    row("errors of focal lengths within 0.05 %, if both heads rotated by 10 deg or more", 0.0005, 0.01,
        turned, focal);
  }
  row("RMS residual at most 1.05 of the noise", 1.05, 1, all, [](const Outcome& one) { return one.rms; });
  row("true axes within 0.0375 deg of 90 deg", 0.0375 * degree, degree, all,
      [](const Outcome& one) { return one.off_square; });
}

// Tests how rough the guesses may be, with a fixed plan of pictures; each picture shows whatever part of the
// arm is inside it.
void print_range(std::size_t trials, std::uint64_t seed) {
  fmt::print(
      "## Required accuracy of the initial guess\n\nHere each camera takes {} pictures by a fixed plan that "
      "depends on the initial guess alone. The errors of the guess are the given factor times 10 deg, 20 % "
      "of the distance, 10 % of the focal length and 10 px. A result is wrong if the error of the angle "
      "between the axes exceeds five standard deviations.\n\n"
      "| factor | converged | from the first initial values | failure reported | wrong |\n| ---: | ---: | "
      "---: | ---: | ---: |\n",
      pictures);
  for (const double times : {1.0, 1.5, 2.0, 3.0}) {
    RigTrialConfig config;
    config.turn *= times, config.focal *= times, config.principal_point *= times;
    constexpr double fifth_of_distance = 0.29;  // In each of three directions, m.
    config.shift = fifth_of_distance * times;
    int found = 0, first = 0, wrong = 0;
    for (std::size_t i = 0; i < trials; ++i) {
      TestRandom random(seed * 1000003 + i);
      RigTrial trial(wrong_rig(nominal_rig(), config, random), config, random);
      take_plan(trial, pictures);
      RigProblem problem(nominal_rig(), rough_prior(nominal_rig()), trial.seen());
      const RigCalibration answer = calibrate_rig(problem);
      if (!answer.is_found) continue;
      const RigFigure angle = figures_of(trial, problem, answer).angle;
      ++found, first += answer.starts == 1 ? 1 : 0;
      wrong += std::abs(angle.error) > 5 * angle.sigma ? 1 : 0;
    }
    fmt::print("| {} | {} | {} | {} | {} |\n", times, found, first, static_cast<int>(trials) - found, wrong);
  }
  fmt::print("\n");
}

// The quantisation of the heads limits the accuracy, however well the rig is known.
void print_heads(std::uint64_t seed) {
  constexpr double half = 0.0375 * degree;
  constexpr int draws = 1000000;
  TestRandom random(seed);
  std::vector<double> off;
  off.reserve(draws);
  for (int i = 0; i < draws; ++i) off.push_back(random.uniform(-half, half) - random.uniform(-half, half));
  const auto within = std::ranges::count_if(off, [](double one) { return std::abs(one) <= half; });
  fmt::print(
      "## Limit due to the resolution of the heads\n\nSuppose that two pan angles are unknown within half a "
      "step, and everything else is known. After one motion, the angle between the axes is within half a "
      "step of 90 degrees in {:.1f} % of {} cases. No method with one final motion can be better.\n\n{}{}\n",
      100.0 * static_cast<double>(within) / draws, draws, spread_head,
      spread_row("deviation of the true axes from 90 deg, deg", off, degree, 4));
}

}  // namespace
}  // namespace flexura

int main(int argc, char** argv) {
  using namespace flexura;
  const auto trials = static_cast<std::size_t>(argc > 1 ? std::atoi(argv[1]) : 100);
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  print_range(trials, seed);
  print_heads(seed);
  struct Kind {
    std::string title;
    bool is_exact;
    double noise;
    bool is_alike;
  };
  const std::string alike = ", bend errors equal in all poses";
  const std::array kinds = {Kind{"Heads within half a step, noise 0.2 px", false, 0.2, false},
                            Kind{"Heads within half a step, noise 0.2 px" + alike, false, 0.2, true},
                            Kind{"Exact heads, noise 0.2 px", true, 0.2, false},
                            Kind{"Exact heads, noise 0.2 px" + alike, true, 0.2, true},
                            Kind{"Exact heads, noise 0.1 px", true, 0.1, false}};
  std::array<std::vector<Outcome>, kinds.size()> all;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    RigTrialConfig config;
    config.are_heads_exact = kinds[kind].is_exact, config.noise = kinds[kind].noise;
    config.are_bends_alike = kinds[kind].is_alike;
    std::vector<Outcome>& outcomes = all[kind];
    outcomes.resize(trials);
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
      for (std::size_t i = next++; i < trials; i = next++)
        outcomes[i] = Session(config, seed * 1000003 + i).run();
    };
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
      threads.emplace_back(work);
    for (std::thread& thread : threads) thread.join();
    print(kinds[kind].title, outcomes);
  }
  fmt::print("## Aims\n\n");
  fmt::print("{}", aim_head);
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    print_aims(kinds[kind].title, kinds[kind].is_exact, all[kind]);
  fmt::print("\n");
  return 0;
}
