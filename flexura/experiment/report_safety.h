#pragma once

#include <cstddef>

#include "flexura/experiment/schedule.h"
#include "flexura/report/report.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// At most so many violations are drawn in pictures of their own.
inline constexpr std::size_t max_pictured_violations = 4;

/// Adds what the check found to a report whose times and states are there, and the states of the schedule at
/// the worst moments of those violations that tell most, as far as the run came.
void add_safety(const SafetyReport& safety, const Schedule& schedule, ReportData& data);

}  // namespace flexura
