#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_layout.h"
#include "flexura/mechanics/rod_matrix.h"
#include "flexura/mechanics/rod_motion.h"
#include "flexura/mechanics/rod_points.h"

namespace flexura {

/// Factored derivative of a step's equations with respect to the rates.
struct RodStepFactor {
  double stretch = 0;  ///< Step length times Scheme::stage, s.
  Eigen::PartialPivLU<Eigen::MatrixXd> lu;
};

/// Data and methods of RodDynamics.
struct RodDynamics::Work {
  Work(Rod rod, const RodDynamicsConfig& given, std::span<const RodPlace> places);

  /// Generalized alpha of first order (Jansen, Whiting, Hulbert 2000).
  struct Scheme {
    explicit Scheme(double rho)
        : alpha_f(1 / (1 + rho)),
          alpha_m((3 - rho) / (2 * (1 + rho))),
          gamma(alpha_f),
          stage(alpha_f * gamma / alpha_m),
          memory(alpha_f * (1 - gamma / alpha_m)),
          error(1.0 / 12 + 0.25 * (1 - rho) * (1 - rho) / ((1 + rho) * (1 + rho))) {}
    double alpha_f, alpha_m, gamma;
    /// Coefficient of h times the stage's rate, in the change of state from the step's start to the stage.
    double stage;
    /// Coefficient of h times RodState::rate, in the change of state from the step's start to the stage.
    double memory;
    double error;  ///< Step error in units of h^3 x'''.
  };

  /// Returns whether all numbers are so small that energies and velocities are finite.
  [[nodiscard]] static bool is_of_this_world(const Eigen::VectorXd& numbers) {
    return (numbers.array().abs() < 1e100).all();
  }
  void set_surroundings(const RodSurroundings* given);
  [[nodiscard]] std::string input_problem(const TendonInput& tendons, const RodLoads& loads) const;
  [[nodiscard]] bool rubs() const { return !layout.rubbing.empty(); }
  /// Computes momentum, forces, tensions and friction of a state with rates v. hold() sets the initial
  /// friction.
  void set_forces(RodState& state, const Eigen::VectorXd& v, const TendonInput& tendons,
                  const RodLoads& loads);
  /// Sets the friction state of the motion and its derivatives (RodMotion::hold).
  void hold(const double* before, double time);
  /// Time for which tendons are assumed to have slid at their present rate if there is no earlier state, s.
  static constexpr double has_slid = 0.1;
  RodStep step(RodState& state, const TendonInput& tendons, const RodLoads& loads, double h);
  /// Sets the tensions to those in `tendons`, or computes them from the displacements in `tendons` at the
  /// present shape.
  void set_tensions(const TendonInput& tendons);
  /// Call after set_tensions(). For a state at rest, replaces the tensions by those in the state if these fit
  /// the displacements.
  void keep_tensions_of_rest(const RodState& state, const TendonInput& tendons);
  /// Places the rod at a state, factors the mass matrix and sets velocity_.
  bool find_velocity(const RodState& state);
  /// Differentiates momenta and forces at q and v under `tensions`. There is a column for each mode, which
  /// changes q by by_q and v by by_v.
  void differentiate(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const RodLoads& loads, double by_q,
                     double by_v, Eigen::MatrixXd& by_mode_of_momentum, Eigen::MatrixXd& by_mode_of_force);

  RodDynamicsConfig config;
  Scheme scheme;
  RodChain chain;
  RodLayout layout;
  RodMotion<double> motion;
  RodMatrix matrix;
  const RodSurroundings* surroundings = nullptr;
  /// Points between nodes at which surroundings act; null: none.
  std::unique_ptr<RodPoints> points = {};
  std::vector<double> rest_lengths, compliance;  // m, m/N
  std::vector<double> grip;                      // N/m, of the pieces of tendons with friction
  /// Relative changes of a tendon's grip by the parameters, tendons x (dynamics_parameters x sections).
  Eigen::MatrixXd grip_by_parameters;
  std::vector<double> tensions;
  Eigen::VectorXd velocity;
  /// Original bodies (without payloads) of the nodes that carry payloads.
  std::vector<std::pair<std::size_t, RodLayout::Body>> bare = {};

  /// Returns the parts of K q + D v that are proportional to each parameter; columns as in RodDynamicsSlopes.
  [[nodiscard]] Eigen::MatrixXd inner_forces(const Eigen::VectorXd& q, const Eigen::VectorXd& v) const;
  /// Sets the derivatives with respect to the parameters, with the present tensions. Call after motion.pull()
  /// at q and v if tendons have friction.
  void find_parameter_slopes(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const RodLoads& loads,
                             RodDynamicsSlopes& slopes);
  /// Returns the derivatives at the present shape, also those with respect to the input. The tensions are
  /// those in `tendons`.
  [[nodiscard]] RodDynamicsSlopes slopes_at(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                            const TendonInput& tendons, const RodLoads& loads);
  /// Solves the stage of a step that starts at `state`; q and v become the modes and rates of the stage.
  [[nodiscard]] bool find_stage(const RodState& state, const TendonInput& tendons, const RodLoads& loads,
                                double h, Eigen::VectorXd& q, Eigen::VectorXd& v);

 private:
  struct Stage {
    const Scheme& scheme;
    const TendonInput& tendons;
    const RodLoads& loads;
    double stretch;  // Step length times scheme.stage.
    [[nodiscard]] bool by_displacement() const { return !tendons.displacements.empty(); }
  };
  RodStep step_once(const Scheme& use, RodState& state, const TendonInput& tendons, const RodLoads& loads,
                    double h);
  bool restart(RodState& state, const TendonInput& tendons, const RodLoads& loads);
  [[nodiscard]] std::vector<double> displacements_at(const RodState& state, const TendonInput& tendons);
  bool step_in_pieces(RodState& state, const TendonInput& tendons, const RodLoads& loads, double h,
                      RodStep& result);
  [[nodiscard]] double change_size() const;
  void begin(const RodState& state, const Stage& stage, double h);
  void guess(const RodState& state, double h);
  // Computes the stage's momenta and forces at `velocity`; change_ becomes the residual.
  void evaluate(const Stage& stage);
  // Replaces the residual in change_ by the Newton step of the rates, with the approximate or the exact
  // derivative.
  bool solve_quickly(const Stage& stage);
  bool solve_exactly(const Stage& stage);
  bool iterate_quickly(const Stage& stage, double contraction, RodStep& result, double& worst_gain);
  bool iterate_exactly(const Stage& stage, RodStep& result);
  void find_grip(const Eigen::VectorXd& give);
  bool add_friction_work(const RodState& state, double h, RodStep& result) const;
  bool find_tensions();
  bool factor_exactly(const Stage& stage);
  template <typename Solve>
  bool solve_with_tendons(const Stage& stage, Solve&& solve);
  bool pull_tight();
  void finish_force(const Stage& stage);
  bool finish(const Stage& stage, RodState& state, double h, RodStep& result);

  Eigen::VectorXd q_from_, p_from_, q_, momentum_, force_, change_, left_;
  double turning_inertia_ = 1;  // kg m^2
  // For displacement input, by tendon.
  Eigen::MatrixXd length_slopes_, pull_slopes_, answers_, give_, pivot_;
  Eigen::VectorXd lengths_, desired_, found_, pull_change_;
  std::vector<char> taut_;
  // Friction state, as in `motion`.
  const double* held_before_ = nullptr;
  double slide_time_ = 0;
  // For iterations with the exact derivative, which few steps need; created on first use.
  std::unique_ptr<RodMotion<Dual<Lanes>>> differential_;
  std::shared_ptr<const RodStepFactor> factor_;
};

}  // namespace flexura
