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

/// Features from one source, one item per value of the parameter.
struct StudyColumn {
  std::string_view source;  ///< "formula", "rendered", "measured"; its features are "top_formula", ...
  std::vector<ImageFeatures> features;
};

/// Result of a study.
struct ImageStudy {
  std::string name;
  std::string camera;
  Variation variation;
  int width = 0, height = 0;         ///< Size of the camera's image, px.
  std::vector<double> values;        ///< Values of the parameter, in base units.
  std::vector<TargetImage> images;   ///< By the formulas, one per value.
  std::vector<StudyColumn> columns;  ///< By the formulas, the renderer's truth, and optionally in pictures.

  /// Returns true if the whole target is inside the image at value i.
  [[nodiscard]] bool in_image(std::size_t i) const;
  /// Returns true if every feature has a value there, by the formulas.
  [[nodiscard]] bool is_seen(std::size_t i) const;
  /// Returns the largest differences between formulas and renderer: of the lengths, px, and of the ratio of
  /// axes. Infinite if only one of them has a value.
  [[nodiscard]] std::array<double, 2> largest_difference() const;
  /// Number of lengths measured in pictures, and the root mean square of their differences from the
  /// formulas', px; zeros without measurements.
  struct Measured {
    std::size_t count = 0;
    double rms = 0;
  };
  [[nodiscard]] Measured measured_difference() const;
};

/// Makes a study that check_study has accepted, with the camera of that name among `cameras` at its initial
/// axis positions. The noise of its pictures depends on `seed`, the camera's index and the value's.
/// `progress` may be null; it cannot end the study.
[[nodiscard]] ImageStudy study_images(const StudyTask& task, const std::vector<CameraConfig>& cameras,
                                      std::uint64_t seed, Progress* progress = nullptr);

}  // namespace flexura
