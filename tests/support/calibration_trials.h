#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "flexura/base/degree.h"
#include "tests/support/calibration_bench.h"
#include "tests/support/loop_files.h"

namespace flexura {

/// One start of a calibration and its outcome.
struct CalibrationTrial {
  std::size_t index = 0;
  bool is_done = false;
  std::string reason = "done";  ///< Why it is not done.
  double pictures = 0;          ///< Pictures per camera.
  double angle = 0, aim = 0,
         zoom = 0;  ///< Remaining errors if done: angle from 90 degrees, rad; aim, m; zoom, share.
};

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
  const auto end = [&](const auto& result) {
    trial.is_done = result.is_done;
    trial.pictures = 0.5 * static_cast<double>(result.pictures[0] + result.pictures[1]);
    if (!result.is_done) {
      trial.reason = result.reason;
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
  end(bench.calibrate_bundle(ports));
  return trial;
}

}  // namespace flexura
