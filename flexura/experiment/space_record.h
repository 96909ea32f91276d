#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/experiment/experiment.h"
#include "flexura/model/backbone.h"
#include "flexura/report/space.h"
#include "flexura/tasks/task_runner.h"

namespace flexura {

/// Returns where the axes of the true camera are if the axes of its model report `reported`. Reports count
/// from the model's start `first`, where the true camera may stand otherwise.
[[nodiscard]] CameraStance true_stance(const Camera& camera, const CameraStance& first,
                                       const CameraStance& reported);

/// Records the true arm and the cameras of a run for the report's 3D view. Long runs are thinned.
class SpaceRecord {
 public:
  /// Takes the cameras at the start.
  void add_cameras(const Experiment& experiment);
  /// Adds the reports of a camera's axes at `time` s, later than those before.
  void report(double time, const std::string& camera, const CameraStance& reported);
  /// Returns what a camera's axes report at the start; null for an unknown camera.
  [[nodiscard]] const CameraStance* first_report(const std::string& camera) const;
  /// Adds the true arm at `time` s, later than those before, and the arm as commanded then.
  void true_arm(double time, const Backbone& truth, const Backbone& commanded);

  /// Returns the record. It has no true arms if they never differ visibly from the commanded ones.
  [[nodiscard]] ReportSpace space() &&;

 private:
  struct CameraRecord {
    Camera camera;
    CameraStance first;  // Reported.
    CameraStance last;   // True.
    ReportSpace::Camera views;
  };

  std::vector<CameraRecord> cameras_;
  std::vector<ReportSpace::TrueArm> arms_;
  ReportSpace::TrueArm last_;  // The newest arm, which is always kept.
  std::size_t count_ = 0;      // Arms so far.
  std::size_t every_ = 1;      // One of so many arms is kept.
  double largest_off_ = 0;     // Distance of the true arm from the commanded arm, share of the length.
};

/// A task that was performed.
struct DoneTask {
  const TaskRunner& runner;
  double start = 0;            ///< In s.
  const Motion& motion;        ///< Commanded motion; its times count from `start`.
  bool keeps_targets = false;  ///< Whether the targets of the task before stay: a hold.
};

/// Returns the targets of tasks in their order, with times of the run.
[[nodiscard]] std::vector<ReportSpace::Target> targets_of(std::span<const DoneTask> tasks);

}  // namespace flexura
