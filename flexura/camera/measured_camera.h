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

/// A rotation as written in a file: the rows of its matrix, or the quaternion (w, x, y, z).
struct RotationConfig {
  /// The rows, or the quaternion; as written, not yet normalised.
  std::variant<std::array<std::array<double, 3>, 3>, std::array<double, 4>> value =
      std::array<double, 4>{1, 0, 0, 0};

  /// Returns the deviation from a rotation. For a matrix, the largest entry of R R^T - 1 and of the
  /// determinant minus 1; for a quaternion, of its norm from 1.
  [[nodiscard]] double error() const;
  /// Returns the rotation: the one nearest to the matrix, or that of the normalised quaternion.
  [[nodiscard]] Eigen::Matrix3d matrix() const;
};

/// In a file, both forms are lists: of three rows, or of four numbers.
template <>
struct Codec<RotationConfig> {
  static Type type();
  static bool read(const Node& node, const Spec& spec, Reader& reader, RotationConfig& value);
  static Node write(const RotationConfig& value);
};

/// One `[[camera]]` of a file of measured cameras: a fixed lens and its pose.
struct MeasuredCamera {
  std::string name;                                    ///< Name for messages.
  double fx = 800;                                     ///< Focal length, px.
  std::optional<double> fy;                            ///< Focal length, px; default: fx.
  double cx = 319.5, cy = 239.5;                       ///< Principal point, px.
  std::array<double, 5> distortion = {0, 0, 0, 0, 0};  ///< k1, k2, p1, p2, k3: OpenCV's order.
  std::array<double, 3> position = {0, 0, 0};          ///< p_WC, m.
  RotationConfig rotation;                             ///< R_WC: C's x right, y down, z forward.
  double gamma = 1;                                    ///< Its values are light to the power 1/gamma.
  std::optional<std::array<std::int64_t, 2>> size;     ///< Width and height of the pictures meant, px.
  ViewPrior prior;                                     ///< Of its orientation and focal lengths.

  /// Throws std::invalid_argument as Lens does.
  [[nodiscard]] Lens lens() const;
  /// X_WC.
  [[nodiscard]] Pose pose() const;
  /// Returns why a picture of this size, px, does not match the camera; empty if it does, or if the camera
  /// has no size.
  [[nodiscard]] std::optional<std::string> other_size(int width, int height) const;
};

/// A file of measured cameras.
struct MeasuredCameras {
  std::vector<MeasuredCamera> camera;
};

const Table<ViewPrior>& fields_of(const ViewPrior*);
const Table<MeasuredCamera>& fields_of(const MeasuredCamera*);
const Table<MeasuredCameras>& fields_of(const MeasuredCameras*);

}  // namespace flexura
