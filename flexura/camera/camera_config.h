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
  double pan = 0, tilt = 0;    ///< Angles that the head reports, rad.
  std::optional<double> zoom;  ///< Zoom position; default: its lower limit.
  /// Stage offset along the mount's axes (right, down, forward), m.
  std::array<double, 3> stage = {0, 0, 0};
};

/// A camera in a file, `[[camera]]`.
struct CameraConfig {
  std::string name;  ///< Name of the camera in files and log topics: letters, digits, -, _, spaces, points.
  MountConfig mount;
  HeadConfig head;
  LensConfig lens;
  SensorConfig sensor;
  CameraStartConfig initial;
};

const Table<CameraStartConfig>& fields_of(const CameraStartConfig*);
const Table<CameraConfig>& fields_of(const CameraConfig*);

/// Returns the camera's lens with all values, including values that the file omits and the program derives.
/// Throws std::invalid_argument for an invalid lens (see ZoomTable).
[[nodiscard]] LensConfig spelled_out(const CameraConfig& camera);

/// Returns the camera with the principal point moved by `by`, px, equally at all zoom positions.
[[nodiscard]] CameraConfig with_principal_point_moved(CameraConfig camera, const Eigen::Vector2d& by);

/// Reports to `reader` if cameras have equal names. `path`: path of `cameras` in the document.
void check_cameras(const std::vector<CameraConfig>& cameras, const std::string& path, Reader& reader);

/// Returns the paper's two cameras, which look at `center`, in W, m. "front" is on the +Z side and looks
/// along -Z at the plane XOY; "side" is on the -X side and looks along +X at the plane ZOY. The distance of
/// both cameras is such that a sphere of radius `reach`, m, around `center` fits into the image with a margin
/// of 5 %. Throws std::invalid_argument for a reach that is not positive.
[[nodiscard]] std::vector<CameraConfig> default_cameras(double reach,
                                                        const std::array<double, 3>& center = {0, 0, 0});

/// Returns the paper's two cameras at given distances from the planes XOY and ZOY through `center`, m. The
/// paper calls these distances D1 and D2. Throws std::invalid_argument for a distance that is not positive
/// and finite.
[[nodiscard]] std::vector<CameraConfig> cameras_at(const std::array<double, 2>& distances,
                                                   const std::array<double, 3>& center = {0, 0, 0});

}  // namespace flexura
