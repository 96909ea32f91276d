#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flexura/app/threshold_arguments.h"
#include "flexura/base/image.h"
#include "flexura/base/node.h"
#include "flexura/camera/measured_camera.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// What `flexura measure` looks for.
enum class MeasureTarget { arm, etalon, circle, markers };
const std::vector<std::string>& names_of(const MeasureTarget*);

/// How one picture is measured.
struct MeasureConfig {
  MeasureTarget what = MeasureTarget::arm;
  ArmFinderConfig finder;
  /// That took it, when it is known; where it stands counts for nothing.
  std::optional<MeasuredCamera> camera;
  std::optional<double> radius;  ///< Of the arm, m, when it is known.
  double gamma = 1;              ///< The picture's values are light to the power 1/gamma; not the camera's.
};

/// What is found in one picture.
struct Measurement {
  Node answer;            ///< docs/vision.md, "flexura measure".
  bool is_found = false;  ///< What was looked for.
  /// The picture with what was found drawn over it, when that was asked for: red, green, blue.
  Image<std::uint8_t> overlay;
};

/// Measures a picture file's bytes. InputError: not a picture that can be read, or
/// one of another size than its camera is described for.
[[nodiscard]] Measurement measure_picture(std::span<const std::uint8_t> file, const std::string& name,
                                          const MeasureConfig& config, bool with_overlay = false);

/// What `flexura measure` is told.
struct MeasureArguments {
  std::vector<std::string> images;
  std::string what = "arm";
  std::string camera;  ///< A file of measured cameras; "" for none.
  std::optional<double> radius;
  std::optional<double> gamma;  ///< What the file of cameras says, or 1, where there is none.
  ThresholdArguments threshold;
  std::vector<double> base;  ///< Two numbers, or none.
  std::string overlay;       ///< A file to write; "" for none.
};

/// Prints what is found: one document for one picture, a line of JSON for each of several. Returns
/// exit_missed when something was not found, exit_bad_input when one of several files is no picture (its line
/// says so). InputError for bad input; std::runtime_error when the system refuses a file.
int measure_command(const MeasureArguments& arguments, std::ostream& out);

}  // namespace flexura
