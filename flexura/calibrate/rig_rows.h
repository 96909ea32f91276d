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

/// How far one image is from what a rig would show: residuals in units of their standard deviations, and
/// their derivatives by those of x's numbers that matter to it.
struct RigRows {
  std::vector<Eigen::Index> columns;  ///< Of x.
  Eigen::VectorXd residuals;          ///< (shown - seen)/sigma.
  Eigen::MatrixXd derivatives;        ///< A row a residual, a column for each of `columns`.
  /// Rows of each thing that was seen: 2 of a marker, then 1 of an axis point, then 1 of an etalon's point.
  std::vector<int> sizes;
};

/// A rig as x says it is, and how its images would be.
class RigProjector {
 public:
  /// `variables` outlives it.
  RigProjector(const RigVariables& variables, const Eigen::VectorXd& x,
               const std::optional<EtalonConfig>& etalon = {});

  /// False where the rig would not show all that was seen: behind a camera, or outside what its lens maps.
  [[nodiscard]] bool rows(const RigImage& image, RigRows& rows);

  /// A point of the arm as a stance shows it, with derivatives by all slots of the camera, the arm, the pose
  /// and the stance, in that order.
  struct Shown {
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, Eigen::Dynamic> by_slots;
  };
  [[nodiscard]] std::optional<Shown> show(std::size_t pose, std::size_t stance, const MaterialPoint& point);
  /// What a stance sees, and where it stands in truth.
  [[nodiscard]] View view(std::size_t stance) const;

 private:
  void add_camera_slots(const CameraProjection& projection, std::size_t stance, Shown& shown) const;
  void add_arm_slots(const CameraProjection& projection, std::size_t pose, Shown& shown) const;
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
  std::vector<RigStance> stances_;  // in truth, zeros added
  std::vector<Shape> shapes_;
  std::vector<BackboneJacobian> jacobians_;
  Jacobian jacobian_;
  SpaceCurve curve_;
  CurveImage image_;
  std::optional<EtalonFigure> etalon_;
  std::vector<Eigen::Index> picked_;  // local slots that have columns
};

}  // namespace flexura
