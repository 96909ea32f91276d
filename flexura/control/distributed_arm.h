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

/// An arm with distributed mass, weight and elasticity: the plant in the theory of the paper's section 2. Two
/// continuous angles give the arm's direction (docs/control.md, eq. 1).
struct DistributedArmModel {
  std::vector<double> lengths = {1};  ///< Lengths of the sections at rest, m: l_i0.
  bool has_variable_lengths =
      false;  ///< Whether the sections have lengths l_i0 + u_i(t), with u_i as additional coordinates.
  double density = 1;                       ///< rho: mass per length of the arm at rest, kg/m; > 0.
  Eigen::Vector3d gravity = {0, -9.81, 0};  ///< Gravity in W, m/s^2, in any direction.
  double bending_stiffness = 0;             ///< EI, N m^2; >= 0.
  double axial_stiffness = 0;               ///< EA of variable lengths, N; >= 0.
  double damping =
      0;  ///< Damping coefficient c, N s; >= 0. The medium dissipates the power c |de/dt|^2 per length, W/m.
  double length_damping = 0;  ///< Damping of the rates of the lengths, N s/m; >= 0.
  /// theta and q at the clamped base, rad; std::nullopt: the arm rotates freely about its base point.
  std::optional<std::array<double, 2>> clamp = std::array<double, 2>{0, 0};
  AngleBasis basis = AngleBasis::polynomial;  ///< Basis for both angles.
  int nodes = 10;                             ///< Number of coordinates per angle (polynomial basis).
  int points = 14;                            ///< Quadrature points in each section.
};

/// Equations of motion of a distributed arm. The arm is discretised along s before Lagrange's equations are
/// derived, so that energies and forces are exactly consistent (docs/control.md, "The distributed arm"). The
/// coordinates x are first the coordinates of theta (rad), then those of q (rad), then u_i (m) of variable
/// lengths (see AngleShapes). The magnitude of q must remain below pi/2, where the angles are singular. After
/// construction, only functions that return vectors or matrices by value allocate memory.
class DistributedArm {
 public:
  /// Throws std::invalid_argument for numbers that are out of range or not finite, and for fewer points than
  /// nodes.
  explicit DistributedArm(const DistributedArmModel& model);

  [[nodiscard]] const DistributedArmModel& model() const { return model_; }
  /// Returns the shape functions of both angles. In this class, "the points" are the quadrature points of the
  /// shape functions.
  [[nodiscard]] const AngleShapes& shapes() const { return shapes_; }
  /// Returns the number of all coordinates.
  [[nodiscard]] Eigen::Index size() const { return size_; }
  /// Returns the number of coordinates of each angle.
  [[nodiscard]] Eigen::Index nodes() const { return shapes_.nodes.size(); }
  /// Returns the coordinates for the angles (theta, q), rad, as functions of s (m at rest), with lengths at
  /// rest.
  [[nodiscard]] Eigen::VectorXd coordinates(const std::function<Eigen::Vector2d(double s)>& angles) const;

  /// Sets the state x and its rates v. Throws std::invalid_argument unless both have size() entries.
  void set(const Eigen::VectorXd& x, const Eigen::VectorXd& v);

  // For the current state:

  [[nodiscard]] double kinetic_energy() const;  ///< Returns the kinetic energy T, J.
  /// Returns the potential energy of gravity V_g, J. V_g is 0 if all mass is at the base.
  [[nodiscard]] double gravity_energy() const;
  [[nodiscard]] double elastic_energy() const;  ///< Returns the elastic energy V_e, J.
  /// Returns the dissipated power, W; >= 0.
  [[nodiscard]] double damping_power() const { return rates_.dot(damping_force_); }
  /// Returns dV_g/dx, a generalized force (N m for angles, N for lengths).
  [[nodiscard]] const Eigen::VectorXd& gravity_gradient() const { return gravity_gradient_; }
  /// Returns dV_e/dx, a generalized force (N m for angles, N for lengths).
  [[nodiscard]] const Eigen::VectorXd& elastic_gradient() const { return elastic_gradient_; }
  /// Returns the Hessian of V_g + V_e.
  [[nodiscard]] Eigen::MatrixXd stiffness() const;
  /// Returns the mass matrix M of the coordinates, size() x size(), symmetric: T = 1/2 v . M v.
  [[nodiscard]] Eigen::MatrixXd mass_matrix() const;
  /// Computes the acceleration d^2 x/dt^2 under the generalized forces `force`. Returns false if the
  /// coordinates are singular (|q| = pi/2) or a number is not finite.
  bool accelerate(const Eigen::VectorXd& force, Eigen::VectorXd& acceleration);

  /// Returns the azimuth theta at the points shapes().s, rad.
  [[nodiscard]] const Eigen::VectorXd& theta() const { return theta_; }
  /// Returns the elevation q at the points shapes().s, rad.
  [[nodiscard]] const Eigen::VectorXd& q() const { return q_; }
  /// Returns the arm's direction e at the points shapes().s, one column per point.
  [[nodiscard]] const Eigen::Matrix3Xd& direction() const { return e_; }
  /// Returns the ratio of each section's length to its length at rest.
  [[nodiscard]] const Eigen::VectorXd& stretch() const { return stretch_; }
  /// Returns the positions of the points shapes().s relative to the base, m in W.
  [[nodiscard]] Eigen::Matrix3Xd positions() const;
  /// Returns the position of the tip relative to the base, m in W.
  [[nodiscard]] Eigen::Vector3d tip() const;

 private:
  void set_angles(const Eigen::VectorXd& x, const Eigen::VectorXd& v);
  void set_velocities();
  void set_forces();

  DistributedArmModel model_;
  AngleShapes shapes_;
  Eigen::Index size_, lengths_at_;
  Eigen::MatrixXd root_;   // sqrt(rho W) running: T = |root_ d(stretch e)/dt|^2 / 2.
  Eigen::VectorXd weigh_;  // rho (L - s) w.
  Eigen::VectorXd theta_, q_, theta_s_, q_s_, theta_t_, q_t_, stretch_, stretch_t_, rates_;
  Eigen::Matrix3Xd e_, e_theta_, e_q_, curving_;  // curving_: acceleration of stretch e at constant rates.
  std::array<Eigen::MatrixXd, 3> by_x_;           // d(stretch e)/dx by component, a row per point.
  Eigen::MatrixXd flow_, mass_;                   // root_ by_x_, with the three components stacked.
  Eigen::VectorXd flow_rate_, bias_, point_force_, gravity_gradient_, elastic_gradient_, damping_force_;
  Cholesky factor_;
};

/// Integrates the arm's motion over time, with a force that may depend on x and v.
class DistributedMotion {
 public:
  /// Computes the generalized forces Q on `arm`, which is set to the state (x, v). Returns a power, W, which
  /// is integrated over time: for example, the power dissipated by a law's damping.
  using Force = std::function<double(double t, const DistributedArm& arm, const Eigen::VectorXd& x,
                                     const Eigen::VectorXd& v, Eigen::VectorXd& Q)>;
  /// `tolerance` applies to (x; v) and both integrals. Before start(), the arm is at rest with all
  /// coordinates 0.
  DistributedMotion(DistributedArm arm, Force force, const OdeTolerance& tolerance = {});

  /// Sets the time to 0 and the arm to rest at the coordinates `x`.
  void start(const Eigen::VectorXd& x);
  /// Advances to the time `until`, s. The integrator calls go_on() before every step and stops if go_on()
  /// returns false. An empty go_on never stops the integration. Returns false if go_on() stopped the
  /// integration, if the integrator failed (DormandPrince), or if the arm reached a singularity.
  [[nodiscard]] bool advance(double until, const std::function<bool()>& go_on = {});

  /// Returns the time since the start, s.
  [[nodiscard]] double time() const { return time_; }
  /// Returns the present coordinates.
  [[nodiscard]] const Eigen::VectorXd& x() const { return x_; }
  /// Returns the present rates of the coordinates.
  [[nodiscard]] const Eigen::VectorXd& v() const { return v_; }
  /// Returns the arm in its current state.
  [[nodiscard]] const DistributedArm& arm() const { return arm_; }
  /// Returns the energy that the arm's own damping has dissipated since the start, J.
  [[nodiscard]] double damped() const { return y_[2 * arm_.size()]; }
  /// Returns the integral of the powers that the force function returned, since the start, J.
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
