#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/app/scene_arguments.h"
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
  /// What separates the arm from its surroundings in each picture; empty or null: brightness alone.
  std::vector<std::shared_ptr<const ArmScene>> scenes;
  EstimatorConfig estimator;
  /// Guessed shape near which the tube is fitted; missing: the arm is found by its figures in the pictures.
  std::optional<Shape> guess;
  double guess_std = 0.1;    ///< Standard deviation of each bend of the guess, rad.
  std::size_t points = 101;  ///< Number of backbone points in the answer; at least 2.
  /// Whether the answer includes the bends of the sections; the arm's file must then describe the sections.
  bool has_bends = false;
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
  SceneArguments scene;
  std::string guess;                ///< JSON file with the guessed bends; "": none.
  std::optional<double> guess_std;  ///< Standard deviation of each guessed bend, rad; default: 0.1.
  std::int64_t points = 101;        ///< Number of backbone points to print.
};

/// Checks the arguments without reading the files. Throws InputError for wrong arguments.
void check_arguments(const EstimateArguments& arguments);

/// Returns the settings for the arguments. Throws InputError that names the wrong argument or the position of
/// the error in the arm's file.
[[nodiscard]] EstimateConfig estimate_config(const EstimateArguments& arguments);

/// Returns the cameras of a file, which can triangulate points. Throws InputError for a camera without
/// position or rotation, for cameras that are all at one position, and for a file without exactly `count`
/// cameras.
[[nodiscard]] std::vector<MeasuredCamera> standing_cameras(const Node& file, std::size_t count);

}  // namespace flexura
