#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/mechanics/rod_chain.h"
#include "flexura/mechanics/statics.h"
#include "flexura/model/arm.h"
#include "flexura/model/arm_response.h"
#include "flexura/model/drive.h"

namespace flexura {

/// An elastic rod as what commands make of an arm (docs/mechanics.md, "Believed"). A command's bends say how
/// far each tendon is pulled in: as far as arcs of these bends would. Without a drive its stretches are
/// factors on the sections' own lengths. The rod comes to rest, and its shape is the chain of arcs that lies
/// nearest to it, by least squares of places along the rod.
class RodResponse : public ArmResponse {
 public:
  /// `driven` has an arc for each number of its sections' bend profiles. With a drive, its tendons say how
  /// far they are pulled in, from the drive's pretension on; without one, the rod's. std::invalid_argument:
  /// another number of sections or tendons, the problems of the rod, no rest under the pretension, or under
  /// weight and loads without a command.
  RodResponse(const Arm& driven, const Rod& rod, RodLoads loads, std::optional<Drive> drive);

  [[nodiscard]] ArmState shape(const ArmState& command) const override;
  /// By the equilibrium's derivatives. Where tendons hang slack, along commands that would only take up their
  /// slack, those beyond it: as if all tendons were just taut. Of arms whose sections are driven longer it is
  /// the change over `secant` to both sides.
  void slopes(const ArmState& command, Eigen::MatrixXd& by_command) const override;
  static constexpr double secant = 0.02;  ///< rad

  /// How the rod stands, in its frame. It did not converge where the arm comes to no rest.
  [[nodiscard]] Equilibrium equilibrium(const ArmState& command) const;

 private:
  // What was answered last.
  struct Answer {
    ArmState command;
    Equilibrium at;
    ArmState shape;
  };
  [[nodiscard]] std::vector<double> displacements(const ArmState& command) const;
  [[nodiscard]] Eigen::MatrixXd displacement_slopes(const ArmState& command) const;
  // With mutex_ held, as what follows.
  Equilibrium solved(const ArmState& command, const Equilibrium& near) const;
  const Answer& answer(const ArmState& command) const;
  [[nodiscard]] ArmState fitted(const Equilibrium& at, const ArmState& command) const;
  [[nodiscard]] ArmState along_tangents(const ArmState& command) const;
  void analytic_slopes(RodStatics::Slack slack, Eigen::MatrixXd& by_command) const;
  void go_beyond_slack(Eigen::MatrixXd& by_command) const;
  void secant_slopes(const Answer& kept, Eigen::MatrixXd& by_command) const;

  Arm driven_, shaped_;  // in the rod's frame
  RodLoads loads_;
  std::optional<Drive> drive_;
  std::vector<double> tight_;  // what the pretension pulls in, m
  ArmVariables variables_;     // of shapes
  // Places of the rod to which arcs are fitted, of its chain and of the chain of arcs.
  struct Place {
    std::size_t element = 0, node = 0;
    MaterialPoint on_arcs;
  };
  std::vector<Place> places_;
  std::vector<std::size_t> ends_;    // those where an arc ends
  bool has_driven_lengths_ = false;  // sections change their length on command

  mutable std::mutex mutex_;
  mutable RodStatics statics_;
  mutable RodChain fine_;
  mutable Equilibrium straight_;  // of the command that bends nothing
  mutable std::optional<Answer> last_;
  mutable BackboneJacobian jacobian_;
  mutable Eigen::MatrixXd J_;                 // of the places by the arcs' variables, where they were fitted
  mutable Eigen::LDLT<Eigen::MatrixXd> fit_;  // of J_^T J_
};

}  // namespace flexura
