#pragma once

#include <cstddef>

#include "flexura/experiment/schedule.h"
#include "flexura/report/report.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// Largest number of violations with a drawing of their own.
inline constexpr std::size_t max_pictured_violations = 4;

/// Inserts the schedule's state at `time` (s) into the report's times and states, unless the report has a
/// state at that time. The time may be between two steps of the clock or of the log. Ignores impossible
/// states and times after the report's last state.
void add_state(double time, const Schedule& schedule, ReportData& data);

/// Adds the result of the safety check to a report that has times and states. Selects the most informative
/// violations, one per group. Inserts into the report the schedule's states at the worst moments of these
/// violations, up to the end of the run.
void add_safety(const SafetyReport& safety, const Schedule& schedule, ReportData& data);

}  // namespace flexura
