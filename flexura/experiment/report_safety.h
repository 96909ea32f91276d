#pragma once

#include <cstddef>

#include "flexura/experiment/schedule.h"
#include "flexura/report/report.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// Largest number of violations with separate drawings.
inline constexpr std::size_t max_pictured_violations = 4;

/// Adds the schedule's state at `time` (s) to a report with times and states, unless the report has a state
/// at that time. The time may be between two steps of the clock or of the log. Adds nothing after the
/// report's last state, and no impossible state.
void add_state(double time, const Schedule& schedule, ReportData& data);

/// Adds the result of the check to a report with times and states. Also adds the schedule's states at the
/// worst moments of the most informative violations, one of each group, up to the end of the run.
void add_safety(const SafetyReport& safety, const Schedule& schedule, ReportData& data);

}  // namespace flexura
