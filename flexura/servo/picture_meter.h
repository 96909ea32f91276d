#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "flexura/camera/view.h"
#include "flexura/estimate/shape_variables.h"
#include "flexura/estimate/tube_fit.h"
#include "flexura/port/rig_model.h"
#include "flexura/servo/rig_reader.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_observation.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// Measures the arm in the pictures of two cameras.
class PictureMeter {
 public:
  PictureMeter(const RigModel& nominal, const ServoConfig& config);

  /// Returns an observation without an estimated shape. For each picture, the observation has the measured
  /// arm, or the reason why no arm was found. `prediction`: predicted shape at the time of the pictures, for
  /// the setting ServoTracking::model; it is not used with other settings. `expected`: predicted shape from
  /// which the arm is tracked in the pictures with the other settings.
  [[nodiscard]] ServoObservation measure(const PicturePair& pair,
                                         const std::optional<ShapePrediction>& prediction = {},
                                         const std::optional<Shape>& expected = {});

 private:
  // Fits the tube of the predicted shape. Returns false if the fit is not trusted.
  bool follow(const PicturePair& pair, const ShapePrediction& prediction, ServoObservation& observed);
  [[nodiscard]] Observation observation(std::size_t i, const Picture& picture, const View& view,
                                        const std::optional<Shape>& expected, std::string& reason);

  Eigen::Vector3d base_;            // p_WB
  std::array<int, 2> whites_ = {};  // Largest pixel value of each camera's pictures.
  bool has_markers_;
  std::optional<TubeFitter> fitter_;  // With ServoTracking::model.
  std::array<std::shared_ptr<const ArmScene>, 2> scenes_;
  ViewPrior view_prior_;
  struct Finder {
    Eigen::Vector2d base;
    ArmFinder finder;
    std::optional<ThresholdMethod> method = {};  // By which the arm was found last.
    int blind = 0;                               // Number of pictures without arm since then.
  };
  std::array<std::optional<Finder>, 2> finders_;
};

}  // namespace flexura
