#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "flexura/study/study_target.h"

namespace flexura {

/// What is measured in the image of a study's target: lengths in px, and last the ratio of the axes of the
/// circle's ellipse. Edges and the circle's top are named as the camera stands that faces the target upright.
inline constexpr std::array<std::string_view, 9> feature_names{
    "top",
    "bottom",
    "left",
    "right",  // the square's edges
    "height",
    "width",  // between the middles of opposite edges
    "corner_to_center",
    "top_to_center",  // the top right corner's; the circle's top's
    "axes_ratio"};    // smaller over larger
inline constexpr std::size_t length_features = feature_names.size() - 1;

/// One value a feature; none where a point it needs is not in the image.
using ImageFeatures = std::array<std::optional<double>, feature_names.size()>;
[[nodiscard]] ImageFeatures features_of(const TargetImage& image);

/// Smaller axis over larger of the ellipse that fits the points best (least squares of the conic's equation,
/// in coordinates in which the points spread evenly); exact for points on an ellipse, 0 for points on a line.
/// None for fewer than five points, and where another conic fits best.
[[nodiscard]] std::optional<double> axes_ratio(std::span<const Eigen::Vector2d> points);

}  // namespace flexura
