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

#include "tests/support/calibration_bench.h"
#include "tests/support/loop_files.h"

namespace flexura {

/// One start of a calibration, and what came of it.
struct CalibrationTrial {
  std::size_t index = 0;
  double turn = 0;   ///< Of the camera that started farther off: rad in pan and tilt together,
  double shift = 0;  ///< and m.
  bool is_done = false;
  std::string reason = "done";          ///< In few words; see kind_of.
  double pictures = 0;                  ///< A camera.
  double angle = 0, aim = 0, zoom = 0;  ///< What remains if it is done: rad from 90 degrees, m, share.
};

/// A reason without its numbers and names, to be counted.
inline std::string kind_of(const std::string& reason) {
  static const std::vector<std::string> kinds = {"back and forth",
                                                 "runs away",
                                                 "two red axes",
                                                 "limit of",
                                                 "out of view",
                                                 "cannot have all",
                                                 "no red axis",
                                                 "not verified",
                                                 "no circle's arc",
                                                 "does not see",
                                                 "correlation is",
                                                 "what can be commanded ends",
                                                 "ends",
                                                 "no two cameras explain",
                                                 "are not explained",
                                                 "do not agree"};
  for (const std::string& kind : kinds)
    if (reason.find(kind) != std::string::npos) return kind;
  return reason.substr(0, reason.find(';'));
}

/// Calibrates the random rig number `index` of a seed by a method, pictures and all.
inline CalibrationTrial run_trial(const std::string& method, std::uint64_t seed, std::size_t index) {
  TestRandom random(seed * 1000003 + index);
  WrongRig wrong = wrong_rig(random);
  // Both bundles learn the principal point and the zeros of the heads; the others cannot see them.
  constexpr double rougher = 10, zero = std::numbers::pi / 180;
  const bool is_bundle = method.starts_with("bundle");
  if (is_bundle) {
    for (WrongStart* start : {&wrong.front, &wrong.side}) {
      start->cx *= rougher, start->cy *= rougher;
      start->pan_zero = random.uniform(-zero, zero), start->tilt_zero = random.uniform(-zero, zero);
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
  if (is_bundle)
    end(bench.calibrate_bundle(ports));
  else
    end(bench.calibrate(ports));
  return trial;
}

/// Trials kept in a text file, a line each as they end, so that a study that was interrupted goes on where it
/// was.
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
      std::getline(words >> std::ws, trial.reason);
      if (words.fail()) continue;  // It was cut off there.
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
    file_ << fmt::format("{} {} {} {} {} {} {} {} {}\n", trial.index, trial.turn, trial.shift,
                         trial.is_done ? 1 : 0, trial.pictures, trial.angle, trial.aim, trial.zoom,
                         trial.reason)
          << std::flush;
  }
  /// These, all of which there are.
  [[nodiscard]] std::vector<CalibrationTrial> all(const std::vector<std::size_t>& indices) const {
    std::vector<CalibrationTrial> result;
    for (const std::size_t i : indices) result.push_back(trials_.at(i));
    return result;
  }

 private:
  std::mutex mutex_;
  std::map<std::size_t, CalibrationTrial> trials_;
  std::ofstream file_;
};

}  // namespace flexura
