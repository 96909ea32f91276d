#pragma once

#include <optional>
#include <string>

#include "flexura/vision/threshold.h"

namespace flexura {

/// How figure and ground are told apart, as the command line says it.
struct ThresholdArguments {
  std::optional<std::string> method = {};  ///< Left out: otsu.
  std::optional<double> level = {};        ///< 0 to 255; with no method it is `fixed`.
  std::string figure = {};                 ///< "dark" or "bright"; "": as the picture's border tells.
};

/// The same, checked. InputError: unknown words, a level outside its range or beside another method.
[[nodiscard]] ThresholdConfig threshold_config(const ThresholdArguments& arguments);

}  // namespace flexura
