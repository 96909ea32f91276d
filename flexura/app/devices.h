#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace flexura {

/// Arguments of `flexura devices`.
struct DevicesArguments {
  std::string experiment;  ///< File with the devices to connect to; "": list the devices of this machine.
  std::vector<std::string> probes;  ///< Links at which to ask for a device; "all": every serial line found.
  std::vector<std::string> sets;
  bool json = false;
};

/// `flexura devices`: lists what is connected, or connects to the devices of a file. Throws InputError for
/// bad input. Returns an exit status: exit_system_failure if a device of the file cannot be used.
int devices_command(const DevicesArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace flexura
