#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/camera/head.h"
#include "flexura/camera/mount.h"
#include "flexura/camera/sensor.h"
#include "flexura/camera/zoom.h"

namespace flexura {

/// Positions of a camera's axes at the start of a run.
struct CameraStartConfig {
  double pan = 0, tilt = 0;    ///< Angles as in HeadState, rad.
  std::optional<double> zoom;  ///< Position of the zoom; default: its lower limit.
  /// Stage offset along the mount's axes (right, down, forward), m.
  std::array<double, 3> stage = {0, 0, 0};
};

/// One `[[camera]]` of a file.
struct CameraConfig {
  std::string name;  ///< Names files and log topics: letters, digits, -, _, spaces, points.
  MountConfig mount;
  HeadConfig head;
  LensConfig lens;
  SensorConfig sensor;
  CameraStartConfig initial;
};

const Table<CameraStartConfig>& fields_of(const CameraStartConfig*);
const Table<CameraConfig>& fields_of(const CameraConfig*);

/// Returns the camera's lens with all values, including derived ones that the file omits. Throws
/// std::invalid_argument as ZoomTable does.
[[nodiscard]] LensConfig spelled_out(const CameraConfig& camera);

/// Returns the camera with its principal point moved by this much, px, equally at all zooms.
[[nodiscard]] CameraConfig with_principal_point_moved(CameraConfig camera, const Eigen::Vector2d& by);

/// Reports to `reader` cameras with the same name among those at `path`.
void check_cameras(const std::vector<CameraConfig>& cameras, const std::string& path, Reader& reader);

/// Returns the paper's two cameras: "front" on +Z looking along -Z at the plane XOY, "side" on -X looking
/// along +X at the plane ZOY. Their distance is such that a ball of radius `reach` m (> 0) about `center` is
/// in the image with a margin of a twentieth. Throws std::invalid_argument for a reach that is not positive.
[[nodiscard]] std::vector<CameraConfig> default_cameras(double reach,
                                                        const std::array<double, 3>& center = {0, 0, 0});

/// Returns the paper's two cameras at given distances from the planes through `center`, m: the paper's D1 and
/// D2. Throws std::invalid_argument for a distance that is not positive and finite.
[[nodiscard]] std::vector<CameraConfig> cameras_at(const std::array<double, 2>& distances,
                                                   const std::array<double, 3>& center = {0, 0, 0});

}  // namespace flexura
