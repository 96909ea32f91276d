#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/mechanics/arc_fit.h"
#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_chain.h"
#include "flexura/mechanics/statics.h"
#include "flexura/model/arm.h"
#include "flexura/model/arm_response.h"
#include "flexura/model/drive.h"

namespace flexura {

/// Response of an arm that is an elastic rod to commands (docs/mechanics.md, "The rod as a model"). The bends
/// in a command determine the displacement of each tendon, as for arcs with these bends. Without a drive, the
/// stretches in a command are factors on the lengths of the sections. The shape is the chain of arcs that is
/// nearest to the rod's equilibrium, by least squares of places along the rod.
class RodResponse : public ArmResponse {
 public:
  /// `driven` has one arc for each number in the bend profiles of its sections. With a drive, commands
  /// displace the drive's tendons, in addition to the displacements of the pretension. Without a drive,
  /// commands displace the rod's tendons. Throws std::invalid_argument for wrong numbers of sections or
  /// tendons, or an invalid rod. Also throws std::invalid_argument if there is no equilibrium under the
  /// pretension, or none under weight and loads without a command. `swings`: whether the rod has inertia, so
  /// that swing() returns modes. For such modes the rod must have a mass.
  RodResponse(const Arm& driven, const Rod& rod, RodLoads loads, std::optional<Drive> drive,
              bool swings = false);
  ~RodResponse() override;

  [[nodiscard]] ArmState shape(const ArmState& command) const override;
  /// Computes the derivatives of the equilibrium. Slack tendons count as just taut in the derivatives of
  /// commands that only take up slack. If sections have driven lengths, the derivatives are central
  /// differences with step `secant`.
  void slopes(const ArmState& command, Eigen::MatrixXd& by_command) const override;
  static constexpr double secant = 0.02;  ///< rad

  /// Returns the modes of the rod with held tendons, linearised about its equilibrium (docs/mechanics.md,
  /// "The rod as a model"). The result is empty if `swings` is not set.
  [[nodiscard]] std::vector<SwingMode> swing(const ArmState& command, std::size_t most) const override;

  [[nodiscard]] TendonTensions tensions(const ArmState& command) const override;
  /// Displacement of a released tendon: it is let out by the length of the arm.
  [[nodiscard]] std::vector<ArmState> released(const ArmState& command) const override;

  /// Returns the rod's equilibrium in the frame of its base. If there is none, the result is marked as not
  /// converged.
  [[nodiscard]] Equilibrium equilibrium(const ArmState& command) const;

 private:
  struct Answer {
    ArmState command;
    Equilibrium at;
    ArmState shape;
  };
  // A solver and a fit, and the answer at which they are.
  struct Slot {
    RodStatics statics;
    std::optional<ArcFit> fit = {};  // Of the arcs to the places, at the last fit.
    std::optional<Answer> last = {};
  };
  [[nodiscard]] Slot& now() const { return slots_[slot_]; }
  [[nodiscard]] std::vector<double> displacements(const ArmState& command) const;
  [[nodiscard]] Eigen::MatrixXd displacement_slopes(const ArmState& command) const;
  // This and the following functions require mutex_.
  Equilibrium solved(const ArmState& command, const Equilibrium& near) const;
  const Answer& answer(const ArmState& command) const;
  [[nodiscard]] ArmState fitted(const Equilibrium& at, const ArmState& command) const;
  [[nodiscard]] ArmState along_tangents(const ArmState& command) const;
  [[nodiscard]] Eigen::MatrixXd arcs_along(const Eigen::MatrixXd& dq) const;
  void analytic_slopes(RodStatics::Slack slack, Eigen::MatrixXd& by_command) const;
  void go_beyond_slack(Eigen::MatrixXd& by_command) const;
  void secant_slopes(const Answer& kept, Eigen::MatrixXd& by_command) const;

  Arm driven_, shaped_;  // in the rod's frame
  RodLoads loads_;
  std::optional<Drive> drive_;
  std::vector<double> tight_;  // displacements of the pretension, m
  ArmVariables variables_;     // of shapes
  // Places of the rod to which arcs are fitted, in its chain and in the chain of arcs.
  struct Place {
    std::size_t section = 0;
    RodNode node;
    MaterialPoint on_arcs;
  };
  std::vector<Place> places_;
  std::vector<std::size_t> ends_;    // those at the end of an arc
  bool has_driven_lengths_ = false;  // sections change their length on command

  mutable std::mutex mutex_;
  // A control step asks about two commands in turn: the one to send next and the one in effect.
  mutable std::vector<Slot> slots_;
  mutable std::size_t slot_ = 0;           // The one of the last answer.
  std::unique_ptr<RodDynamics> dynamics_;  // without tendon friction; null unless it swings
  mutable RodChain fine_;
  mutable Equilibrium straight_;  // of the command without bends
  struct KnownShape {
    ArmState command, shape;
  };
  static constexpr std::size_t most_shapes = 8;
  mutable std::deque<KnownShape> shapes_;  // Of the last commands.
};

}  // namespace flexura
