#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flexura/calibrate/board_bundle.h"
#include "flexura/math/pose.h"

namespace flexura {

/// One camera calibrated by itself.
struct CameraAlone {
  BundleFit fit;                   ///< Of this camera and the boards that it saw.
  std::vector<std::size_t> views;  ///< Which these are, of the views given.
};

/// The root mean square of so many distances.
[[nodiscard]] double rms_of(double square_sum, std::size_t points);

/// Calibrates one camera of the given image size (width, height) from the views in which it saw the board: by
/// the closed form and least squares, from other focal lengths too where that ends badly. Not converged with
/// fewer than two views.
[[nodiscard]] CameraAlone fit_alone(std::span<const Eigen::Vector2d> points, std::span<const BoardView> views,
                                    std::size_t camera, const std::array<int, 2>& size,
                                    const BundleConfig& config);

/// X_1C, the mean of what the views say in which both cameras saw the board; none without such a view.
[[nodiscard]] std::optional<Pose> start_camera(const CameraAlone& first, const CameraAlone& other);

}  // namespace flexura
