#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/model/arm.h"
#include "flexura/servo/picture_meter.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_features.h"
#include "flexura/servo/shape_observer.h"

namespace flexura {

/// The target shape at one time.
struct TargetShape {
  ArmState state;
  /// Features in the target's recorded pictures minus the features of `state` for nominal cameras; empty:
  /// zero.
  Eigen::VectorXd offset;
};

/// Target shapes of a servo over time. A target given by recorded pictures is measured once, with the cameras
/// at their current axis positions.
class ServoGoals {
 public:
  /// Measures recorded pictures. Afterwards problem() returns why the targets are unusable, or "".
  ServoGoals(const std::vector<ServoGoal>& goals, const Arm& arm, PictureMeter& meter,
             ShapeObserver& observer, ServoFeatures& features, const std::array<View, 2>& views);

  [[nodiscard]] const std::string& problem() const { return problem_; }
  /// Returns the time of the last target, s from the servo's start.
  [[nodiscard]] double last() const { return times_.back(); }
  /// Returns the target at a time, linearly interpolated between the given targets. For a time before the
  /// first target, returns the first target.
  [[nodiscard]] TargetShape at(double time) const;

 private:
  void measure(const PicturePair& recorded, const Arm& arm, PictureMeter& meter, ShapeObserver& observer,
               ServoFeatures& features);
  // Returns the reason why the recorded pictures appear to be in the wrong order, or "".
  [[nodiscard]] std::string wrong_order(const ServoObservation& observed, const PicturePair& recorded,
                                        PictureMeter& meter, const ShapeObserver& observer) const;

  std::vector<double> times_;
  std::vector<TargetShape> shapes_;
  std::string problem_;
};

}  // namespace flexura
