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

/// How a rod's motion is integrated.
struct RodDynamicsConfig {
  /// What is left after each step of what moves too fast for it, from 0 to 1; 1: no numerical damping, the
  /// step is the implicit midpoint rule. Nearer to 1 steps are more exact; but where they are longer than a
  /// rod's periods and the rod has no damping of its own, motion may gain energy from much above 0.1 on.
  double spectral_radius = 0.1;
  /// How exactly a step's equations are solved, rad/s: errors of the rates have at most the energy, stiffness
  /// included, of the rod that turns so fast as a whole.
  double tolerance = 1e-7;
  int most_iterations = 30;
  /// A step that does not converge is made anew with the radius 0, in halves of halves, each as long as
  /// converges, but none shorter than the step over this: a power of 2. 1: it is not.
  int most_pieces = 65536;
  /// Whether cross-sections resist to turning. Without, a rod must not twist.
  bool rotary_inertia = true;
  /// Of tendons that rub: how many times as stiff as the rod friction gives way to a tendon before it lets it
  /// slide. A tendon under a tension goes on by about friction times the angle by which it turns, over this,
  /// of the way by which that tension bends the rod.
  double friction_grip = 100;
};

/// How a step ended.
enum class DynamicsEnd {
  converged,
  bad_input,  ///< A number that is not finite, a tension below 0, a list of another length, a step of 0.
  did_not_converge,  ///< Too long a step for what pulls.
};
/// That, for people.
[[nodiscard]] const char* words(DynamicsEnd end);

/// A rod in motion. Time, q and momentum are its state; the rest is what the integrator remembers.
struct RodState {
  double time = 0;               ///< s
  Eigen::VectorXd q;             ///< The strain modes, as of RodChain.
  Eigen::VectorXd momentum;      ///< p = M(q) v.
  std::vector<double> tensions;  ///< Of the last step, N, at the base.
  /// By how much friction holds the tendons that rub, N, from place to place along them; of the state, too.
  std::vector<double> friction;

  Eigen::VectorXd rate;  ///< dq/dt and dp/dt as the integrator has them.
  Eigen::VectorXd force;
  std::array<Eigen::VectorXd, 3>
      middle;                ///< The last steps' rates, newest first, from which the next begins.
  int middles = 0;           ///< How many there are.
  double step = 0;           ///< Of how long a step, s.
  double contraction = 0.1;  ///< By which an iteration of the last step gained.
};

/// What is known of the friction of tendons before a time.
struct RodSlide {
  std::vector<double> friction = {};  ///< As of RodState.
  double time = 0;                    ///< Since when they slide as they do now, s.
};

/// What a step was.
struct RodStep {
  DynamicsEnd end = DynamicsEnd::converged;
  std::string problem = {};  ///< Of bad input, in words.
  int iterations = 0;        ///< Linear systems solved.
  int pieces = 1;            ///< That the step was made in; 0: it did not converge.
  bool is_anew = false;      ///< It did not converge at first (RodDynamicsConfig::most_pieces).
  double friction_work = 0;  ///< J: what friction of tendons took, with what it stored as it gave way.
  double friction_loss = 0;  ///< Of that, what was lost; never below 0.

  [[nodiscard]] bool converged() const { return end == DynamicsEnd::converged; }
};

/// A point mass that a rod in motion picks up.
struct RodPayload {
  RodPlace place = {};
  double mass = 0;                                     ///< kg; >= 0
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();    ///< In the frame of the place, m.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< Before, in the base's frame, m/s.
};

/// Derivatives of a rod's motion. Its equations are p = M(q) v and dp/dt = f(q, v, input); all are matrices
/// with a row for each mode. The input are tensions, or displacements where those are given; columns of slack
/// tendons are 0 then.
struct RodDynamicsSlopes {
  Eigen::MatrixXd mass;           ///< M = dp/dv
  Eigen::MatrixXd momentum_by_q;  ///< dp/dq at constant v.
  Eigen::MatrixXd force_by_q, force_by_v, force_by_input;
};

/// Motion around a state: x' = A x + B u.
struct RodLinear {
  Eigen::MatrixXd A, B;            ///< Of x = (q, p).
  Eigen::MatrixXd A_rest, B_rest;  ///< Of x = (q, v), which is so around a rod at rest.
  /// Of the tip, 6 x modes: velocity of its origin and angular velocity by v, in the base's frame.
  Eigen::MatrixXd tip_by_q;
  Eigen::MatrixXd lengths_by_q;  ///< Of the tendons, tendons x modes.
};

/// Derivatives of a step: of (q, p, rate, force) after it, all that the integrator remembers.
struct RodStepSlopes {
  Eigen::MatrixXd by_state;  ///< By the same before it.
  Eigen::MatrixXd by_input;
};

/// Rods in motion: Lagrange's equations in the strain modes of RodStatics, with the same nodes, so that what
/// is at rest there is so here. In the frame of the base. A step costs as much for each section however many
/// there are, and allocates nothing.
class RodDynamics {
 public:
  /// As RodChain. std::invalid_argument: the problems of the rod, no mass, a setting out of bounds.
  explicit RodDynamics(Rod rod, const RodDynamicsConfig& config = {}, std::span<const RodPlace> places = {});
  ~RodDynamics();
  RodDynamics(RodDynamics&&) noexcept;
  RodDynamics& operator=(RodDynamics&&) noexcept;

  /// What pulls beside tendons and loads; is kept by reference. Null: nothing. std::invalid_argument: it has
  /// a point outside the rod.
  void set_surroundings(const RodSurroundings* surroundings);

  /// From now on each section's own length is a factor of what the rod says, one a section, each > 0, that
  /// changes by a rate, 1/s: of sections that something drives longer or shorter (RodChain::stretch_rest). In
  /// a step both are those where its tendons are. The state stays; kinetic energy and momentum have what the
  /// drives move. std::invalid_argument: another number of them, a factor that is not above 0, rates that are
  /// not finite.
  void stretch_rest(std::span<const double> factors, std::span<const double> rates);

  /// The rod at rest when nothing pulls.
  [[nodiscard]] RodState rest() const;
  /// At rest in an equilibrium of RodStatics: tendons that rub have been pulled in up to there.
  [[nodiscard]] RodState rest(const Equilibrium& at) const;
  /// In motion: by its modes and their rates, under what pulls from now on. Tendons that rub have slid as
  /// `slide` says; null: as they do now for a tenth of a second, so that those that do not slide are held by
  /// nothing.
  [[nodiscard]] RodState start(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const TendonInput& tendons,
                               const RodLoads& loads, const RodSlide* slide = nullptr);

  /// From now on, until it is dropped, it carries the mass: the state after a jolt, with the generalized
  /// momentum of both as they were before. Energy is lost as they become one (none where both move alike).
  /// What pulls from now on is given. The chain does not have the mass. std::invalid_argument: a place that
  /// is no node, a mass below 0, numbers that are not finite.
  [[nodiscard]] RodState pick_up(const RodState& state, const RodPayload& payload, const TendonInput& tendons,
                                 const RodLoads& loads);
  /// Lets go of all that it picked up there. The mass leaves with the velocity that it has, and the rod keeps
  /// its own.
  [[nodiscard]] RodState drop(const RodState& state, const RodPlace& place, const TendonInput& tendons,
                              const RodLoads& loads);

  /// Goes on by h seconds. Tendons and loads are those after h / (1 + spectral radius), as good as constant
  /// in the step. Where it does not converge the state is what it was.
  RodStep step(RodState& state, const TendonInput& tendons, const RodLoads& loads, double h);

  /// Of a state that was stepped at least three times with one h: how far the last step's error in time moves
  /// the tip, m, to first order; else 0.
  [[nodiscard]] double step_error(const RodState& state);
  /// The rates of the modes.
  [[nodiscard]] Eigen::VectorXd velocity(const RodState& state);
  /// Of its motion, its strains, and its weight under these loads, J.
  [[nodiscard]] RodEnergy energy(const RodState& state, const RodLoads& loads);
  /// What damping of its strains takes from it, W.
  [[nodiscard]] double dissipation(const RodState& state);
  /// Of all of the rod: linear, and angular about the base's origin.
  [[nodiscard]] Vector6d momentum(const RodState& state);
  /// Of a place that is a node: the section's ends and what was asked for.
  [[nodiscard]] NodeMotion motion(const RodState& state, const RodPlace& place);
  /// Of all nodes, and metres of rod for each in an integral along it: as RodSurroundings has them.
  [[nodiscard]] std::vector<NodeMotion> motions(const RodState& state);
  [[nodiscard]] std::span<const double> node_runs() const;
  /// Of all points at which the surroundings may pull (RodSurroundings::points()).
  [[nodiscard]] std::vector<NodeMotion> point_motions(const RodState& state);
  /// X_BT
  [[nodiscard]] Pose tip(const RodState& state);
  /// How long the tendons are, m.
  [[nodiscard]] std::vector<double> tendon_lengths(const RodState& state);
  /// M(q), dense.
  [[nodiscard]] Eigen::MatrixXd mass_matrix(const Eigen::VectorXd& q);
  /// dv/dt under what pulls: M^-1 of all forces, at linear cost.
  [[nodiscard]] Eigen::VectorXd acceleration(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                             const TendonInput& tendons, const RodLoads& loads);

  /// The generalized forces that the acceleration `a` needs beside weight, loads, stiffness, damping and
  /// surroundings: what tendons or others have to make. At linear cost. std::invalid_argument: as start().
  [[nodiscard]] Eigen::VectorXd needed_forces(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                              const Eigen::VectorXd& a, const RodLoads& loads);
  /// The tendons' lengths by the modes, tendons x modes: tensions make the generalized forces -
  /// lengths_by_q^T tensions. std::invalid_argument: as start().
  [[nodiscard]] Eigen::MatrixXd lengths_by_q(const Eigen::VectorXd& q);
  /// K of the strains' energy q^T K q / 2, and D of the viscosity's forces - D v; modes x modes.
  [[nodiscard]] Eigen::MatrixXd stiffness_matrix() const;
  [[nodiscard]] Eigen::MatrixXd damping_matrix() const;

  /// Derivatives at a state, under what pulls. They cost as the square of the number of sections. Of tendons
  /// that rub as start() has them.
  [[nodiscard]] RodDynamicsSlopes slopes(const RodState& state, const TendonInput& tendons,
                                         const RodLoads& loads, const RodSlide* slide = nullptr);
  /// The linear motion around a state. Errors and cost as slopes(); std::invalid_argument: a tendon rubs,
  /// which has no linear model.
  [[nodiscard]] RodLinear linearize(const RodState& state, const TendonInput& tendons, const RodLoads& loads);
  /// Of a step that is made in one piece. std::runtime_error: it does not converge.
  [[nodiscard]] RodStepSlopes step_slopes(const RodState& state, const TendonInput& tendons,
                                          const RodLoads& loads, double h);

  [[nodiscard]] const RodChain& chain() const;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace flexura
