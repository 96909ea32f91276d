#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/app/intrinsics.h"
#include "flexura/base/fields.h"
#include "flexura/base/node.h"
#include "flexura/board/intrinsics_fit.h"
#include "flexura/camera/camera_config.h"
#include "flexura/camera/intrinsics.h"
#include "flexura/camera/measured_camera.h"
#include "flexura/camera/view.h"
#include "flexura/math/pose.h"

namespace flexura {

/// A camera as it was measured, on its way to a file.
struct CalibratedCamera {
  std::string name;
  Pose pose;        ///< X_WC
  LensConfig lens;  ///< At ratio 1, with the zoom's rows where it was measured at several.
  std::array<int, 2> size = {640, 480};
  ViewPrior view_prior;
};

/// What experiments include of a rig: its cameras.
struct RigFile {
  std::vector<CameraConfig> camera;
};
const Table<RigFile>& fields_of(const RigFile*);

/// A lens as a file has it, without zoom.
[[nodiscard]] LensConfig lens_config(const Intrinsics& lens);

/// How wrong a camera of a fit may be: three times what the fit's covariance says, which takes each corner
/// for an observation of its own, of its focal length, and of where it looks by its principal point and by
/// how it is turned to the first camera.
[[nodiscard]] ViewPrior view_prior_of(const IntrinsicsFit& fit, std::size_t camera);

/// A file of measured cameras (camera/measured_camera.h).
[[nodiscard]] std::string measured_cameras_toml(const std::vector<CalibratedCamera>& cameras,
                                                const std::string& remark);

/// A file of `[[camera]]` that experiments include: of these cameras where they stand; or, with the
/// experiment `from`, of all its cameras, these lenses and image sizes put into those of the same names. What
/// it says is read back first: InputError for what an experiment could not include, and for names that `from`
/// lacks.
[[nodiscard]] std::string rig_toml(const std::vector<CalibratedCamera>& cameras, const std::string& from,
                                   const std::string& remark);

/// Writes a new file of this name, or NAME-2, NAME-3, ... when it is there already: earlier ones are kept.
/// Returns which. std::runtime_error with the path when the system refuses.
[[nodiscard]] std::filesystem::path write_beside(const std::filesystem::path& desired, std::string_view text);

/// X_WC of the first camera, as the command is told.
[[nodiscard]] Pose first_pose(const IntrinsicsArguments& arguments);

/// The cameras' names: as told, or as usual. InputError for names that others could not include.
[[nodiscard]] std::vector<std::string> names_of_cameras(const IntrinsicsArguments& arguments,
                                                        std::vector<std::string> usual);

/// What remarks in the files tell of the fit.
struct FitRemarks {
  double rms = 0;              ///< px
  std::size_t points = 0;      ///< That it is over.
  const Node::Array& of_each;  ///< What the command prints of each camera, or of each position of a zoom.
};
/// Writes the files that were asked for, all or none, and adds to `answer` which. rms and points go into
/// their first line; below the cameras the rest is kept, residuals and covariances with it, a line of JSON
/// for each.
void write_files(const IntrinsicsArguments& arguments, const std::vector<CalibratedCamera>& cameras,
                 const FitRemarks& fit, Node::Table& answer);

}  // namespace flexura
