#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/control/interaction.h"
#include "flexura/control/point_images.h"
#include "flexura/control/shape_features.h"
#include "flexura/model/arm.h"

namespace flexura {

/// The features of one arm's images, state after state, without allocation after the first time, and their
/// derivatives through the cameras' own models and the backbone's Jacobian.
class FeatureImages {
 public:
  /// std::invalid_argument: a share outside [0, 1], no features, moments of fewer than two points.
  FeatureImages(const Arm& arm, FeatureSet set);

  [[nodiscard]] const FeatureSet& set() const { return set_; }
  /// The points behind the features, set to the state last seen.
  [[nodiscard]] const PointImages& points() const { return points_; }

  /// What all cameras see, camera by camera. False where a lens shows a needed point nowhere, or an image has
  /// no direction or length. std::invalid_argument: a state that does not fit, no cameras.
  [[nodiscard]] bool values(const ArmState& state, std::span<const View> views, Eigen::VectorXd& values);
  /// And its derivatives by the state; columns are each section's bend_x, bend_y (rad), stretch.
  [[nodiscard]] bool derive(const ArmState& state, std::span<const View> views, Eigen::VectorXd& values,
                            Eigen::MatrixXd& by_state);

 private:
  using Rows = Eigen::Ref<Eigen::MatrixXd>;
  // NOLINTBEGIN(performance-unnecessary-value-param): an Eigen::Ref is written through.
  [[nodiscard]] bool write_values(Eigen::Ref<Eigen::VectorXd> values);
  // The features' rows from the pixels' two rows a point.
  void write_rows(const Eigen::MatrixXd& by, Rows rows) const;
  // NOLINTEND(performance-unnecessary-value-param)

  FeatureSet set_;
  // Places among the points: of the points that count, and of the chords' ends.
  std::vector<Eigen::Index> at_;
  std::vector<std::array<Eigen::Index, 2>> ends_;
  Eigen::Index first_corner_ = 0;
  PointImages points_;
  Eigen::Matrix2Xd pixels_;
  Eigen::MatrixXd by_;
  CurveMoments moments_;
};

}  // namespace flexura
