#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/app/threshold_arguments.h"
#include "flexura/base/node.h"
#include "flexura/camera/measured_camera.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/estimate/shape_variables.h"
#include "flexura/vision/threshold.h"

namespace flexura {

/// Settings of the shape estimation.
struct EstimateConfig {
  ShapePrior prior;  ///< Prior knowledge about the arm.
  ThresholdConfig threshold;
  EstimatorConfig estimator;
  std::size_t points = 101;  ///< Number of backbone points in the answer; at least 2.
  bool has_bends = false;    ///< Whether the answer has the bends of a described arm's sections.
};

/// Arguments of `flexura estimate`.
struct EstimateArguments {
  std::vector<std::string> images;  ///< Picture files, one per camera, in the cameras' order.
  std::string cameras;              ///< File of measured cameras.
  std::vector<double> base;         ///< p_WB, m: three numbers; empty: unknown.
  std::optional<double> length;     ///< Length of the arm, m.
  std::string arm;                  ///< File that describes the arm; "": no file.
  /// Positions of the arm's bands: arc lengths, m ("0.25"), or shares of the length ("25%"). Empty: unknown.
  std::vector<std::string> markers;
  ThresholdArguments threshold;
  std::int64_t points = 101;  ///< Number of backbone points to print.
};

/// Throws InputError for arguments that are wrong independent of the files' contents.
void check_arguments(const EstimateArguments& arguments);

/// Returns the settings for the arguments. Throws InputError with the wrong argument, or with the position in
/// the arm's file.
[[nodiscard]] EstimateConfig estimate_config(const EstimateArguments& arguments);

/// Returns the cameras of a file, checked for use in triangulation. Throws InputError for a camera without
/// position or rotation, if all cameras are at one position, or if the file does not have `count` cameras.
[[nodiscard]] std::vector<MeasuredCamera> standing_cameras(const Node& file, std::size_t count);

}  // namespace flexura
