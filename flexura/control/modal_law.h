#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "flexura/control/predictive_law.h"
#include "flexura/model/arm.h"

namespace flexura {

/// How a ModalLaw chooses the force in each mode of oscillation.
enum class ModalLawKind : std::uint8_t {
  /// Cancels the arm's own dynamics: in all modes, errors decay as critically damped oscillators with equal
  /// rates.
  computed_torque,
  /// Artificial potential with dissipation. The potential is a share of the error's strain energy. Each mode
  /// is critically damped at a share of its own frequency.
  potential,
};

/// Settings of a modal law.
struct ModalLawConfig {
  ModalLawKind kind = ModalLawKind::computed_torque;
  double step = 1.0 / 30;  ///< Time between commands, s; > 0.
  /// Rate at which errors decay, 1/s; > 0. With the potential, this is the rate in the slowest mode.
  double rate = 4;
};

/// Control of an oscillating arm by the forces in its modes (docs/control.md, "Computed torque and artificial
/// potential"). Tendons act on the arm as springs: a command moves the equilibrium, and the force in a mode
/// is proportional to the distance of the arm from the equilibrium. The law chooses the equilibrium whose
/// force gives the desired acceleration. Parts of the error outside of the modes decay at the configured
/// rate. For an arm without modes, the law is resolved-rate control of the shape. A limiter must check the
/// commands of the law.
class ModalLaw {
 public:
  /// `driven`: the arm in terms of the sections that the drives bend. Throws std::invalid_argument for
  /// numbers out of range.
  ModalLaw(const Arm& driven, const ModalLawConfig& config);

  /// Returns the command for the end of the next step. `by_command`: derivative of the equilibrium shape with
  /// respect to the command, (3 arcs) x (3 sections) (Actuation::slopes).
  [[nodiscard]] ArmState step(const PredictiveState& now, const Eigen::MatrixXd& by_command) const;

 private:
  Arm driven_;
  ModalLawConfig config_;
};

}  // namespace flexura
