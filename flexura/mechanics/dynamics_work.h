#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_layout.h"
#include "flexura/mechanics/rod_matrix.h"
#include "flexura/mechanics/rod_motion.h"

namespace flexura {

/// What RodDynamics has and works with.
struct RodDynamics::Work {
  Work(Rod rod, const RodDynamicsConfig& given, std::span<const RodPlace> places);

  /// Generalized alpha of first order (K. E. Jansen, C. H. Whiting, G. M. Hulbert 2000).
  struct Scheme {
    explicit Scheme(double rho)
        : alpha_f(1 / (1 + rho)),
          alpha_m((3 - rho) / (2 * (1 + rho))),
          gamma(alpha_f),
          stage(alpha_f * gamma / alpha_m),
          memory(alpha_f * (1 - gamma / alpha_m)),
          error(1.0 / 12 + 0.25 * (1 - rho) * (1 - rho) / ((1 + rho) * (1 + rho))) {}
    double alpha_f, alpha_m, gamma;
    double stage;   ///< Of the step, times the stage's rate: from where it was to the stage.
    double memory;  ///< And times the rate that is remembered.
    double error;   ///< Times h^3 x''': the error of a step.
  };

  [[nodiscard]] std::string input_problem(const TendonInput& tendons, const RodLoads& loads) const;
  RodStep step(RodState& state, const TendonInput& tendons, const RodLoads& loads, double h);
  /// Tensions of tendons that are pulled in by so much, where the rod was placed.
  void find_tensions(const std::vector<double>& displacements);
  /// The rod placed at a state, mass matrix factored, velocity_ there.
  bool find_velocity(const RodState& state);
  [[nodiscard]] RodDynamicsSlopes slopes(const RodState& state, const TendonInput& tendons,
                                         const RodLoads& loads);

  RodDynamicsConfig config;
  Scheme scheme;
  RodChain chain;
  RodLayout layout;
  RodMotion<double> motion;
  RodMatrix matrix;
  const RodSurroundings* surroundings = nullptr;
  std::vector<double> rest_lengths, compliance;  // m, m/N
  std::vector<double> tensions;
  Eigen::VectorXd velocity;
  /// Bodies of nodes that carry payloads, as they are without.
  std::vector<std::pair<std::size_t, RodLayout::Body>> bare = {};

 private:
  struct Stage {
    double stretch;  // h times scheme.stage.
    bool by_displacement;
  };
  void guess(const RodState& state, double h);
  bool solve_with_tendons(const TendonInput& tendons, double stretch);
  bool pull_tight();

  Eigen::VectorXd q_from_, p_from_, q_, momentum_, force_, change_, total_;
  // Of displacements: by tendon.
  Eigen::MatrixXd length_slopes_, answers_, give_, pivot_;
  Eigen::VectorXd lengths_, wanted_, found_, pull_change_;
  std::vector<char> taut_;
  bool is_pulled_ = false;
};

}  // namespace flexura
