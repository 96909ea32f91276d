#pragma once

#include <optional>
#include <string>

#include "flexura/vision/threshold.h"

namespace flexura {

/// Command-line arguments for separating foreground and background.
struct ThresholdArguments {
  std::optional<std::string> method = {};  ///< Name of the thresholding method; default: otsu.
  /// Threshold from 0 to 255. If no method is given, a level selects the method `fixed`.
  std::optional<double> level = {};
  /// Brightness of the arm, "dark" or "bright"; "": the opposite of the picture's border.
  std::string figure = {};
};

/// Returns the checked settings for the arguments. Throws InputError for unknown words, and for a level out
/// of range or given with another method than `fixed`.
[[nodiscard]] ThresholdConfig threshold_config(const ThresholdArguments& arguments);

}  // namespace flexura
