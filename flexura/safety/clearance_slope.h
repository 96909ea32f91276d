#pragma once

#include <Eigen/Core>
#include <optional>

#include "flexura/model/arm.h"
#include "flexura/safety/contact_watch.h"

namespace flexura {

/// Clearance of an arm and its derivative.
struct ClearanceSlope {
  double clearance = 0;         ///< m
  Eigen::RowVectorXd by_state;  ///< By (bend_x, bend_y, stretch) of each section.
};

/// Returns the clearance of a possible state with its derivative, by central differences of 1e-3 rad. Empty
/// if the clearance is `reach`, m, or more. `arm`: that of the watch.
[[nodiscard]] std::optional<ClearanceSlope> clearance_slope(const ContactWatch& watch, const Arm& arm,
                                                            const ArmState& state, double reach);

}  // namespace flexura
