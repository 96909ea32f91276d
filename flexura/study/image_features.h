#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "flexura/study/study_target.h"

namespace flexura {

/// Names of the features that a study measures in the image of its target. All features except the last
/// feature are lengths in px. The last feature is the ratio of the axes of the circle's ellipse. The names of
/// edges and of the circle's top refer to an upright camera that faces the target.
inline constexpr std::array<std::string_view, 9> feature_names{
    "top",
    "bottom",
    "left",
    "right",  // Lengths of the square's edges.
    "height",
    "width",  // Distances between the middles of opposite edges.
    "corner_to_center",
    "top_to_center",  // Distances of the top right corner and of the circle's top from the centre.
    "axes_ratio"};    // Smaller axis divided by larger axis.
inline constexpr std::size_t length_features = feature_names.size() - 1;

/// Value of each feature; std::nullopt if a required point is not in the image.
using ImageFeatures = std::array<std::optional<double>, feature_names.size()>;
[[nodiscard]] ImageFeatures features_of(const TargetImage& image);

/// Returns the ratio of the smaller to the larger axis of the ellipse that fits the points best. The fit
/// minimizes the squared residuals of the conic's equation, in coordinates in which the points have equal
/// spread. The result is exact for points on an ellipse, and 0 for points on a line. Returns std::nullopt for
/// fewer than five points, or if the best conic is not an ellipse.
[[nodiscard]] std::optional<double> axes_ratio(std::span<const Eigen::Vector2d> points);

}  // namespace flexura
