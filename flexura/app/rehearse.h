#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "flexura/equipment/video_server.h"

namespace flexura {

/// Arguments of `flexura rehearse`.
struct RehearseArguments {
  std::string experiment;
  std::string out;  ///< File to write; "": default.
  std::vector<std::string> sets;
  std::string video = "raw";  ///< Name of the videos' encoding.
  VideoServerConfig server;   ///< The command sets its `encoding` according to `video`.
};

/// Runs simulated devices around the simulated rig of an experiment until SIGINT or SIGTERM. Writes a copy of
/// the experiment whose table [rig] connects to these devices, without [truth], which only the devices use.
/// Overwrites a file only if it is an earlier copy. Throws InputError for bad input, and std::runtime_error
/// if a device cannot be started.
int rehearse_command(const RehearseArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace flexura
