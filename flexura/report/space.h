#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// Objects that the report's 3D view shows in addition to the commanded arm and the obstacles.
struct ReportSpace {
  /// Pose of a camera from a time on.
  struct CameraView {
    double time = 0;  ///< In s.
    Pose X_WC;        ///< Pose of the camera's frame; z is the optical axis.
    /// Left, right, top and bottom edge of the picture at a depth of 1 m, m: x and y in the camera's frame.
    std::array<double, 4> window = {};
  };
  struct Camera {
    std::string name;               ///< Any text.
    std::vector<CameraView> views;  ///< At least one view, in the order of time.
  };
  /// Target of a task.
  struct Target {
    std::string name;                              ///< Name of the task; any text.
    double start = 0;                              ///< In s.
    double end = 0;                                ///< In s.
    std::optional<Backbone> shape = {};            ///< Shape of the arm at the target.
    std::optional<Eigen::Vector3d> position = {};  ///< Target of the tip in W, m.
  };
  /// The true arm at a time: evenly spaced points of the arm, including base and tip, in W, m.
  struct TrueArm {
    double time = 0;  ///< In s.
    std::vector<Eigen::Vector3d> points;
  };

  std::vector<Camera> cameras = {};
  std::vector<Target> targets = {};  ///< In the order of their starts.
  /// True arms in the order of time, with equal numbers of points; may be empty.
  std::vector<TrueArm> true_arms = {};
};

/// Returns `count` (>= 2) points at equal fractions of the backbone's length, with both ends, in W, m.
[[nodiscard]] std::vector<Eigen::Vector3d> points_along(const Backbone& backbone, std::size_t count);

struct ReportMotion;
/// Returns the 3D view's data as JSON for the page's script. The JSON is valid inside a script element.
[[nodiscard]] std::string space_json(const ReportSpace& space, const ReportMotion& motion);

}  // namespace flexura
