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
  /// Part of motion too fast for the step that is left after a step, from 0 to 1. 1: no numerical damping,
  /// the step is the implicit midpoint rule. Nearer to 1 steps are more exact. But where steps are longer
  /// than the periods of an undamped rod, motion may gain energy from much above 0.1 on.
  double spectral_radius = 0.1;
  /// Tolerance of a step's equations, rad/s. Errors of the rates have at most the energy, stiffness included,
  /// of the rod turning at this rate as a whole.
  double tolerance = 1e-7;
  int most_iterations = 30;
  /// A step that does not converge is repeated with spectral radius 0 in halves of halves, each as long as
  /// converges. The shortest piece is the step over this number, a power of 2. 1: steps are not divided.
  int most_pieces = 65536;
  /// Whether cross-sections have rotary inertia. Without it a rod must not twist.
  bool rotary_inertia = true;
  /// Stiffness of tendon friction before sliding, relative to the rod's stiffness against that tendon. A
  /// sticking tendon yields by about friction times turning angle over this number of the distance by which
  /// its tension bends the rod.
  double friction_grip = 100;
};

/// How a step ended.
enum class DynamicsEnd {
  converged,
  bad_input,         ///< A number that is not finite, a tension below 0, a list of wrong length, a step of 0.
  did_not_converge,  ///< The step is too long for the loads.
};
/// Returns a description for users.
[[nodiscard]] const char* words(DynamicsEnd end);

struct RodStepFactor;

/// State of a rod in motion: time, q, momentum and friction. The other fields are the integrator's memory.
struct RodState {
  double time = 0;               ///< s
  Eigen::VectorXd q;             ///< Strain modes, as in RodChain.
  Eigen::VectorXd momentum;      ///< p = M(q) v.
  std::vector<double> tensions;  ///< Tensions of the last step at the base, N.
  /// Friction force on each tendon with friction, N, from place to place along it; part of the state.
  std::vector<double> friction;

  Eigen::VectorXd rate;  ///< dq/dt and, in force, dp/dt as the integrator has them.
  Eigen::VectorXd force;
  std::array<Eigen::VectorXd, 3> middle;  ///< Rates of the last steps, newest first, used to start the next.
  int middles = 0;                        ///< Number of valid entries of `middle`.
  double step = 0;                        ///< Length of the last step, s.
  double contraction = 0.1;               ///< Contraction factor of the last step's iterations.
  /// Factored derivative of a recent step of a rod with tendon friction; null if there was none.
  std::shared_ptr<const RodStepFactor> factor = {};
};

/// Known state of tendon friction before a time.
struct RodSlide {
  std::vector<double> friction = {};  ///< As in RodState.
  double time = 0;                    ///< For how long tendons have slid at the present rate, s.
};

/// Result of a step.
struct RodStep {
  DynamicsEnd end = DynamicsEnd::converged;
  std::string problem = {};  ///< For bad input, in words.
  int iterations = 0;        ///< Linear systems solved.
  int pieces = 1;            ///< Number of pieces that the step was divided into; 0: it did not converge.
  bool is_anew = false;      ///< The first attempt did not converge (RodDynamicsConfig::most_pieces).
  double friction_work = 0;  ///< Work done against tendon friction, energy stored in bristles included, J.
  double friction_loss = 0;  ///< Dissipated part of friction_work, never below 0, J.

  [[nodiscard]] bool converged() const { return end == DynamicsEnd::converged; }
};

/// A point mass that a rod in motion picks up.
struct RodPayload {
  RodPlace place = {};
  double mass = 0;                                     ///< kg; >= 0
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();    ///< In the frame of the place, m.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< Before pick-up, in the base's frame, m/s.
};

/// Derivatives of a rod's motion, p = M(q) v and dp/dt = f(q, v, input). All matrices have a row for each
/// mode. The input is tensions, or displacements if those are given; then columns of slack tendons are 0.
struct RodDynamicsSlopes {
  Eigen::MatrixXd mass;           ///< M = dp/dv
  Eigen::MatrixXd momentum_by_q;  ///< dp/dq at constant v.
  Eigen::MatrixXd force_by_q, force_by_v, force_by_input;
};

/// Linear motion around a state: x' = A x + B u.
struct RodLinear {
  Eigen::MatrixXd A, B;            ///< For x = (q, p).
  Eigen::MatrixXd A_rest, B_rest;  ///< For x = (q, v), valid around a rod at rest.
  /// Velocity of the tip's origin and angular velocity by v, 6 x modes, in the base's frame.
  Eigen::MatrixXd tip_by_q;
  Eigen::MatrixXd lengths_by_q;  ///< Tendon lengths by the modes, tendons x modes.
};

/// Derivatives of a step: of (q, p, rate, force) after it, all that the integrator remembers.
struct RodStepSlopes {
  Eigen::MatrixXd by_state;  ///< By (q, p, rate, force) before it.
  Eigen::MatrixXd by_input;
};

/// Dynamics of rods: Lagrange's equations in the strain modes of RodStatics, with the same nodes. So an
/// equilibrium of RodStatics is at rest here. All quantities are in the frame of the base. The cost of a step
/// is linear in the number of sections. A step allocates no memory.
class RodDynamics {
 public:
  /// Parameters as RodChain. Throws std::invalid_argument for an invalid rod, no mass, or a setting out of
  /// bounds.
  explicit RodDynamics(Rod rod, const RodDynamicsConfig& config = {}, std::span<const RodPlace> places = {});
  ~RodDynamics();
  RodDynamics(RodDynamics&&) noexcept;
  RodDynamics& operator=(RodDynamics&&) noexcept;

  /// Sets wrenches besides tendons and loads; kept by reference. Null: none. Throws std::invalid_argument if
  /// one of its points is outside the rod.
  void set_surroundings(const RodSurroundings* surroundings);

  /// From now on each section's undeformed length is multiplied by a factor > 0 that changes at a rate, 1/s,
  /// for driven sections (RodChain::stretch_rest). Both lists have one number a section. In a step they are
  /// taken at the time of its tendons. The state does not change; kinetic energy and momentum include the
  /// driven motion. Throws std::invalid_argument for lists of wrong length, factors that are not positive, or
  /// rates that are not finite.
  void stretch_rest(std::span<const double> factors, std::span<const double> rates);

  /// Returns the unloaded rod at rest.
  [[nodiscard]] RodState rest() const;
  /// Returns the rod at rest in an equilibrium of RodStatics. Tendons with friction have been pulled in to
  /// reach it.
  [[nodiscard]] RodState rest(const Equilibrium& at) const;
  /// Returns a state in motion by modes and their rates, under the loads from now on. `slide`: how tendons
  /// with friction have slid. Null: at their present rate for a tenth of a second; then friction does not
  /// hold tendons that do not slide.
  [[nodiscard]] RodState start(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const TendonInput& tendons,
                               const RodLoads& loads, const RodSlide* slide = nullptr);

  /// Adds a point mass to the rod until it is dropped and returns the state after the inelastic impact. The
  /// generalized momentum of both is conserved; energy is lost unless both moved alike. The loads given are
  /// those from now on. The chain does not have the mass. Throws std::invalid_argument for a place that is
  /// not a node, a mass below 0, or numbers that are not finite.
  [[nodiscard]] RodState pick_up(const RodState& state, const RodPayload& payload, const TendonInput& tendons,
                                 const RodLoads& loads);
  /// Releases all payloads at a place. They leave with their velocity, and the rod keeps its own.
  [[nodiscard]] RodState drop(const RodState& state, const RodPlace& place, const TendonInput& tendons,
                              const RodLoads& loads);

  /// Advances the state by h seconds. Tendons and loads are those at h / (1 + spectral radius) and count as
  /// constant in the step. If the step does not converge, the state does not change.
  RodStep step(RodState& state, const TendonInput& tendons, const RodLoads& loads, double h);

  /// Returns the error of the last step at the tip, m, to first order in time. 0 unless the state made at
  /// least three steps of one length.
  [[nodiscard]] double step_error(const RodState& state);
  /// Returns the rates of the modes.
  [[nodiscard]] Eigen::VectorXd velocity(const RodState& state);
  /// Returns kinetic, strain and gravitational energy under these loads, J.
  [[nodiscard]] RodEnergy energy(const RodState& state, const RodLoads& loads);
  /// Returns the power dissipated by strain damping, W.
  [[nodiscard]] double dissipation(const RodState& state);
  /// Returns the momentum of the rod: linear, and angular about the base's origin.
  [[nodiscard]] Vector6d momentum(const RodState& state);
  /// Returns the motion at a node: a section's end or a requested place.
  [[nodiscard]] NodeMotion motion(const RodState& state, const RodPlace& place);
  /// Returns the motion of all nodes, and (node_runs) the length of rod of each in an integral along it, m,
  /// as in RodSurroundings.
  [[nodiscard]] std::vector<NodeMotion> motions(const RodState& state);
  [[nodiscard]] std::span<const double> node_runs() const;
  /// Returns the motion of all points at which the surroundings may act (RodSurroundings::points()).
  [[nodiscard]] std::vector<NodeMotion> point_motions(const RodState& state);
  /// X_BT
  [[nodiscard]] Pose tip(const RodState& state);
  /// Returns the lengths of the tendons, m.
  [[nodiscard]] std::vector<double> tendon_lengths(const RodState& state);
  /// M(q), dense.
  [[nodiscard]] Eigen::MatrixXd mass_matrix(const Eigen::VectorXd& q);
  /// Returns dv/dt, M^-1 times all forces, at linear cost.
  [[nodiscard]] Eigen::VectorXd acceleration(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                             const TendonInput& tendons, const RodLoads& loads);

  /// Returns the generalized forces needed for the acceleration `a` besides weight, loads, stiffness, damping
  /// and surroundings. Tendons or others must make them. Linear cost. Throws std::invalid_argument as
  /// start().
  [[nodiscard]] Eigen::VectorXd needed_forces(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                              const Eigen::VectorXd& a, const RodLoads& loads);
  /// Returns the derivatives of tendon lengths by the modes, tendons x modes. Tensions make the generalized
  /// forces -lengths_by_q^T tensions. Throws std::invalid_argument as start().
  [[nodiscard]] Eigen::MatrixXd lengths_by_q(const Eigen::VectorXd& q);
  /// Return K of the strain energy q^T K q / 2, and D of the viscous forces -D v; modes x modes.
  [[nodiscard]] Eigen::MatrixXd stiffness_matrix() const;
  [[nodiscard]] Eigen::MatrixXd damping_matrix() const;

  /// Returns the derivatives at a state. Their cost grows with the square of the number of sections. `slide`
  /// as in start().
  [[nodiscard]] RodDynamicsSlopes slopes(const RodState& state, const TendonInput& tendons,
                                         const RodLoads& loads, const RodSlide* slide = nullptr);
  /// Returns the linear motion around a state. Cost and errors as slopes(). Also throws std::invalid_argument
  /// if a tendon has friction, which has no linear model.
  [[nodiscard]] RodLinear linearize(const RodState& state, const TendonInput& tendons, const RodLoads& loads);
  /// Returns the derivatives of an undivided step. Throws std::runtime_error if it does not converge.
  [[nodiscard]] RodStepSlopes step_slopes(const RodState& state, const TendonInput& tendons,
                                          const RodLoads& loads, double h);

  [[nodiscard]] const RodChain& chain() const;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace flexura
