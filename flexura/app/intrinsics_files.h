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
  Pose pose;        ///< X_WC
  LensConfig lens;  ///< Lens at zoom ratio 1, with the zoom's rows if it was measured at several ratios.
  std::array<int, 2> size = {640, 480};
  ViewPrior view_prior;
};

/// The part of a rig that experiments include: its cameras.
struct RigFile {
  std::vector<CameraConfig> camera;
};
const Table<RigFile>& fields_of(const RigFile*);

/// Returns the file representation of a lens without zoom.
[[nodiscard]] LensConfig lens_config(const Intrinsics& lens);

/// Returns the prior standard deviations for a camera of a fit. They are three times those of the fit's
/// covariance, which assumes independent errors of all corners. The focal one comes from the focal lengths.
/// The rotation one comes from the principal point and from the orientation relative to the first camera.
[[nodiscard]] ViewPrior view_prior_of(const IntrinsicsFit& fit, std::size_t camera);

/// Returns the text of a file of measured cameras (camera/measured_camera.h).
[[nodiscard]] std::string measured_cameras_toml(const std::vector<CalibratedCamera>& cameras,
                                                const std::string& remark);

/// Returns the text of a file of `[[camera]]` tables for experiments to include. Without `from`, it has these
/// cameras at their poses. With the experiment `from`, it has all of that experiment's cameras; those with
/// the names of `cameras` get their lenses and image sizes. The text is read back first. Throws InputError if
/// an experiment could not include it, or if `from` lacks one of the names.
[[nodiscard]] std::string rig_toml(const std::vector<CalibratedCamera>& cameras, const std::string& from,
                                   const std::string& remark);

/// Writes a new file of this name, or NAME-2, NAME-3, ... if it already exists: earlier files are kept.
/// Returns the path. Throws std::runtime_error with the path if the system refuses.
[[nodiscard]] std::filesystem::path write_beside(const std::filesystem::path& desired, std::string_view text);

/// Returns X_WC of the first camera, as given in the arguments.
[[nodiscard]] Pose first_pose(const IntrinsicsArguments& arguments);

/// Returns the cameras' names: as given in the arguments, or `usual`. Throws InputError for names that are
/// not unique or not plain enough to be included by other files.
[[nodiscard]] std::vector<std::string> names_of_cameras(const IntrinsicsArguments& arguments,
                                                        std::vector<std::string> usual);

/// What the comments in the written files report about the fit.
struct FitRemarks {
  double rms = 0;              ///< Rms residual, px.
  std::size_t points = 0;      ///< Number of points that `rms` is computed over.
  const Node::Array& of_each;  ///< The answer's entries, one per camera or zoom position.
};
/// Writes the requested files, all or none, and adds their paths to `answer`. Their first line holds rms and
/// points. Below the cameras, comments keep `of_each`, one line of JSON each, with residuals and covariances.
void write_files(const IntrinsicsArguments& arguments, const std::vector<CalibratedCamera>& cameras,
                 const FitRemarks& fit, Node::Table& answer);

}  // namespace flexura
