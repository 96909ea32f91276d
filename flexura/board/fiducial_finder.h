#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "flexura/board/fiducial.h"

namespace flexura {

/// The outer corners of a marker in a picture, px. Their order is clockwise; the first one is the upper left
/// corner of the marker if it is upright.
using Quad = std::array<Eigen::Vector2d, 4>;

/// A marker in a picture.
struct FoundFiducial {
  int id = 0;
  Quad corners;
};

/// Finds the markers of a family with numbers below `count` in a gray picture (8 bits), ordered by number. If
/// a number appears more than once, none of these markers is in the result. The work is proportional to the
/// picture's number of pixels.
[[nodiscard]] std::vector<FoundFiducial> find_fiducials(const cv::Mat& gray, FiducialFamily family,
                                                        int count);

/// Moves the corners of a black quadrilateral to the intersections of straight lines through its edges. The
/// edges are searched within `reach` px of the given sides. Returns false if a side has no edge.
[[nodiscard]] bool refine_quad(const cv::Mat& gray, double reach, Quad& corners);

}  // namespace flexura
