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

/// A rotation as one writes it: the rows of its matrix, or the quaternion (w, x, y, z).
struct RotationConfig {
  /// The rows, or the quaternion; as written, not yet brought to a rotation.
  std::variant<std::array<std::array<double, 3>, 3>, std::array<double, 4>> value =
      std::array<double, 4>{1, 0, 0, 0};

  /// How far the matrix is from a rotation (the largest entry of R R^T - 1, and the determinant less 1), or
  /// the quaternion from one of norm 1. 0: a rotation.
  [[nodiscard]] double error() const;
  /// A rotation by either: a matrix that is off one is drawn to one, a quaternion brought to norm 1.
  [[nodiscard]] Eigen::Matrix3d matrix() const;
};

/// Both forms are lists in a file: of three rows, or of four numbers.
template <>
struct Codec<RotationConfig> {
  static Type type();
  static bool read(const Node& node, const Spec& spec, Reader& reader, RotationConfig& value);
  static Node write(const RotationConfig& value);
};

/// One `[[camera]]` of a file of cameras as they were measured: a lens that stands still, and where it
/// stands.
struct MeasuredCamera {
  std::string name;                                    ///< For messages.
  double fx = 800;                                     ///< px
  std::optional<double> fy;                            ///< px; fx when left out.
  double cx = 319.5, cy = 239.5;                       ///< px
  std::array<double, 5> distortion = {0, 0, 0, 0, 0};  ///< k1, k2, p1, p2, k3: OpenCV's order.
  std::array<double, 3> position = {0, 0, 0};          ///< p_WC, m.
  RotationConfig rotation;                             ///< R_WC: C's x right, y down, z forward.
  double gamma = 1;                                    ///< Its values are light to the power 1/gamma.
  std::optional<std::array<std::int64_t, 2>> size;     ///< Width and height of the pictures meant, px.
  ViewDoubt prior;                                     ///< Of its orientation and focal lengths.

  /// std::invalid_argument: as Lens says.
  [[nodiscard]] Lens lens() const;
  /// X_WC.
  [[nodiscard]] Pose pose() const;
  /// Why a picture of this size, px, is none of those that are described; none where no size is said.
  [[nodiscard]] std::optional<std::string> other_size(int width, int height) const;
};

/// Such a file.
struct MeasuredCameras {
  std::vector<MeasuredCamera> camera;
};

const Table<ViewDoubt>& fields_of(const ViewDoubt*);
const Table<MeasuredCamera>& fields_of(const MeasuredCamera*);
const Table<MeasuredCameras>& fields_of(const MeasuredCameras*);

}  // namespace flexura
