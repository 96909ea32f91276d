#pragma once

#include <optional>
#include <string>

#include "flexura/vision/threshold.h"

namespace flexura {

/// Command-line arguments for separating foreground and background.
struct ThresholdArguments {
  std::optional<std::string> method = {};  ///< Name of the method; default: otsu.
  std::optional<double> level = {};        ///< Level from 0 to 255; without a method, it implies `fixed`.
  std::string figure = {};  ///< Figure, "dark" or "bright"; "": decided from the picture's border.
};

/// Returns the checked settings for the arguments. Throws InputError for unknown words, and for a level out
/// of range or given with another method than `fixed`.
[[nodiscard]] ThresholdConfig threshold_config(const ThresholdArguments& arguments);

}  // namespace flexura
