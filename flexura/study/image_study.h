#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/camera/camera_config.h"
#include "flexura/study/image_features.h"
#include "flexura/study/study_config.h"
#include "flexura/study/study_target.h"

namespace flexura {

/// Features as one source has them, one entry a value of the parameter.
struct StudyColumn {
  std::string_view source;  ///< "formula", "rendered", "measured"; its features are "top_formula", ...
  std::vector<ImageFeatures> features;
};

/// What a study found.
struct ImageStudy {
  std::string name;
  std::string camera;
  Variation variation;
  int width = 0, height = 0;        ///< Of the camera's image, px.
  std::vector<double> values;       ///< Of the parameter, in base units.
  std::vector<TargetImage> images;  ///< By the formulas, one a value.
  std::vector<StudyColumn>
      columns;  ///< By the formulas, the renderer's truth, and, if asked for, in pictures.

  /// Whether the whole target is inside the image at value i.
  [[nodiscard]] bool in_image(std::size_t i) const;
  /// Whether every feature could be measured there, by the formulas.
  [[nodiscard]] bool is_seen(std::size_t i) const;
  /// The largest difference between formulas and renderer where both have a value: of the lengths, px, and of
  /// the ratio of axes. Infinite where one has a value that the other lacks.
  [[nodiscard]] std::array<double, 2> largest_difference() const;
  /// How many lengths were measured in pictures, and the root mean square of their differences from the
  /// formulas', px; zeros when none was.
  struct Measured {
    std::size_t count = 0;
    double rms = 0;
  };
  [[nodiscard]] Measured measured_difference() const;
};

/// Makes a study that check_study has passed, through the camera of that name among `cameras`, from where it
/// stands at the start. The noise of its pictures is that of `seed`, the camera's place and the value's.
[[nodiscard]] ImageStudy study_images(const StudyTask& task, const std::vector<CameraConfig>& cameras,
                                      std::uint64_t seed);

}  // namespace flexura
