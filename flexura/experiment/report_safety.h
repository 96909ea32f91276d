#pragma once

#include <cstddef>

#include "flexura/experiment/schedule.h"
#include "flexura/report/report.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// Most violations with separate pictures.
inline constexpr std::size_t max_pictured_violations = 4;

/// Adds the schedule's state at `time` to a report with times and states, unless it has one at that time. The
/// time may be between the steps of the clock and of the log. Adds nothing beyond the last of them, and no
/// impossible state.
void add_state(double time, const Schedule& schedule, ReportData& data);

/// Adds the result of the check to a report with times and states. Also adds the schedule's states at the
/// worst moments of the most informative violations, one of each group, as far as the run got.
void add_safety(const SafetyReport& safety, const Schedule& schedule, ReportData& data);

}  // namespace flexura
