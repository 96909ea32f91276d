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

/// How a shape is looked for.
struct EstimateConfig {
  ShapePrior prior;  ///< What is known of the arm.
  ThresholdConfig threshold;
  EstimatorConfig estimator;
  std::size_t points = 101;  ///< Of the backbone, as it is told; at least 2.
  bool has_bends = false;    ///< Whether the bends of the prior's sections are told: they are the arm's.
};

/// What `flexura estimate` is told.
struct EstimateArguments {
  std::vector<std::string> images;  ///< One a camera, in the cameras' order.
  std::string cameras;              ///< A file of measured cameras.
  std::vector<double> base;         ///< p_WB, three numbers; none: not known.
  std::optional<double> length;     ///< m.
  std::string arm;                  ///< A file with the arm's sections; "" for none.
  /// Where the arm's bands are: arc lengths, m ("0.25"), or shares of its length ("25%"); empty: not known.
  std::vector<std::string> markers;
  ThresholdArguments threshold;
  std::int64_t points = 101;  ///< Of the backbone, as it is printed.
};

/// InputError for what is wrong whatever the files say.
void check_arguments(const EstimateArguments& arguments);

/// The same, as it is looked for. InputError naming the argument that is wrong, or the place in the arm's
/// file.
[[nodiscard]] EstimateConfig estimate_config(const EstimateArguments& arguments);

/// The cameras of a file, checked for two to meet. InputError: a camera without a
/// place, all of them at one, other than `count` of them.
[[nodiscard]] std::vector<MeasuredCamera> standing_cameras(const Node& file, std::size_t count);

}  // namespace flexura
