#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "flexura/control/angle_shapes.h"
#include "flexura/math/dense.h"
#include "flexura/math/dormand_prince.h"

namespace flexura {

/// An arm whose mass, weight and elasticity lie along it, and whose direction is given by two continuous
/// angles (docs/control.md, eq. 1): the plant of the paper's theory (its section 2).
struct DistributedArmModel {
  std::vector<double> lengths = {1};        ///< Of the sections at rest, m: l_i0.
  bool has_variable_lengths = false;        ///< The sections' lengths are l_i0 + u_i(t), u_i coordinates too.
  double density = 1;                       ///< rho: mass a length of the arm at rest, kg/m; > 0.
  Eigen::Vector3d gravity = {0, -9.81, 0};  ///< In W, m/s^2, any direction.
  double bending_stiffness = 0;             ///< EI, N m^2; >= 0.
  double axial_stiffness = 0;               ///< EA of variable lengths, N; >= 0.
  double damping = 0;         ///< c: the medium takes c |de/dt|^2 a length (W/m, rad/s): N s; >= 0.
  double length_damping = 0;  ///< Of the lengths' rates, N s/m; >= 0.
  /// theta and q at the base, rad, where it is clamped; none: it turns freely about its base point.
  std::optional<std::array<double, 2>> clamp = std::array<double, 2>{0, 0};
  AngleBasis basis = AngleBasis::polynomial;  ///< Of both angles.
  int nodes = 10;                             ///< Numbers for each angle (polynomial basis).
  int points = 14;                            ///< Of quadrature in each section.
};

/// The equations of motion of such an arm, discretised along s before Lagrange's equations are taken, so that
/// energies and forces fit each other exactly (docs/control.md, "The distributed arm"). The coordinates x are
/// the two angles' numbers (AngleShapes) and, with variable lengths, the sections' u_i: theta (rad), q (rad),
/// u (m). |q| must stay below pi/2, where the two angles are coordinates at all. After the constructor
/// nothing is allocated, but by what returns vectors or matrices.
class DistributedArm {
 public:
  /// std::invalid_argument: numbers that are out of their range or not finite, fewer points than nodes.
  explicit DistributedArm(const DistributedArmModel& model);

  [[nodiscard]] const DistributedArmModel& model() const { return model_; }
  /// Of each of the two angles; its s are the points that this class speaks of.
  [[nodiscard]] const AngleShapes& shapes() const { return shapes_; }
  /// How many coordinates there are, and how many numbers an angle has.
  [[nodiscard]] Eigen::Index size() const { return size_; }
  [[nodiscard]] Eigen::Index nodes() const { return shapes_.nodes.size(); }
  /// The coordinates of angles (theta, q) at the nodes' s (m at rest), lengths at rest.
  [[nodiscard]] Eigen::VectorXd coordinates(const std::function<Eigen::Vector2d(double s)>& angles) const;

  /// Puts the arm into the state x and its rates v. std::invalid_argument for other sizes.
  void set(const Eigen::VectorXd& x, const Eigen::VectorXd& v);

  // Of the state that was set:

  [[nodiscard]] double kinetic_energy() const;  ///< T, J.
  [[nodiscard]] double gravity_energy() const;  ///< V_g, J; 0 with all mass at the base.
  [[nodiscard]] double elastic_energy() const;  ///< V_e, J.
  /// What damping takes, W; >= 0.
  [[nodiscard]] double damping_power() const { return rates_.dot(damping_force_); }
  /// dV_g/dx and dV_e/dx, generalized forces (N m for angles, N for lengths).
  [[nodiscard]] const Eigen::VectorXd& gravity_gradient() const { return gravity_gradient_; }
  [[nodiscard]] const Eigen::VectorXd& elastic_gradient() const { return elastic_gradient_; }
  /// The Hessian of V_g + V_e.
  [[nodiscard]] Eigen::MatrixXd stiffness() const;
  /// Of the coordinates, size() x size(), symmetric: T = 1/2 v . M v.
  [[nodiscard]] Eigen::MatrixXd mass_matrix() const;
  /// d^2 x/dt^2 under generalized forces. False where the coordinates are singular (|q| = pi/2) or a number
  /// is not finite.
  bool accelerate(const Eigen::VectorXd& force, Eigen::VectorXd& acceleration);

  /// The angles at the points shapes().s, rad, and the arm's direction e there, a column a point.
  [[nodiscard]] const Eigen::VectorXd& theta() const { return theta_; }
  [[nodiscard]] const Eigen::VectorXd& q() const { return q_; }
  [[nodiscard]] const Eigen::Matrix3Xd& direction() const { return e_; }
  /// Lengths over those at rest, one a section.
  [[nodiscard]] const Eigen::VectorXd& stretch() const { return stretch_; }
  /// Of the points, from the base's, and of the tip, m in W.
  [[nodiscard]] Eigen::Matrix3Xd positions() const;
  [[nodiscard]] Eigen::Vector3d tip() const;

 private:
  void set_angles(const Eigen::VectorXd& x, const Eigen::VectorXd& v);
  void set_velocities();
  void set_forces();

  DistributedArmModel model_;
  AngleShapes shapes_;
  Eigen::Index size_, lengths_at_;
  Eigen::MatrixXd root_;   // sqrt(rho W) running: T = |root_ d(stretch e)/dt|^2 / 2
  Eigen::VectorXd weigh_;  // rho (L - s) w
  Eigen::VectorXd theta_, q_, theta_s_, q_s_, theta_t_, q_t_, stretch_, stretch_t_, rates_;
  Eigen::Matrix3Xd e_, e_theta_, e_q_, curving_;  // curving_: the acceleration of stretch e at even rates
  std::array<Eigen::MatrixXd, 3> by_x_;           // d(stretch e)/dx by component, a row a point
  Eigen::MatrixXd flow_, mass_;                   // root_ by_x_, the three components below each other
  Eigen::VectorXd flow_rate_, bias_, point_force_, gravity_gradient_, elastic_gradient_, damping_force_;
  Cholesky factor_;
};

/// Drives the arm through time: x and v as one vector (x; v), a force that may depend on all.
class DistributedMotion {
 public:
  /// Writes the generalized forces Q on `arm`, which is set to its state (x, v), and returns a power (W) of
  /// which the sum is kept: what a law's damping takes.
  using Force = std::function<double(double t, const DistributedArm& arm, const Eigen::VectorXd& x,
                                     const Eigen::VectorXd& v, Eigen::VectorXd& Q)>;
  /// The tolerance is of (x; v) and both sums. At rest at x = 0, all angles 0, until start().
  DistributedMotion(DistributedArm arm, Force force, const OdeTolerance& tolerance = {});

  /// From rest at x at time 0.
  void start(const Eigen::VectorXd& x);
  /// Goes on to the time `until`, s, as long as go_on(), asked before every step of the integrator, says so;
  /// empty: it always does. False: it ended, or could not go on (DormandPrince), or the arm met a
  /// singularity.
  [[nodiscard]] bool advance(double until, const std::function<bool()>& go_on = {});

  /// s since the start; x and its rates then.
  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] const Eigen::VectorXd& x() const { return x_; }
  [[nodiscard]] const Eigen::VectorXd& v() const { return v_; }
  /// The arm, set to its state now.
  [[nodiscard]] const DistributedArm& arm() const { return arm_; }
  /// J since the start: what the arm's own damping took, and the sum of the powers that the force returned.
  [[nodiscard]] double damped() const { return y_[2 * arm_.size()]; }
  [[nodiscard]] double summed() const { return y_[2 * arm_.size() + 1]; }

 private:
  void slope(double t, const Eigen::VectorXd& y, Eigen::VectorXd& slope);

  DistributedArm arm_;
  Force force_;
  DormandPrince ode_;
  double time_ = 0;
  Eigen::VectorXd y_, x_, v_, Q_, acceleration_;
};

}  // namespace flexura
