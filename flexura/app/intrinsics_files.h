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

/// A calibrated camera to be written to a file.
struct CalibratedCamera {
  std::string name;
  Pose pose;  ///< Pose X_WC.
  LensConfig
      lens;  ///< Lens at the zoom ratio 1, with the rows of the zoom table if several ratios were measured.
  std::array<int, 2> size = {640, 480};
  ViewPrior view_prior;
};

/// Cameras of a rig, in a file that experiments can include.
struct RigFile {
  std::vector<CameraConfig> camera;
};
const Table<RigFile>& fields_of(const RigFile*);

/// Returns the file representation of a lens without zoom.
[[nodiscard]] LensConfig lens_config(const Intrinsics& lens);

/// Returns the prior standard deviations for a camera of a fit. Each is three times the standard deviation of
/// the fit. The fit's covariance assumes independent errors of all corners. The prior of the focal length
/// follows from the focal lengths' standard deviations. The prior of the rotation follows from the standard
/// deviations of the principal point and of the orientation relative to the first camera.
[[nodiscard]] ViewPrior view_prior_of(const IntrinsicsFit& fit, std::size_t camera);

/// Returns the text of a file of measured cameras (camera/measured_camera.h).
[[nodiscard]] std::string measured_cameras_toml(const std::vector<CalibratedCamera>& cameras,
                                                const std::string& remark);

/// Returns the text of a file of `[[camera]]` tables that experiments can include. Without `from`, the file
/// has `cameras` at their poses. With the experiment `from`, the file has all cameras of that experiment.
/// Cameras whose name is in `cameras` get the calibrated lens and image size. Throws InputError if an
/// experiment could not include the text, or if `from` lacks one of the names.
[[nodiscard]] std::string rig_toml(const std::vector<CalibratedCamera>& cameras, const std::string& from,
                                   const std::string& remark);

/// Writes a new file with this name, or NAME-2, NAME-3, ... if it already exists, so that earlier files are
/// kept. Returns the path. Throws std::runtime_error with the path if the file cannot be written.
[[nodiscard]] std::filesystem::path write_beside(const std::filesystem::path& desired, std::string_view text);

/// Returns the pose X_WC of the first camera that the arguments give.
[[nodiscard]] Pose first_pose(const IntrinsicsArguments& arguments);

/// Returns the cameras' names in the arguments, or `usual` if the arguments have none. Throws InputError for
/// names that are not unique or have characters that an experiment does not allow.
[[nodiscard]] std::vector<std::string> names_of_cameras(const IntrinsicsArguments& arguments,
                                                        std::vector<std::string> usual);

/// Data about the fit for the comments in the written files.
struct FitRemarks {
  double rms = 0;              ///< Rms residual, px.
  std::size_t points = 0;      ///< Number of points in `rms`.
  const Node::Array& of_each;  ///< Entries of the answer, one per camera or zoom position.
};
/// Writes the requested files and adds their paths to `answer`. If one cannot be written, none is. The first
/// line of each file states `rms` and `points`. Comments below the cameras have the entries of `of_each` as
/// one line of JSON each, with residuals and covariances.
void write_files(const IntrinsicsArguments& arguments, const std::vector<CalibratedCamera>& cameras,
                 const FitRemarks& fit, Node::Table& answer);

}  // namespace flexura
