#pragma once

#include <optional>

#include "flexura/model/arm_config.h"
#include "flexura/model/arm_model.h"
#include "flexura/model/drive_config.h"

namespace flexura::python {

/// An arm as Python has it: its description, its drive if it has one, and the model made from both.
struct DescribedArm {
  DescribedArm(ArmConfig arm, std::optional<DriveConfig> with_drive);

  ArmConfig config;
  std::optional<DriveConfig> drive;
  ArmModel model;

  [[nodiscard]] std::size_t sections() const { return config.section.size(); }
  /// Returns whether several threads may use the model at once. A model with an elastic rod keeps its last
  /// solution.
  [[nodiscard]] bool is_shareable() const { return model.actuation().is_linear(); }
};

}  // namespace flexura::python
