// Runs a simulated Grbl controller on a pseudoterminal, for senders that others wrote
// (tests/peers/README.md).
//
//   grbl_peer [SECONDS]
//
// Prints the path to open. Ends after SECONDS (default 60) or at the end of its input, whichever is first,
// and prints the motors' positions, in microsteps, and the number of bytes that did not fit into the buffer.

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "flexura/equipment/device_server.h"
#include "flexura/equipment/grbl_device.h"
#include "flexura/equipment/wall_clock.h"

int main(int count, char** arguments) {
  try {
    using namespace flexura;
    const double duration = count > 1 ? std::atof(arguments[1]) : 60;
    GrblDevice device;
    SerialPair pair = open_serial_pair();
    DeviceServer server(std::move(pair.device), device);
    fmt::print("{}\n", pair.path);
    std::fflush(stdout);
    const WallClock clock;
    while (clock.now() < duration) {
      pollfd input{STDIN_FILENO, POLLIN, 0};
      if (::poll(&input, 1, 50) <= 0) continue;
      char byte = 0;
      if (::read(STDIN_FILENO, &byte, 1) <= 0) break;
    }
    const auto lock = server.lock();
    std::string line = "motors";
    for (const double one : device.positions(DeviceServer::now())) line += fmt::format(" {:.0f}", one);
    fmt::print("{}\nlost {}\n", line, device.lost_bytes());
    return 0;
  } catch (const std::exception& problem) {
    fmt::print(stderr, "grbl_peer: {}\n", problem.what());
    return 1;
  }
}
