#pragma once

#include <cstddef>

#include "flexura/experiment/schedule.h"
#include "flexura/report/report.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// At most so many violations are drawn in pictures of their own.
inline constexpr std::size_t max_pictured_violations = 4;

/// Adds the schedule's state at `time` to a report whose times and states are there, where none is of that
/// time: between the steps of the clock and of the log, too. Nothing beyond the last of them, and nothing
/// that is not possible.
void add_state(double time, const Schedule& schedule, ReportData& data);

/// Adds what the check found to a report whose times and states are there, and the states of the schedule at
/// the worst moments of those violations that tell most, one of each group, as far as the run came.
void add_safety(const SafetyReport& safety, const Schedule& schedule, ReportData& data);

}  // namespace flexura
