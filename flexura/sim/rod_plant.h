#pragma once

#include <optional>
#include <vector>

#include "flexura/sim/arm_setup.h"
#include "flexura/sim/plant.h"
#include "flexura/sim/rod_inputs.h"
#include "flexura/sim/rod_tube.h"

namespace flexura {

/// A plant whose arm is an elastic rod with the inputs of RodInputs. Derived classes compute the response of
/// the arm.
class RodPlant : public Plant {
 public:
  void command(double time, const Eigen::VectorXd& u, double duration) override;
  void halt(double time) override;
  /// Does nothing for an arm with a drive, because its motors move the tendons.
  std::optional<ArmState> pull(double time, const std::vector<double>& displacements,
                               double duration) override;
  bool weigh(double time, bool on) override;
  bool push(double time, const std::optional<PlantPush>& push) override;
  [[nodiscard]] std::optional<PlantPush> pushed(double time) const override { return inputs_.pushed(time); }
  [[nodiscard]] std::optional<PlantPushForce> push_force(double time) const override;
  [[nodiscard]] bool is_weighed(double time) const override { return inputs_.is_weighed(time); }
  [[nodiscard]] std::optional<ArmState> commanded(double time) const override {
    return inputs_.commanded(time);
  }
  [[nodiscard]] std::vector<double> pulled(double time) const override { return inputs_.pulled(time); }

 protected:
  /// Throws the exceptions of RodInputs.
  explicit RodPlant(const PlantSetup& setup)
      : inputs_(setup), tube_(setup.truth.arm, inputs_.rod()), X_WB_(setup.truth.arm.X_WB) {}

  /// Called after a command. Discards results for times after the command.
  virtual void forget() = 0;
  [[nodiscard]] const RodInputs& inputs() const { return inputs_; }
  [[nodiscard]] RodInputs& inputs() { return inputs_; }
  [[nodiscard]] const RodTube& tube() const { return tube_; }

 private:
  RodInputs inputs_;
  RodTube tube_;
  Pose X_WB_;
};

}  // namespace flexura
