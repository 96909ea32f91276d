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

/// Returns the axis positions of the true camera for the reported positions `reported`. `first`: positions of
/// the model at the start. The true camera may start at other positions, but its changes are equal to the
/// reported changes.
[[nodiscard]] CameraStance true_stance(const Camera& camera, const CameraStance& first,
                                       const CameraStance& reported);

/// Records the true arm and the cameras of a run for the report's 3D view. For long runs, it keeps only a
/// part of the states.
class SpaceRecord {
 public:
  /// Adds the experiment's cameras with their poses at the start.
  void add_cameras(const Experiment& experiment);
  /// Adds the axis positions that a camera reports at `time`, s. Times must increase.
  void report(double time, const std::string& camera, const CameraStance& reported);
  /// Returns the axis positions that a camera reports at the start; null for an unknown camera.
  [[nodiscard]] const CameraStance* first_report(const std::string& camera) const;
  /// Adds the true arm and the commanded arm at `time`, s. Times must increase.
  void true_arm(double time, const Backbone& truth, const Backbone& commanded);

  /// Returns the record. The true arm is omitted if it never differs visibly from the commanded arm.
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
  double start = 0;            ///< Start of the task, s.
  const Motion& motion;        ///< Commanded motion; its times count from `start`.
  bool keeps_targets = false;  ///< Whether the targets of the previous task remain valid: true for a hold.
};

/// Returns the targets of the tasks in their order. Times count from the run's start.
[[nodiscard]] std::vector<ReportSpace::Target> targets_of(std::span<const DoneTask> tasks);

}  // namespace flexura
