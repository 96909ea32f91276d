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

/// Where a camera stands when a run starts.
struct CameraStartConfig {
  double pan = 0, tilt = 0;                 ///< As HeadState has them, rad.
  std::optional<double> zoom;               ///< A position of the lens's; left out: the least of its limits.
  std::array<double, 3> stage = {0, 0, 0};  ///< Along the mount's axes (right, down, forward), m.
};

/// One `[[camera]]` of a file.
struct CameraConfig {
  std::string name;  ///< Names files and topics of logs: letters, digits, -, _, spaces, points.
  MountConfig mount;
  HeadConfig head;
  LensConfig lens;
  SensorConfig sensor;
  CameraStartConfig initial;
};

const Table<CameraStartConfig>& fields_of(const CameraStartConfig*);
const Table<CameraConfig>& fields_of(const CameraConfig*);

/// The camera's lens with all its numbers, also such as follow from others where the file leaves them out.
/// std::invalid_argument: as ZoomTable says.
[[nodiscard]] LensConfig spelled_out(const CameraConfig& camera);

/// The camera with its principal point moved by so much, px, the same at all zooms.
[[nodiscard]] CameraConfig with_principal_point_moved(CameraConfig camera, const Eigen::Vector2d& by);

/// Reports to `reader` cameras of the same name among those at `path`.
void check_cameras(const std::vector<CameraConfig>& cameras, const std::string& path, Reader& reader);

/// The paper's two cameras: "front" on +Z looking along -Z at the plane XOY, "side" on -X looking along +X at
/// the plane ZOY, so far from their planes that a ball of radius `reach` m (> 0) about `center` is in the
/// image with a twentieth to spare. std::invalid_argument for a reach that is not positive.
[[nodiscard]] std::vector<CameraConfig> default_cameras(double reach,
                                                        const std::array<double, 3>& center = {0, 0, 0});

/// The same at given distances from the planes through `center`, m: the paper's D1 and D2.
/// std::invalid_argument for one that is not positive and finite.
[[nodiscard]] std::vector<CameraConfig> cameras_at(const std::array<double, 2>& distances,
                                                   const std::array<double, 3>& center = {0, 0, 0});

}  // namespace flexura
