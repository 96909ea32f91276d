#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "flexura/control/predictive_law.h"
#include "flexura/model/arm.h"

namespace flexura {

/// How a ModalLaw chooses the force in each mode of an arm that swings.
enum class ModalLawKind : std::uint8_t {
  /// Cancels the arm's own dynamics: errors decay as a critically damped oscillator at one rate in all modes.
  computed_torque,
  /// Artificial potential, a share of the strain energy of the error, with dissipation: each mode is
  /// critically damped at a share of its own frequency.
  potential,
};

/// Settings of a modal law.
struct ModalLawConfig {
  ModalLawKind kind = ModalLawKind::computed_torque;
  double step = 1.0 / 30;  ///< Time between commands, s; > 0.
  double rate = 4;         ///< Rate at which errors decay, 1/s; > 0. For the potential: in the slowest mode.
};

/// Control of an arm that swings by the forces in its modes (docs/control.md, "Computed torque and artificial
/// potential"). Tendons act on the arm as springs: a command moves the equilibrium, and the force in a mode
/// is proportional to the distance of the arm from it. The law chooses the equilibrium whose force gives the
/// desired acceleration. Parts of the error outside of the modes decay at the same rate. For an arm without
/// modes it is resolved-rate control of the shape. Its result is a request, for a limiter.
class ModalLaw {
 public:
  /// `driven`: the arm as its drives move it. Throws std::invalid_argument for numbers out of their ranges.
  ModalLaw(const Arm& driven, const ModalLawConfig& config);

  /// Returns the command for the end of the next step. `by_command`: derivative of the shape at rest with
  /// respect to the command, 3 arcs x 3 sections (Actuation::slopes).
  [[nodiscard]] ArmState step(const PredictiveState& now, const Eigen::MatrixXd& by_command) const;

 private:
  Arm driven_;
  ModalLawConfig config_;
};

}  // namespace flexura
