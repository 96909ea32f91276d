#pragma once

#include <Eigen/Core>
#include <optional>

#include "flexura/model/arm.h"
#include "flexura/safety/contact_watch.h"

namespace flexura {

/// Clearance of an arm and its derivative.
struct ClearanceSlope {
  double clearance = 0;         ///< Clearance, m.
  Eigen::RowVectorXd by_state;  ///< Derivatives with respect to bend_x, bend_y and stretch of each section.
};

/// Returns the clearance of a possible state and its derivative, by central differences of 1e-3 rad. Returns
/// std::nullopt if the clearance is at least `reach`, m. `arm`: the arm of `watch`.
[[nodiscard]] std::optional<ClearanceSlope> clearance_slope(const ContactWatch& watch, const Arm& arm,
                                                            const ArmState& state, double reach);

}  // namespace flexura
