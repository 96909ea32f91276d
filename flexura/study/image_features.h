#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "flexura/study/study_target.h"

namespace flexura {

/// Features of the image of a study's target: lengths in px, and last the ratio of the axes of the circle's
/// ellipse. Edges and the circle's top are named for a camera that faces the target upright.
inline constexpr std::array<std::string_view, 9> feature_names{
    "top",
    "bottom",
    "left",
    "right",  // Edges of the square.
    "height",
    "width",  // Between the middles of opposite edges.
    "corner_to_center",
    "top_to_center",  // Of the top right corner; of the circle's top.
    "axes_ratio"};    // Smaller over larger.
inline constexpr std::size_t length_features = feature_names.size() - 1;

/// One value per feature; std::nullopt if a required point is not in the image.
using ImageFeatures = std::array<std::optional<double>, feature_names.size()>;
[[nodiscard]] ImageFeatures features_of(const TargetImage& image);

/// Returns the smaller axis over the larger of the best-fit ellipse of the points. It is the least-squares
/// fit of the conic's equation, in coordinates with equal spread of the points. Exact for points on an
/// ellipse, 0 for points on a line. Returns std::nullopt for fewer than five points, and if another conic
/// fits best.
[[nodiscard]] std::optional<double> axes_ratio(std::span<const Eigen::Vector2d> points);

}  // namespace flexura
