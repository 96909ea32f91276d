#pragma once

#include <iosfwd>

#include "flexura/app/commands.h"

namespace flexura {

/// `flexura run EXPERIMENT --dry-run`: prints what a run would send to the equipment, without sending it.
/// Throws InputError for bad input, also for a file without equipment, and std::runtime_error if a driver
/// refuses a command. Returns an exit status.
int dry_run_command(const RunArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace flexura
