// Calibrates random rigs from rough guesses, by pictures that are chosen one after another, and prints how
// well: calibration_study [TRIALS] [SEED]. docs/studies/calibration.md
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "flexura/calibrate/rig_aim.h"
#include "flexura/calibrate/rig_calibration.h"
#include "flexura/calibrate/rig_views.h"
#include "tests/support/rig_figures.h"
#include "tests/support/rig_trials.h"
#include "tests/support/study_numbers.h"

namespace flexura {
namespace {

constexpr std::size_t pictures = 12;

struct Outcome {
  bool is_found = false;
  int starts = 0;
  double rms = 0;
  RigFigures figures;
  double off_square = 0;  // How far from 90 degrees the axes truly are at the end.
  double zoom_off = 0;    // And the zoom ratio from 1.
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

// The session as a task would run it: three looks at what is guessed, eight that are chosen, the move, and a
// last look that verifies it.
class Session {
 public:
  Session(const RigTrialConfig& config, std::uint64_t seed)
      : config_(config),
        random_(seed),
        believed_(believed_rig()),
        prior_(rough_prior(believed_)),
        trial_(true_rig(believed_, config, random_), config, random_) {
    if (config.are_heads_exact)
      for (CameraPrior& camera : prior_.cameras) camera.steps = 0;
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
    const WantedRig wanted = wanted_rig(calibrate().model, wish(last));
    look({last, {wanted.stances[0], wanted.stances[1]}});
    RigProblem problem(believed_, prior_, trial_.seen());
    const RigCalibration found = calibrate_rig(problem);
    Outcome outcome{found.is_found, found.starts, found.rms, figures_of(trial_, problem, found)};
    const std::size_t end = trial_.seen().stances.size();
    const RigRemainder left = remainder(trial_.truth(), {trial_.stance(end - 2), trial_.stance(end - 1)},
                                        arm_middle(trial_.truth(), last));
    outcome.off_square = left.angle, outcome.zoom_off = left.zoom_ratio - 1;
    return outcome;
  }

 private:
  void look(const ViewCandidate& what) {
    const std::size_t pose = trial_.add_pose(what.pose);
    for (const RigStance& stance : what.stances) trial_.add_image(trial_.add_stance(stance), pose);
  }

  RigCalibration calibrate() {
    RigProblem problem(believed_, prior_, trial_.seen());
    return calibrate_rig(problem);
  }

  RigWish wish(const ArmState& pose) const {
    RigWish wish;
    wish.target = arm_middle(believed_, pose);
    wish.now = {RigStance{0, {0, 0, 1.2}, {}}, RigStance{1, {0, 0, 1.2}, {}}};
    return wish;
  }

  ViewCandidate next(const std::vector<ArmState>& shown) {
    RigProblem problem(believed_, prior_, trial_.seen());
    const RigCalibration found = calibrate_rig(problem);
    const RigVariables& variables = problem.variables();
    const WantedRig wanted = wanted_rig(found.model, wish(shown.front()));
    const OpticalAxis a = optical_axis(variables, found.x, {wanted.stances[0], {}}),
                      b = optical_axis(variables, found.x, {wanted.stances[1], {}});
    const std::vector<ViewGoal> goals = {{axes_angle(a, b), 0.01 * degree},
                                         {log_focal(a), 0.0007},
                                         {log_focal(b), 0.0007},
                                         {log_zoom_ratio(a, b, wish(shown.front()).target), 0.003}};
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
  RigModel believed_;
  RigPrior prior_;
  RigTrial trial_;
};

struct Spread {
  double rms, share95, worst;
};

Spread spread(const std::vector<Outcome>& outcomes, const std::function<double(const Outcome&)>& what) {
  std::vector<double> sizes;
  sizes.reserve(outcomes.size());
  for (const Outcome& outcome : outcomes) sizes.push_back(std::abs(what(outcome)));
  return {root_mean_square(sizes), quantile(sizes, 0.95), quantile(sizes, 1)};
}

void print(const char* title, const std::vector<Outcome>& all) {
  std::vector<Outcome> found;
  for (const Outcome& one : all)
    if (one.is_found) found.push_back(one);
  int first = 0;
  for (const Outcome& one : found) first += one.starts == 1 ? 1 : 0;
  fmt::print("## {}\n\n{} of {} converged with {} pictures a camera, {} of them from the first start.\n\n",
             title, found.size(), all.size(), pictures, first);
  if (found.empty()) return;
  fmt::print("| | rms | 95 % | worst |\n| --- | ---: | ---: | ---: |\n");
  const auto row = [&](const char* name, double unit, int digits,
                       const std::function<double(const Outcome&)>& what) {
    const Spread s = spread(found, what);
    fmt::print("| {} | {:.{}f} | {:.{}f} | {:.{}f} |\n", name, s.rms / unit, digits, s.share95 / unit, digits,
               s.worst / unit, digits);
  };
  row("angle between the axes: error, deg", degree, 4,
      [](const Outcome& o) { return o.figures.angle.error; });
  row("angle between the axes: claimed sigma, deg", degree, 4,
      [](const Outcome& o) { return o.figures.angle.sigma; });
  row("angle between the axes: error over sigma", 1, 2,
      [](const Outcome& o) { return o.figures.angle.error / o.figures.angle.sigma; });
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    const std::string name = i == 0 ? "front" : "side";
    row((name + ": focal length error, %").c_str(), 0.01, 3,
        [i](const Outcome& o) { return o.figures.focal[i].error; });
    row((name + ": focal length claimed sigma, %").c_str(), 0.01, 3,
        [i](const Outcome& o) { return o.figures.focal[i].sigma; });
    row((name + ": focal length error over sigma").c_str(), 1, 2,
        [i](const Outcome& o) { return o.figures.focal[i].error / o.figures.focal[i].sigma; });
  }
  row("zoom ratio: error, %", 0.01, 3, [](const Outcome& o) { return o.figures.zoom_ratio.error; });
  row("zoom ratio: error over sigma", 1, 2,
      [](const Outcome& o) { return o.figures.zoom_ratio.error / o.figures.zoom_ratio.sigma; });
  row("aim at the arm: error, mm", 1e-3, 3, [](const Outcome& o) { return o.figures.aim; });
  row("residuals over noise", 1, 4, [](const Outcome& o) { return o.rms; });
  row("the axes in truth, from 90 deg, deg", degree, 4, [](const Outcome& o) { return o.off_square; });
  row("the zoom ratio in truth, from 1, %", 0.01, 3, [](const Outcome& o) { return o.zoom_off; });
  fmt::print("\n");
}

// How rough guesses may be: a fixed plan of pictures, of which each shows what happens to be inside.
void print_range(std::size_t trials, std::uint64_t seed) {
  fmt::print(
      "## How rough guesses may be\n\nA fixed plan of {} pictures a camera, aimed by the guess alone; wrong "
      "by this "
      "many times the rough guesses (10 deg, 20 % of the distance, 10 % of the focal length, 10 px). Wrong "
      "answers: "
      "found, but an angle between the axes more than five sigmas off.\n\n"
      "| times | found | from the first start | refused | wrong |\n| ---: | ---: | ---: | ---: | ---: |\n",
      pictures);
  for (const double times : {1.0, 1.5, 2.0, 3.0}) {
    RigTrialConfig config;
    config.turn *= times, config.focal *= times, config.principal_point *= times;
    constexpr double fifth_of_distance = 0.29;  // in each of three directions, m
    config.shift = fifth_of_distance * times;
    int found = 0, first = 0, wrong = 0;
    for (std::size_t i = 0; i < trials; ++i) {
      TestRandom random(seed * 1000003 + i);
      RigTrial trial(true_rig(believed_rig(), config, random), config, random);
      take_plan(trial, pictures);
      RigProblem problem(believed_rig(), rough_prior(believed_rig()), trial.seen());
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

}  // namespace
}  // namespace flexura

int main(int argc, char** argv) {
  using namespace flexura;
  const auto trials = static_cast<std::size_t>(argc > 1 ? std::atoi(argv[1]) : 100);
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  print_range(trials, seed);
  struct Kind {
    const char* title;
    bool is_exact;
    double noise;
  };
  for (const auto& [title, is_exact, noise] :
       {Kind{"Heads that stand within half a step of what they count, noise 0.2 px", false, 0.2},
        Kind{"Heads that stand where they count, noise 0.2 px", true, 0.2},
        Kind{"Heads that stand where they count, noise 0.1 px", true, 0.1}}) {
    RigTrialConfig config;
    config.are_heads_exact = is_exact, config.noise = noise;
    std::vector<Outcome> outcomes(trials);
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
      for (std::size_t i = next++; i < trials; i = next++)
        outcomes[i] = Session(config, seed * 1000003 + i).run();
    };
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
      threads.emplace_back(work);
    for (std::thread& thread : threads) thread.join();
    print(title, outcomes);
  }
  return 0;
}
