#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace flexura {

/// Arguments of `flexura jog`.
struct JogArguments {
  std::string experiment, axis, distance;
  std::vector<std::string> sets;
  bool here = false;  ///< Whether the arm has its initial shape now, so that nothing is homed.
  bool json = false;
};

/// `flexura jog`: moves one axis of the equipment by hand, within limits. Throws InputError for bad input,
/// and std::runtime_error if a device fails. Returns an exit status: exit_missed if the motion is refused.
int jog_command(const JogArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace flexura
