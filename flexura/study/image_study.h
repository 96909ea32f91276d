#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/camera/camera_config.h"
#include "flexura/study/image_features.h"
#include "flexura/study/study_config.h"
#include "flexura/study/study_target.h"

namespace flexura {

/// Features from one source, for all values of the study's parameter.
struct StudyColumn {
  /// Source: "formula", "rendered" or "measured". Result files name features "top_formula", ...
  std::string_view source;
  std::vector<ImageFeatures> features;  ///< Features for each value of the parameter.
};

/// Result of a study of a target's image.
struct ImageStudy {
  std::string name;
  std::string camera;
  Variation variation;
  int width = 0, height = 0;   ///< Size of the camera's image, px.
  std::vector<double> values;  ///< Values of the parameter, in base units.
  std::vector<TargetImage>
      images;  ///< Image of the target for each value, computed by the projection formulas.
  /// Features from the projection formulas, from the renderer's geometry, and optionally measured in
  /// pictures.
  std::vector<StudyColumn> columns;

  /// Returns whether the whole target is inside the image for the value i.
  [[nodiscard]] bool in_image(std::size_t i) const;
  /// Returns whether the projection formulas give every feature for the value i.
  [[nodiscard]] bool is_seen(std::size_t i) const;
  /// Returns the largest differences between formulas and renderer: of lengths, px, and of the ratio of axes.
  /// A difference is infinite if only one of the two has a value.
  [[nodiscard]] std::array<double, 2> largest_difference() const;
  /// Number of lengths measured in pictures, and the root mean square of their differences from the formulas,
  /// px. Both numbers are 0 without measurements.
  struct Measured {
    std::size_t count = 0;
    double rms = 0;
  };
  [[nodiscard]] Measured measured_difference() const;
};

/// Runs a study for which check_study() reported no error. The study's camera is in `cameras` and has its
/// initial axis positions. The noise in pictures depends on `seed`, the camera's index and the value's index.
/// `progress` may be null; it cannot cancel the study.
[[nodiscard]] ImageStudy study_images(const StudyTask& task, const std::vector<CameraConfig>& cameras,
                                      std::uint64_t seed, Progress* progress = nullptr);

}  // namespace flexura
