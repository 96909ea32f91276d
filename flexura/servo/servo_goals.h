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

/// What is wanted at one time.
struct WantedShape {
  ArmState state;
  /// How far recorded pictures are from what cameras as believed would have seen of `state`; empty: nothing.
  Eigen::VectorXd offset;
};

/// A servo's goals as shapes: recorded pictures are measured once, with the cameras as they stand.
class ServoGoals {
 public:
  /// `problem` says why not, "" if nothing is wrong.
  ServoGoals(const std::vector<ServoGoal>& goals, const Arm& arm, PictureMeter& meter,
             ShapeObserver& observer, ServoFeatures& features, const std::array<View, 2>& views);

  [[nodiscard]] const std::string& problem() const { return problem_; }
  /// s from the servo's start, when the last goal is reached by what is wanted.
  [[nodiscard]] double last() const { return times_.back(); }
  /// In straight lines between two goals; the first before all of them.
  [[nodiscard]] WantedShape at(double time) const;

 private:
  void measure(const PicturePair& recorded, const Arm& arm, PictureMeter& meter, ShapeObserver& observer,
               ServoFeatures& features);
  // Why pictures that were seen so are to be given in the other order; "" where they are not.
  [[nodiscard]] std::string wrong_order(const ServoSight& sight, const PicturePair& recorded,
                                        PictureMeter& meter, const ShapeObserver& observer) const;

  std::vector<double> times_;
  std::vector<WantedShape> shapes_;
  std::string problem_;
};

}  // namespace flexura
