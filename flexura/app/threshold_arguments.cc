#include "flexura/app/threshold_arguments.h"

#include <fmt/format.h>

#include <string>

#include "flexura/app/words.h"
#include "flexura/base/source.h"

namespace flexura {

ThresholdConfig threshold_config(const ThresholdArguments& arguments) {
  ThresholdConfig config;
  config.method = named<ThresholdMethod>("--threshold", arguments.method.value_or("otsu"));
  if (!arguments.figure.empty()) config.figure = named<Figure>("--figure", arguments.figure);
  if (!arguments.level) {
    if (config.method == ThresholdMethod::fixed)
      throw input_error("--threshold", "\"fixed\" needs --level, from 0 to 255");
    return config;
  }
  const bool is_level = *arguments.level >= 0 && *arguments.level <= 255;
  if (!is_level) throw input_error("--level", fmt::format("{}: expected 0 to 255", *arguments.level));
  if (arguments.method && config.method != ThresholdMethod::fixed)
    throw input_error(
        "--level", fmt::format("needs --threshold fixed: \"{}\" computes its own level", *arguments.method));
  config.method = ThresholdMethod::fixed;
  config.level = *arguments.level;
  return config;
}

}  // namespace flexura
