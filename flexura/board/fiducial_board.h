#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/board/board_finder.h"
#include "flexura/board/board_target.h"

namespace flexura {

/// The four corners of each marker in the board's plane, m. The markers are in the order of their numbers;
/// the corners are clockwise from the upper left one.
using FiducialPlaces = std::vector<std::array<Eigen::Vector2d, 4>>;

/// Returns the places of a board's markers in each layout that is in use. The first layout is that of
/// `flexura board`. ChArUco boards of earlier versions of OpenCV with an even number of rows of squares begin
/// with a white square. The numbers of AprilTags may begin at the lower left marker instead of the upper left
/// one. Requires a board with markers.
[[nodiscard]] std::vector<FiducialPlaces> fiducial_layouts(const BoardTarget& board);

/// Finds a board with markers, all of it or a part. Chooses the layout, and the first corner of the markers,
/// with which the picture agrees. Points that the picture does not show are NaN in the result. Finds nothing
/// if fewer than two markers or six points are visible.
[[nodiscard]] BoardObservation find_fiducial_board(const Image<std::uint8_t>& gray, const BoardTarget& board);

}  // namespace flexura
