#pragma once

#include "flexura/base/field.h"

namespace flexura {

// Ranges of lens parameters in files.
inline constexpr NumberRange focal_length_range = {.min = 1e-3, .max = 1e7};  ///< Range of focal lengths, px.
/// Range of the principal point's coordinates, px.
inline constexpr NumberRange principal_point_range = {.min = -1e7, .max = 1e7};
/// Range of each distortion coefficient. Calibrations of lenses with long focal lengths can yield
/// coefficients above 10,000.
inline constexpr NumberRange distortion_range = {.min = -1e9, .max = 1e9};

/// Description of the field `model` of a lens in files.
inline constexpr const char* lens_model_meaning =
    "Lens model: brown (Brown-Conrady), rational, or fisheye (equidistant), as in OpenCV.";
/// Description of the field `distortion` of a lens in files.
inline constexpr const char* distortion_meaning =
    "Distortion coefficients in OpenCV's order: k1, k2, p1, p2, k3 for brown; k1, k2, p1, p2, k3, k4, k5, k6 "
    "for rational; k1, k2, k3, k4 for fisheye.";

/// Returns the specification of a field with distortion coefficients.
[[nodiscard]] inline Spec distortion_spec(const char* meaning, const char* default_text) {
  return {.meaning = meaning, .range = distortion_range, .count = {4, 8}, .default_text = default_text};
}

}  // namespace flexura
