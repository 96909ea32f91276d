#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flexura/app/scene_arguments.h"
#include "flexura/app/threshold_arguments.h"
#include "flexura/base/image.h"
#include "flexura/base/node.h"
#include "flexura/camera/measured_camera.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// Objects that `flexura measure` can find.
enum class MeasureTarget { arm, etalon, circle, markers };
const std::vector<std::string>& names_of(const MeasureTarget*);

/// Settings for measuring one picture.
struct MeasureConfig {
  MeasureTarget what = MeasureTarget::arm;
  ArmFinderConfig finder;
  /// The camera that took the picture, if known; its pose is not used.
  std::optional<MeasuredCamera> camera;
  std::optional<double> radius;  ///< Radius of the arm, m, if known.
  double gamma = 1;  ///< A pixel value is light to the power 1/gamma. Replaces the camera's gamma.
};

/// The result of measuring one picture.
struct Measurement {
  Node answer;            ///< The answer described in docs/vision.md, "flexura measure".
  bool is_found = false;  ///< Whether the object was found.
  /// RGB picture with the findings drawn over it, if requested.
  Image<std::uint8_t> overlay;
};

/// Measures a picture file, given its bytes. Throws InputError if the picture cannot be read, or its size
/// differs from that in its camera's description.
[[nodiscard]] Measurement measure_picture(std::span<const std::uint8_t> file, const std::string& name,
                                          const MeasureConfig& config, bool with_overlay = false);

/// Arguments of `flexura measure`.
struct MeasureArguments {
  std::vector<std::string> images;
  std::string what = "arm";
  std::string camera;  ///< File of measured cameras; "": no file.
  std::optional<double> radius;
  /// Gamma of the pictures. Default: the gamma in the file of cameras, or 1 without a file.
  std::optional<double> gamma;
  ThresholdArguments threshold;
  SceneArguments scene;
  std::vector<double> base;  ///< Pixel of the arm's base, (u, v), px; empty: unknown.
  std::string overlay;       ///< Picture file to write; "": no file.
};

/// Prints the measurements: one JSON document for one picture, or one line of JSON per picture for several.
/// Returns exit_missed if an object was not found. Returns exit_bad_input if one of several files is not a
/// picture; its line then has the error. Throws InputError for bad input, and std::runtime_error if a file
/// cannot be written.
int measure_command(const MeasureArguments& arguments, std::ostream& out);

}  // namespace flexura
