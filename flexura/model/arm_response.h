#pragma once

#include <Eigen/Core>

#include "flexura/model/arm.h"

namespace flexura {

/// What commands make of an arm whose sections do not simply share their bends out: a rod that tendons,
/// weight and loads bend. A function of the command alone, which several threads may ask.
class ArmResponse {
 public:
  ArmResponse() = default;
  ArmResponse(const ArmResponse&) = delete;
  ArmResponse& operator=(const ArmResponse&) = delete;
  virtual ~ArmResponse() = default;

  /// The shape that a command makes, one bend and one stretch an arc. Bends are NaN where the arm comes to no
  /// rest. std::invalid_argument: a command of another arm.
  [[nodiscard]] virtual ArmState shape(const ArmState& command) const = 0;
  /// The derivative of the shape's (bend_x, bend_y, stretch) by the command's, 3 arcs x 3 sections: into what
  /// is made to fit. NaN where the arm comes to no rest. Errors as above.
  virtual void slopes(const ArmState& command, Eigen::MatrixXd& by_command) const = 0;
};

}  // namespace flexura
