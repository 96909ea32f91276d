#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "flexura/calibrate/rig_observations.h"
#include "flexura/calibrate/rig_variables.h"
#include "flexura/camera/camera.h"
#include "flexura/estimate/curve_image.h"
#include "flexura/estimate/space_curve.h"
#include "flexura/kinematics/jacobian.h"

namespace flexura {

/// Residuals of one image in standard deviations, and their derivatives with respect to the relevant
/// variables of x.
struct RigRows {
  std::vector<Eigen::Index> columns;  ///< Indices of the relevant variables in x.
  Eigen::VectorXd residuals;          ///< (predicted - observed)/sigma.
  Eigen::MatrixXd derivatives;        ///< One row per residual, one column for each of `columns`.
  /// Number of rows of each observation: 2 per marker, then 1 per axis point, then 1 per etalon point.
  std::vector<int> sizes;
};

/// Predicts images of the rig that x describes.
class RigProjector {
 public:
  /// `variables` must outlive this object.
  RigProjector(const RigVariables& variables, const Eigen::VectorXd& x,
               const std::optional<EtalonConfig>& etalon = {});

  /// Computes the rows of an image. Returns false if an observed point would be invisible for the rig: behind
  /// the camera, or outside the range of the lens.
  [[nodiscard]] bool rows(const RigImage& image, RigRows& rows);

  /// Image of a point of the arm for a stance. The derivatives of the image are with respect to all slots, in
  /// the order camera, arm, pose, stance.
  struct Shown {
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, Eigen::Dynamic> by_slots;
  };
  [[nodiscard]] std::optional<Shown> show(std::size_t pose, std::size_t stance, const MaterialPoint& point);
  /// Returns the view of a stance at its estimated position.
  [[nodiscard]] View view(std::size_t stance) const;

 private:
  void add_camera_slots(const CameraProjection& projection, std::size_t stance, Shown& shown) const;
  void add_arm_slots(const CameraProjection& projection, std::size_t pose, std::size_t stance,
                     Shown& shown) const;
  [[nodiscard]] bool is_in_range(std::size_t stance) const;
  [[nodiscard]] bool add_markers(const RigImage& image, RigRows& rows);
  [[nodiscard]] bool add_points(const RigImage& image, RigRows& rows);
  [[nodiscard]] bool add_etalon(const RigImage& image, RigRows& rows);
  void set_row(Eigen::Index row, const Shown& shown, const Eigen::Vector2d& way, const Eigen::Vector2d& seen,
               double sigma, RigRows& rows) const;

  const RigVariables* variables_;
  Eigen::VectorXd x_;
  std::vector<CameraConfig> models_;
  std::vector<Camera> cameras_;
  std::vector<RigStance> stances_;  // True positions, with zero offsets added.
  std::vector<Shape> shapes_;
  std::vector<BackboneJacobian> jacobians_;
  Jacobian jacobian_;
  SpaceCurve curve_;
  CurveImage image_;
  std::optional<EtalonFigure> etalon_;
  std::vector<Eigen::Index> picked_;  // Local slots that have a column in x.
};

}  // namespace flexura
