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

/// Computes features of an arm's images for many states, without memory allocation after the first use.
/// Computes the derivatives from the camera models and the backbone's Jacobian.
class FeatureImages {
 public:
  /// Throws std::invalid_argument for a share outside [0, 1], no features, or moments of fewer than two
  /// points.
  FeatureImages(const Arm& arm, FeatureSet set);

  [[nodiscard]] const FeatureSet& set() const { return set_; }
  /// Returns the images of the features' points, in the last state.
  [[nodiscard]] const PointImages& points() const { return points_; }

  /// Computes the features in all cameras, camera by camera. Returns false if a needed point is outside a
  /// lens's valid field, or if an image has no direction or length. Throws std::invalid_argument for a state
  /// that does not fit the arm, and without cameras.
  [[nodiscard]] bool values(const ArmState& state, std::span<const View> views, Eigen::VectorXd& values);
  /// Computes the features and their derivatives with respect to the state. The columns are bend_x, bend_y
  /// (rad) and stretch of each section.
  [[nodiscard]] bool derive(const ArmState& state, std::span<const View> views, Eigen::VectorXd& values,
                            Eigen::MatrixXd& by_state);

 private:
  using Rows = Eigen::Ref<Eigen::MatrixXd>;
  // NOLINTBEGIN(performance-unnecessary-value-param): an Eigen::Ref is written through.
  [[nodiscard]] bool write_values(Eigen::Ref<Eigen::VectorXd> values);
  // Computes the features' rows from the pixels' two rows per point.
  void write_rows(const Eigen::MatrixXd& by, Rows rows) const;
  // NOLINTEND(performance-unnecessary-value-param)

  FeatureSet set_;
  // Indices in points_ of the feature points, and of the chords' ends.
  std::vector<Eigen::Index> at_;
  std::vector<std::array<Eigen::Index, 2>> ends_;
  Eigen::Index first_corner_ = 0;
  PointImages points_;
  Eigen::Matrix2Xd pixels_;
  Eigen::MatrixXd by_;
  CurveMoments moments_;
};

}  // namespace flexura
