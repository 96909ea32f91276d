#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "flexura/math/se3.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"
#include "flexura/mechanics/rod_energy.h"
#include "flexura/mechanics/rod_surroundings.h"
#include "flexura/mechanics/statics.h"

namespace flexura {

/// Settings of the time integration.
struct RodDynamicsConfig {
  /// Factor by which one step reduces motion that is much faster than the step, from 0 to 1. With 1 there is
  /// no numerical damping: the step is the implicit midpoint rule. Steps with values near 1 are more
  /// accurate. But if the steps are longer than the periods of an undamped rod, its energy may grow for
  /// values much above 0.1.
  double spectral_radius = 0.1;
  /// Tolerance of the equations of a step, rad/s. The energy of the remaining errors of the rates is at most
  /// the energy of the whole rod rotating at this rate.
  double tolerance = 1e-7;
  int most_iterations = 30;
  /// A step that does not converge is repeated with spectral radius 0 and halved repeatedly, until each piece
  /// converges. The shortest piece is the step divided by this number, a power of 2. 1: steps are not
  /// divided.
  int most_pieces = 65536;
  /// Whether cross-sections have rotary inertia. Without rotary inertia a rod must not twist.
  bool rotary_inertia = true;
  /// Stiffness of tendon friction before sliding, relative to the rod's stiffness against a pull of this
  /// tendon. Let d be the tendon displacement that corresponds to the bend caused by the tension. A sticking
  /// tendon moves elastically by about d times friction coefficient times wrap angle, divided by this number.
  double friction_grip = 100;
};

/// How a step ended.
enum class DynamicsEnd {
  converged,
  /// The input is invalid: a number is not finite, a tension is below 0, a list has a wrong length, or the
  /// step is 0.
  bad_input,
  did_not_converge,  ///< The step is too long for the loads.
};
/// Returns a description for users.
[[nodiscard]] const char* words(DynamicsEnd end);

struct RodStepFactor;

/// State of a moving rod: `time`, `q`, `momentum` and `friction`. The other fields are internal data of the
/// integrator.
struct RodState {
  double time = 0;               ///< s
  Eigen::VectorXd q;             ///< Strain modes, as in RodChain.
  Eigen::VectorXd momentum;      ///< p = M(q) v.
  std::vector<double> tensions;  ///< Tensions of the last step at the base, N.
  /// Friction forces on the tendons with friction, N. The forces along the first tendon come first, from the
  /// base on, then the forces along the next tendon. Friction forces are part of the state.
  std::vector<double> friction;

  Eigen::VectorXd rate;   ///< dq/dt of the integrator.
  Eigen::VectorXd force;  ///< dp/dt of the integrator.
  /// Rates in the last steps, newest first. The next step starts its iteration from these rates.
  std::array<Eigen::VectorXd, 3> middle;
  int middles = 0;           ///< Number of valid entries of `middle`.
  double step = 0;           ///< Length of the last step, s.
  double contraction = 0.1;  ///< Contraction factor of the last step's iterations.
  /// Factored derivative of a recent step of a rod with tendon friction; null if there was none.
  std::shared_ptr<const RodStepFactor> factor = {};
};

/// Earlier state of tendon friction, from which the present state is computed.
struct RodSlide {
  std::vector<double> friction = {};  ///< Friction forces in the earlier state, as in RodState.
  /// Time since the earlier state, s. In this time tendons are assumed to slide at their present rate.
  double time = 0;
};

/// Result of a step.
struct RodStep {
  DynamicsEnd end = DynamicsEnd::converged;
  std::string problem = {};  ///< Description of bad input.
  int iterations = 0;        ///< Number of linear systems solved.
  int pieces = 1;  ///< Number of pieces that the step was divided into; 0: the step did not converge.
  /// Whether the first attempt failed to converge (RodDynamicsConfig::most_pieces).
  bool is_anew = false;
  /// Work done against tendon friction, J. The work includes energy that is stored elastically before
  /// sliding.
  double friction_work = 0;
  double friction_loss = 0;  ///< Dissipated part of friction_work, never below 0, J.

  [[nodiscard]] bool converged() const { return end == DynamicsEnd::converged; }
};

/// A point mass that a rod in motion picks up.
struct RodPayload {
  RodPlace place = {};
  double mass = 0;                                   ///< kg; >= 0
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< Centre of mass in the frame of the place, m.
  Eigen::Vector3d velocity =
      Eigen::Vector3d::Zero();  ///< Velocity of the mass before pick-up, in the base's frame, m/s.
};

/// Number of parameters of each section. The parameters are relative changes, in this order: of the stiffness
/// against shear, stretch, bend and twist, of the mass per length, and of the damping. The first five
/// parameters are the same as in EquilibriumSlopes. Damping does not change with the stiffness. Mass does not
/// include point masses and payloads.
inline constexpr Eigen::Index dynamics_parameters = 6;

/// Derivatives of a rod's motion, p = M(q) v and dp/dt = f(q, v, input). All matrices have a row for each
/// mode. The input of a rod is its tendon displacements if they are given, otherwise its tensions. Columns of
/// slack tendons are 0 for displacements.
struct RodDynamicsSlopes {
  Eigen::MatrixXd mass;           ///< M = dp/dv
  Eigen::MatrixXd momentum_by_q;  ///< dp/dq at constant v.
  Eigen::MatrixXd force_by_q, force_by_v, force_by_input;
  /// Derivatives of p and f with respect to the parameters at constant q and v; modes x (dynamics_parameters
  /// x sections). The bristle stiffness of tendon friction changes with the stiffness of the rod.
  Eigen::MatrixXd momentum_by_parameters, force_by_parameters;
};

/// Linearised motion around a state: x' = A x + B u.
struct RodLinear {
  /// Derivatives from which the matrices are computed. If tendons are held and very stiff, these derivatives
  /// are more accurate than A, in which the inverse of an ill-conditioned mass matrix multiplies this
  /// stiffness.
  RodDynamicsSlopes slopes;
  Eigen::MatrixXd A, B;            ///< For x = (q, p).
  Eigen::MatrixXd A_rest, B_rest;  ///< For x = (q, v), valid around a rod at rest.
  /// Derivatives of x' with respect to the parameters: at constant x = (q, p), and around a rod at rest at
  /// constant x = (q, v). Columns as in RodDynamicsSlopes.
  Eigen::MatrixXd by_parameters, by_parameters_rest;
  /// Derivatives of the tip's velocity and angular velocity with respect to v, 6 x modes, in the base's
  /// frame.
  Eigen::MatrixXd tip_by_q;
  Eigen::MatrixXd
      lengths_by_q;  ///< Derivatives of tendon lengths with respect to the modes, tendons x modes.
};

/// Derivatives of (q, p, rate, force) after a step. The result of a step depends on no other internal data of
/// the integrator.
struct RodStepSlopes {
  Eigen::MatrixXd by_state;  ///< Derivatives with respect to (q, p, rate, force) before the step.
  Eigen::MatrixXd by_input;
  /// Derivatives with respect to the parameters, at a constant state before the step; columns as in
  /// RodDynamicsSlopes.
  Eigen::MatrixXd by_parameters;
};

/// Dynamics of rods: Lagrange's equations in the strain modes of RodStatics, with the same nodes. So a rod in
/// an equilibrium of RodStatics stays at rest. All quantities are in the frame of the base. The cost of a
/// step is linear in the number of sections. A step allocates no memory.
class RodDynamics {
 public:
  /// Parameters as RodChain. Throws std::invalid_argument for an invalid rod, no mass, or a setting out of
  /// bounds.
  explicit RodDynamics(Rod rod, const RodDynamicsConfig& config = {}, std::span<const RodPlace> places = {});
  ~RodDynamics();
  RodDynamics(RodDynamics&&) noexcept;
  RodDynamics& operator=(RodDynamics&&) noexcept;

  /// Sets the surroundings, whose wrenches act in addition to tendons and loads; the object keeps a reference
  /// to the surroundings. Null: no surroundings. Throws std::invalid_argument if one of their points is
  /// outside the rod.
  void set_surroundings(const RodSurroundings* surroundings);

  /// From now on multiplies each section's undeformed length by a factor > 0 that changes at a rate, 1/s
  /// (RodChain::stretch_rest). The lists of factors and rates have one number per section. For a step, the
  /// factors must have their values at the time for which the tendons are given (see step()). The state does
  /// not change. Kinetic energy and momentum include the driven motion. Throws std::invalid_argument for
  /// lists of wrong length, factors that are not positive, or rates that are not finite.
  void stretch_rest(std::span<const double> factors, std::span<const double> rates);

  /// Returns the unloaded rod at rest.
  [[nodiscard]] RodState rest() const;
  /// Returns the rod at rest in an equilibrium of RodStatics. Tendon friction has the value after the tendons
  /// were pulled in.
  [[nodiscard]] RodState rest(const Equilibrium& at) const;
  /// Returns the state with modes q and rates v. `tendons` and `loads` act from now on. `slide`: earlier
  /// state of tendons with friction. Null: the tendons are assumed to have slid at their present rate for 0.1
  /// s, so friction does not hold tendons at rest.
  [[nodiscard]] RodState start(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const TendonInput& tendons,
                               const RodLoads& loads, const RodSlide* slide = nullptr);

  /// Adds a point mass to the rod until it is dropped and returns the state after the inelastic impact. The
  /// generalized momentum of rod and mass is conserved. Energy is lost unless the mass and the place had
  /// equal velocities. `tendons` and `loads` act from now on. chain() does not include the mass. Throws
  /// std::invalid_argument for a place that is not a node, a mass below 0, or numbers that are not finite.
  [[nodiscard]] RodState pick_up(const RodState& state, const RodPayload& payload, const TendonInput& tendons,
                                 const RodLoads& loads);
  /// Releases all payloads at a place. The velocities of the payloads and of the rod do not change.
  [[nodiscard]] RodState drop(const RodState& state, const RodPlace& place, const TendonInput& tendons,
                              const RodLoads& loads);

  /// Advances the state by h seconds. Tendons and loads are constant during the step. Tendons and loads must
  /// have the values at the time h / (1 + spectral radius) after the start of the step. If the step does not
  /// converge, the state does not change.
  RodStep step(RodState& state, const TendonInput& tendons, const RodLoads& loads, double h);

  /// Returns the estimated position error of the tip from the last step, m. 0 before three steps of equal
  /// length.
  [[nodiscard]] double step_error(const RodState& state);
  /// Returns the rates of the modes.
  [[nodiscard]] Eigen::VectorXd velocity(const RodState& state);
  /// Returns kinetic, strain and gravitational energy under these loads, J.
  [[nodiscard]] RodEnergy energy(const RodState& state, const RodLoads& loads);
  /// Returns the power dissipated by strain damping, W.
  [[nodiscard]] double dissipation(const RodState& state);
  /// Returns the momentum of the rod: linear, N s, and angular about the base's origin, N m s.
  [[nodiscard]] Vector6d momentum(const RodState& state);
  /// Returns the motion at a node: a section's end or a requested place.
  [[nodiscard]] NodeMotion motion(const RodState& state, const RodPlace& place);
  /// Returns the motion of all nodes. Afterwards, node_runs() returns the length of rod that each node
  /// represents in an integral along the rod, m.
  [[nodiscard]] std::vector<NodeMotion> motions(const RodState& state);
  [[nodiscard]] std::span<const double> node_runs() const;
  /// Returns the motion of all points at which the surroundings may act (RodSurroundings::points()).
  [[nodiscard]] std::vector<NodeMotion> point_motions(const RodState& state);
  /// Returns the pose of the tip, X_BT.
  [[nodiscard]] Pose tip(const RodState& state);
  /// Returns the lengths of the tendons, m.
  [[nodiscard]] std::vector<double> tendon_lengths(const RodState& state);
  /// Returns the dense mass matrix M(q).
  [[nodiscard]] Eigen::MatrixXd mass_matrix(const Eigen::VectorXd& q);
  /// Returns the accelerations dv/dt of the modes. The cost is linear in the number of sections.
  [[nodiscard]] Eigen::VectorXd acceleration(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                             const TendonInput& tendons, const RodLoads& loads);

  /// Returns the generalized forces that tendons or other actuators must apply for the acceleration `a`. The
  /// result does not include the forces of weight, loads, stiffness, damping and surroundings. The cost is
  /// linear in the number of sections. Throws std::invalid_argument as start().
  [[nodiscard]] Eigen::VectorXd needed_forces(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                              const Eigen::VectorXd& a, const RodLoads& loads);
  /// Returns the derivatives of tendon lengths with respect to the modes, tendons x modes. The generalized
  /// forces of tensions are -lengths_by_q^T tensions. Throws std::invalid_argument as start().
  [[nodiscard]] Eigen::MatrixXd lengths_by_q(const Eigen::VectorXd& q);
  /// Returns the stiffness matrix K, modes x modes: the strain energy is q^T K q / 2.
  [[nodiscard]] Eigen::MatrixXd stiffness_matrix() const;
  /// Returns the damping matrix D, modes x modes: the viscous forces are -D v.
  [[nodiscard]] Eigen::MatrixXd damping_matrix() const;

  /// Returns the derivatives at a state. The computing time grows with the square of the number of sections.
  /// `slide` as in start(). Tensions of tendons of given displacement are computed from the tendon lengths.
  /// For stiff tendons, these computed tensions are inaccurate. So for a rod at rest, RodState::tensions are
  /// used instead if these tensions fit the lengths.
  [[nodiscard]] RodDynamicsSlopes slopes(const RodState& state, const TendonInput& tendons,
                                         const RodLoads& loads, const RodSlide* slide = nullptr);
  /// Returns the linearised motion around a state. Cost, accuracy and exceptions are those of slopes(). Also
  /// throws std::invalid_argument if a tendon has friction, which cannot be linearised.
  [[nodiscard]] RodLinear linearize(const RodState& state, const TendonInput& tendons, const RodLoads& loads);
  /// Returns the derivatives of an undivided step. Throws std::runtime_error if the step does not converge.
  [[nodiscard]] RodStepSlopes step_slopes(const RodState& state, const TendonInput& tendons,
                                          const RodLoads& loads, double h);

  [[nodiscard]] const RodChain& chain() const;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace flexura
