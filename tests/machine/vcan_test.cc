// CiA 402 on vcan, the kernel's virtual CAN bus: the driver and the simulated drives on sockets of the
// kernel, with can-utils and python-can as peers. Runs in the virtual machine of run.sh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "flexura/equipment/cia402_device.h"
#include "flexura/equipment/cia402_drive.h"
#include "flexura/equipment/device_server.h"
#include "flexura/equipment/guard.h"
#include "flexura/equipment/wall_clock.h"
#include "tests/support/checkout.h"
#include "tests/support/fault_of.h"
#include "tests/support/spawned.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

constexpr double bus_patience = 60;  // Longest time that a test waits for anything, s.

std::unique_ptr<Link> bus_link() {
  auto opened = open_link(parse_link_address("can:vcan0"));
  if (!opened) throw std::runtime_error(opened.fault()->what);
  return std::move(opened).value();
}

// Waits until a condition holds. Returns whether it does.
bool holds(const std::function<bool()>& condition) {
  const double end = steady_seconds() + bus_patience;
  while (!condition()) {
    if (steady_seconds() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

void set_up(bool is_up) {
  const Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq request{};
  std::ranges::copy(std::string("vcan0"), std::begin(request.ifr_name));
  ASSERT_EQ(::ioctl(socket.get(), SIOCGIFFLAGS, &request), 0);
  request.ifr_flags = static_cast<short>(is_up ? request.ifr_flags | IFF_UP : request.ifr_flags & ~IFF_UP);
  ASSERT_EQ(::ioctl(socket.get(), SIOCSIFFLAGS, &request), 0);
}

// A program of can-utils that runs until the end of a test.
struct CanProgram : Spawned {
  explicit CanProgram(const std::string& command) : Spawned({"sh", "-c", "exec " + command}) {}
};

// A running candump.
class CanLog {
 public:
  CanLog() : program_("stdbuf -oL candump -L vcan0 >" + path_) {
    // Frames from before its start are not in its log.
    if (!holds([&] {
          mark("7FE#01");
          return !lines(" 7FE#").empty();
        }))
      throw std::runtime_error("candump writes nothing");
  }

  // Returns the frames, "ID#DATA", that contain `part`, in their order, up to now.
  std::vector<std::string> frames(const std::string& part) {
    mark("7FF#02");
    if (!holds([&] { return !lines(" 7FF#").empty(); })) throw std::runtime_error("candump has stopped");
    return lines(part);
  }

 private:
  static void mark(const std::string& frame) {
    Spawned sender({"cansend", "vcan0", frame});
    (void)sender.line();  // "" at its end.
  }
  std::vector<std::string> lines(const std::string& part) const {
    std::vector<std::string> found;
    std::ifstream file(path_);
    for (std::string line; std::getline(file, line);) {
      std::istringstream words(line);  // (time) vcan0 ID#DATA
      std::string time, interface, frame;
      words >> time >> interface >> frame;
      if ((' ' + frame).find(part) != std::string::npos) found.push_back(frame);
    }
    return found;
  }

  const std::string path_ = "/dev/shm/candump.log";
  CanProgram program_;
};

// Configuration of drives on a machine that may be slow.
Cia402Config patient(std::initializer_list<std::int64_t> nodes) {
  Cia402Config config;
  config.link = "can:vcan0";
  config.answer_timeout = 1, config.settling = 20, config.power_timeout = 30, config.heartbeat = 1;
  for (const std::int64_t node : nodes) {
    Cia402AxisConfig axis;
    axis.node = node;
    axis.limits = {-50'000, 50'000};
    config.axes.push_back(axis);
  }
  return config;
}

// Commands, and waits for the end of the motion. Returns the fault or "".
std::string moved(Cia402Drive& drive, const std::vector<double>& targets, double duration) {
  if (const auto done = drive.command(targets, duration); !done) return fault_of(done);
  std::string fault;
  const bool is_over = holds([&] {
    const auto reading = drive.read();
    fault = fault_of(reading);
    return !reading || !reading.value().moving;
  });
  return is_over ? fault : "it moves on";
}

// Simulated drives 1 and 2 on the bus, and the driver.
class Vcan : public ::testing::Test {
 protected:
  Vcan()
      : device_({{.node = 1}, {.node = 2}}),
        server_(bus_link(), device_),
        link_(bus_link()),
        drive_(*link_, clock_, patient({1, 2})) {}

  std::vector<double> positions() {
    const auto lock = server_.lock();
    return device_.positions(DeviceServer::now());
  }

  WallClock clock_;
  Cia402Device device_;
  DeviceServer server_;
  std::unique_ptr<Link> link_;
  Cia402Drive drive_;
};

TEST_F(Vcan, MovesAsCandumpSees) {
  CanLog log;
  ASSERT_EQ(fault_of(drive_.start()), "");
  ASSERT_EQ(moved(drive_, {1000, -2000}, 0.5), "");
  EXPECT_EQ(drive_.read().value().values, (std::vector<double>{1000, -2000}));
  EXPECT_EQ(positions(), (std::vector<double>{1000, -2000}));
  // The network's command "start", and the target with controlword 0x3F, lowest byte first.
  EXPECT_EQ(log.frames(" 000#0101").size(), 1U);
  EXPECT_EQ(log.frames(" 000#0102").size(), 1U);
  EXPECT_GE(log.frames(" 201#3F00E8030000").size(), 1U);
  EXPECT_GE(log.frames(" 202#3F0030F8FFFF").size(), 1U);
  // Each SYNC has one answer of each drive; the last says: enabled, target reached, and where.
  const std::size_t syncs = log.frames(" 080#").size();
  const auto first = log.frames(" 181#"), second = log.frames(" 182#");
  EXPECT_GE(syncs, 8U);
  EXPECT_EQ(first.size(), syncs);
  EXPECT_EQ(second.size(), syncs);
  EXPECT_EQ(first.back().substr(8), "E8030000");
  EXPECT_EQ(second.back().substr(8), "30F8FFFF");
  EXPECT_EQ(std::stoul(first.back().substr(6, 2) + first.back().substr(4, 2), nullptr, 16) & 0x46F, 0x427U);
  EXPECT_EQ(log.frames(" 58").size(), log.frames(" 60").size());  // Each request by SDO has one answer.
}

TEST_F(Vcan, IgnoresForeignFrames) {
  // Extended identifiers, whose low 11 bits may be ours; remote requests; frames of another node and of wrong
  // sizes.
  const CanProgram extended("cangen vcan0 -e -g 8 -I r -L r -D r"),
      own("cangen vcan0 -e -g 11 -I 181 -L 6 -D r"), remote("cangen vcan0 -R -g 11 -I 181 -L 6"),
      foreign("cangen vcan0 -g 11 -I 189 -L 6 -D r"), request("cangen vcan0 -R -g 13 -I 601 -L 8"),
      short_one("cangen vcan0 -g 13 -I 181 -L 3 -D r"), short_reply("cangen vcan0 -g 13 -I 581 -L 5 -D r");
  CanLog log;
  ASSERT_EQ(fault_of(drive_.start()), "");
  EXPECT_EQ(drive_.identities()[1].name, "Flexura simulated stepper");
  for (const double target : {700.0, -300.0, 0.0}) {
    ASSERT_EQ(moved(drive_, {target, -target}, 0.2), "");
    EXPECT_EQ(positions(), (std::vector<double>{target, -target}));
  }
  EXPECT_GT(log.frames(" 189#").size(), 5U);
  EXPECT_GT(log.frames(" 00000181#").size(), 5U);
  EXPECT_GT(log.frames(" 181#R").size(), 5U);
}

TEST_F(Vcan, TellsWhatTheInterfaceReports) {
  ASSERT_EQ(fault_of(drive_.start()), "");
  {
    const auto lock = server_.lock();
    device_.set_connected(1, false);
  }
  // The error frame "bus off".
  Spawned sender({"cansend", "vcan0", "20000040#0000000000000000"});
  (void)sender.line();
  EXPECT_THAT(fault_of(drive_.read()), ::testing::AllOf(HasSubstr("axis 2 (node 2) does not answer"),
                                                        HasSubstr("the bus reports: bus off")));
}

TEST_F(Vcan, StartsAgainAfterTheInterfaceWasDown) {
  ASSERT_EQ(fault_of(drive_.start()), "");
  set_up(false);
  EXPECT_THAT(fault_of(drive_.read()), HasSubstr("can:vcan0"));
  EXPECT_THAT(open_link(parse_link_address("can:vcan0")).fault()->what, HasSubstr("the interface is down"));
  set_up(true);
  EXPECT_TRUE(holds([&] { return fault_of(drive_.start()).empty(); }));
  EXPECT_EQ(moved(drive_, {500, 500}, 0.1), "");
  EXPECT_EQ(positions(), (std::vector<double>{500, 500}));
}

TEST_F(Vcan, GuardStopsTheDrives) {
  ASSERT_EQ(fault_of(drive_.start()), "");
  Guard guard(bus_patience);
  guard.protect(*link_, cia402_stop(patient({1, 2})));
  ASSERT_EQ(fault_of(drive_.command(std::vector<double>{50'000, -50'000}, 600)), "");
  EXPECT_TRUE(holds([&] { return positions()[0] > 10; }));
  guard.stop();
  EXPECT_TRUE(holds([&] {
    const auto lock = server_.lock();
    return device_.node(0).nmt_state() == NmtState::stopped &&
           device_.node(1).nmt_state() == NmtState::stopped;
  }));
  EXPECT_EQ(positions(), positions());
  EXPECT_LT(positions()[0], 50'000);
}

TEST_F(Vcan, WorksWithPythonCan) {
  // A client that moves the simulated drive 2, then a drive 5.
  Spawned peer({"/usr/bin/python3", checkout_file("tests/machine/cia402_peer.py"), "vcan0", "2", "5"});
  ASSERT_EQ(peer.line(), "passed");
  EXPECT_EQ(positions()[1], -1500);
  ASSERT_EQ(peer.line(), "ready");
  const auto link = bus_link();
  Cia402Drive drive(*link, clock_, patient({5}));
  ASSERT_EQ(fault_of(drive.start()), "");
  const auto identity = drive.identities()[0];
  EXPECT_EQ(identity.name, "A drive on python-can");
  EXPECT_EQ(identity.vendor, 0x1234U);
  EXPECT_EQ(identity.product, 0x5678U);
  ASSERT_EQ(moved(drive, {1234}, 0.3), "");
  EXPECT_EQ(drive.read().value().values[0], 1234);
  ASSERT_EQ(moved(drive, {-56}, 0), "");
  EXPECT_EQ(drive.read().value().values[0], -56);
  // A quick stop in mid-move, and on from there.
  ASSERT_EQ(fault_of(drive.command(std::vector<double>{50'000}, 600)), "");
  ASSERT_TRUE(holds([&] { return drive.read().value().values[0] > 0; }));
  ASSERT_EQ(fault_of(drive.halt()), "");
  const double stopped = drive.read().value().values[0];
  EXPECT_GT(stopped, 0);
  EXPECT_LT(stopped, 50'000);
  EXPECT_EQ(drive.read().value().values[0], stopped);
  ASSERT_EQ(moved(drive, {100}, 0.1), "");
  EXPECT_EQ(drive.read().value().values[0], 100);
  ASSERT_EQ(fault_of(drive.release()), "");
}

}  // namespace
}  // namespace flexura
