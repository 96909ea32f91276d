#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <mutex>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/calibrate/rig_quantities.h"
#include "tests/support/calibration_bench.h"
#include "tests/support/loop_files.h"
#include "tests/support/rig_figures.h"

namespace flexura {

/// Final estimates of a bundle: their errors and standard deviations.
struct BundleFigures {
  RigFigure angle;                 ///< Angle between the optical axes, rad.
  std::array<RigFigure, 2> focal;  ///< Focal lengths, relative errors.
  double rms = 0;  ///< Root mean square of the residuals, in units of their assumed standard deviations.
  std::array<double, 2> pictures = {0, 0};  ///< Number of pictures, by camera.
};

/// One start of a calibration and its outcome.
struct CalibrationTrial {
  std::size_t index = 0;
  double turn = 0;   ///< Rotation error of the camera that started farther off, pan and tilt together, rad.
  double shift = 0;  ///< Position error of the camera that started farther off, m.
  bool is_done = false;
  std::string reason = "done";  ///< Short reason; see kind_of.
  double pictures = 0;          ///< Pictures per camera.
  double angle = 0, aim = 0,
         zoom = 0;            ///< Remaining errors if done: angle from 90 degrees, rad; aim, m; zoom, share.
  BundleFigures bundle = {};  ///< Only of a bundle that is done.
};

/// Strips numbers and names from a reason, so that equal reasons can be counted.
inline std::string kind_of(const std::string& reason) {
  static const std::vector<std::string> kinds = {"oscillates",
                                                 "diverges",
                                                 "two red axes",
                                                 "limit of",
                                                 "out of view",
                                                 "cannot show the whole",
                                                 "no red axis",
                                                 "not verified",
                                                 "neither a circle's arc",
                                                 "does not see",
                                                 "correlation is",
                                                 "at the limit of its range",
                                                 "ends",
                                                 "no poses of the two cameras explain",
                                                 "are not explained",
                                                 "do not agree"};
  for (const std::string& kind : kinds)
    if (reason.find(kind) != std::string::npos) return kind;
  return reason.substr(0, reason.find(';'));
}

/// Returns the figures of a session that is done.
inline BundleFigures bundle_figures(CalibrationBench& bench, const RigSessionResult& result) {
  const RigCalibration& found = result.found;
  const std::array<RigStance, 2> stands = bench.true_stances();
  const RigModel truth = bench.true_model();
  // The session's variables, built from the arm pose and camera axis positions that it found.
  const RigVariables variables(bench.nominal(), bench.prior(), {found.poses, found.stances, {}});
  Eigen::VectorXd x = found.x;
  x.tail(x.size() - variables.globals()).setZero();
  BundleFigures figures;
  figures.rms = found.rms;
  std::vector<OpticalAxis> axes;
  for (std::size_t i = 0; i < 2; ++i) {
    std::size_t last = found.stances.size();
    while (found.stances.at(--last).camera != i) continue;
    axes.push_back(optical_axis(variables, x, observed_stance(variables, last)));
    const RigQuantity focal = log_focal(axes[i]);
    const Intrinsics lens = view_of(truth, stands[i]).lens.intrinsics();
    figures.focal[i] = {focal.value - 0.5 * std::log(lens.fx * lens.fy), focal.sigma(found.covariance)};
    figures.pictures[i] = static_cast<double>(result.pictures[i]);
  }
  const RigQuantity angle = axes_angle(axes[0], axes[1]);
  const double is = angle.value - std::numbers::pi / 2;
  figures.angle = {is - bench.truth(result.target).angle, angle.sigma(found.covariance)};
  return figures;
}

/// Calibrates random rig number `index` of a seed by a method, including rendering and image processing.
inline CalibrationTrial run_trial(const std::string& method, std::uint64_t seed, std::size_t index) {
  TestRandom random(seed * 1000003 + index);
  WrongRig wrong = wrong_rig(random);
  // Both bundles estimate a principal point error of any size, and the other camera errors within their
  // priors.
  constexpr double rougher = 10, zero = degree, axis = 0.003, k1 = 0.02;  // px; rad; m
  const bool is_bundle = method.starts_with("bundle");
  if (is_bundle) {
    for (WrongStart* start : {&wrong.front, &wrong.side}) {
      start->cx *= rougher, start->cy *= rougher;
      start->pan_zero = random.uniform(-zero, zero), start->tilt_zero = random.uniform(-zero, zero);
      for (double& place : start->tilt_axis) place = random.uniform(-axis, axis);
      start->k1 = random.uniform(-k1, k1);
    }
  }
  const std::string task = "method = \"" + method + "\"\n";
  const bool has_arm = method.find("etalon") == std::string::npos;
  const LoopRig cameras = arcs_cameras({wrong.front, wrong.side}, method == "arcs-paper");
  CalibrationBench bench(has_arm ? arcs_rig(task, cameras, wrong.longer)
                                 : etalon_rig(task, {.wrong = {wrong.front, wrong.side}}));
  RigPorts ports = bench.ports();
  WrongArm arm(*ports.arm, wrong.gains);
  if (has_arm) ports.arm = &arm;
  CalibrationTrial trial{.index = index};
  for (const WrongStart* start : {&wrong.front, &wrong.side}) {
    trial.turn = std::max(trial.turn, std::hypot(start->pan, start->tilt));
    trial.shift = std::max(trial.shift, std::hypot(start->shift[0], start->shift[1], start->shift[2]));
  }
  const auto end = [&](const auto& result) {
    trial.is_done = result.is_done;
    trial.pictures = 0.5 * static_cast<double>(result.pictures[0] + result.pictures[1]);
    if (!result.is_done) {
      trial.reason = kind_of(result.reason);
      return;
    }
    const RigRemainder left = bench.truth(result.target);
    trial.angle = left.angle, trial.zoom = left.zoom_ratio - 1;
    trial.aim = std::max(left.aim[0].norm(), left.aim[1].norm());
  };
  if (!is_bundle) {
    end(bench.calibrate(ports));
    return trial;
  }
  const RigSessionResult result = bench.calibrate_bundle(ports);
  end(result);
  if (result.is_done) trial.bundle = bundle_figures(bench, result);
  return trial;
}

/// Stores trials in a text file, one line per finished trial, so that an interrupted study can resume.
class TrialFile {
 public:
  explicit TrialFile(const std::string& path) {
    std::ifstream old(path);
    for (std::string line; std::getline(old, line);) {
      std::istringstream words(line);
      CalibrationTrial trial;
      int done = 0;
      words >> trial.index >> trial.turn >> trial.shift >> done >> trial.pictures >> trial.angle >>
          trial.aim >> trial.zoom;
      for (double* number : numbers(trial.bundle)) words >> *number;
      std::getline(words >> std::ws, trial.reason);
      if (words.fail()) continue;  // The line is truncated.
      trial.is_done = done != 0;
      trials_[trial.index] = trial;
    }
    file_.open(path, std::ios::app);
  }

  [[nodiscard]] bool has(std::size_t index) {
    const std::lock_guard lock(mutex_);
    return trials_.contains(index);
  }
  void add(const CalibrationTrial& trial) {
    const std::lock_guard lock(mutex_);
    trials_[trial.index] = trial;
    std::string bundle;
    for (const double* number : numbers(trials_[trial.index].bundle)) bundle += fmt::format(" {}", *number);
    file_ << fmt::format("{} {} {} {} {} {} {} {}{} {}\n", trial.index, trial.turn, trial.shift,
                         trial.is_done ? 1 : 0, trial.pictures, trial.angle, trial.aim, trial.zoom, bundle,
                         trial.reason)
          << std::flush;
  }
  /// Returns the trials of these indices, all of which must be stored.
  [[nodiscard]] std::vector<CalibrationTrial> all(const std::vector<std::size_t>& indices) const {
    std::vector<CalibrationTrial> result;
    for (const std::size_t i : indices) result.push_back(trials_.at(i));
    return result;
  }

 private:
  // Fields of a line in order. Lines of older programs lack some of them and are ignored.
  static std::array<double*, 9> numbers(BundleFigures& of) {
    return {&of.angle.error,    &of.angle.sigma, &of.focal[0].error, &of.focal[0].sigma, &of.focal[1].error,
            &of.focal[1].sigma, &of.rms,         &of.pictures[0],    &of.pictures[1]};
  }

  std::mutex mutex_;
  std::map<std::size_t, CalibrationTrial> trials_;
  std::ofstream file_;
};

}  // namespace flexura
