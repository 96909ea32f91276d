#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/camera/intrinsics.h"
#include "flexura/camera/view.h"
#include "flexura/math/pose.h"

namespace flexura {

/// A rotation in a file: the rows of a rotation matrix, or a quaternion (w, x, y, z).
struct RotationConfig {
  /// Rows of the matrix, or the quaternion, as written in the file without normalisation.
  std::variant<std::array<std::array<double, 3>, 3>, std::array<double, 4>> value =
      std::array<double, 4>{1, 0, 0, 0};

  /// Returns the deviation of the written value from a rotation. For a matrix R, this is the largest absolute
  /// value among the entries of R R^T - 1 and det R - 1. For a quaternion, this is the deviation of its norm
  /// from 1.
  [[nodiscard]] double error() const;
  /// Returns the rotation nearest to the written matrix, or the rotation of the normalized quaternion.
  [[nodiscard]] Eigen::Matrix3d matrix() const;
};

/// Codec of a rotation, which in a file is an array of three rows or an array of four numbers.
template <>
struct Codec<RotationConfig> {
  static Type type();
  static bool read(const Node& node, const Spec& spec, Reader& reader, RotationConfig& value);
  static Node write(const RotationConfig& value);
};

/// A measured camera in a file, `[[camera]]`: a camera with a fixed lens and a fixed pose.
struct MeasuredCamera {
  std::string name;                    ///< Name for messages.
  double fx = 800;                     ///< Focal length along u, px.
  std::optional<double> fy;            ///< Focal length along v, px; default: fx.
  double cx = 319.5, cy = 239.5;       ///< Principal point, px.
  LensModel model = LensModel::brown;  ///< Lens model.
  /// Distortion coefficients. If all are 0, their number need not be that of the model.
  Distortion distortion;
  std::array<double, 3> position = {0, 0, 0};  ///< Position p_WC of the entrance pupil, m.
  RotationConfig rotation;                     ///< R_WC; C has x right, y down, z forward.
  double gamma = 1;  ///< Gamma of the pictures: pixel values are light to the power 1/gamma.
  std::optional<std::array<std::int64_t, 2>>
      size;         ///< Width and height of the camera's pictures, px; default: any.
  ViewPrior prior;  ///< Prior standard deviations of orientation and focal lengths.

  /// Returns the camera's lens. Throws std::invalid_argument for invalid intrinsics (see Lens).
  [[nodiscard]] Lens lens() const;
  /// Returns the pose X_WC.
  [[nodiscard]] Pose pose() const;
  /// Returns an error text if the size of a picture, px, differs from the camera's `size`; otherwise
  /// std::nullopt.
  [[nodiscard]] std::optional<std::string> other_size(int width, int height) const;
};

/// Content of a file of measured cameras.
struct MeasuredCameras {
  std::vector<MeasuredCamera> camera;
};

const Table<ViewPrior>& fields_of(const ViewPrior*);
const Table<MeasuredCamera>& fields_of(const MeasuredCamera*);
const Table<MeasuredCameras>& fields_of(const MeasuredCameras*);

}  // namespace flexura
