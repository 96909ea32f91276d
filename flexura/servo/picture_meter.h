#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "flexura/camera/view.h"
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
  /// arm, or the reason why no arm was found.
  [[nodiscard]] ServoObservation measure(const PicturePair& pair);

 private:
  [[nodiscard]] Observation observation(std::size_t i, const Picture& picture, const View& view,
                                        std::string& reason);

  Eigen::Vector3d base_;            // p_WB
  std::array<int, 2> whites_ = {};  // Largest pixel value of each camera's pictures.
  bool has_markers_;
  ViewPrior view_prior_;
  struct Finder {
    Eigen::Vector2d base;
    ArmFinder finder;
  };
  std::array<std::optional<Finder>, 2> finders_;
};

}  // namespace flexura
