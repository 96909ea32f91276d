#include "flexura/equipment/guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <limits>
#include <stdexcept>
#include <string>

#include "flexura/equipment/wall_clock.h"

namespace flexura {
namespace {

constexpr double guard_patience = 30;  // s; what is expected comes much earlier.

// A link to a device, which hears what it is sent.
struct Line {
  Line() {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
      throw std::runtime_error("no sockets");
    host = adopt_link(Descriptor(ends[0]), "host"), device = adopt_link(Descriptor(ends[1]), "device");
  }
  // Returns what the device hears until nobody has the other end open.
  std::string all_heard() {
    host.reset();
    std::string heard;
    for (;;) {
      const auto part = device->read(guard_patience);
      if (!part || part.value().empty()) return heard;
      heard += part.value();
    }
  }
  std::unique_ptr<Link> host, device;
};

StopMessages brake_then_reset() { return {.first = {"brake;", "hold;"}, .delay = 0.02, .then = {"reset;"}}; }

// A guard whose program has ended repeats the stop four times: one may be lost.
std::string repeated_stop() {
  std::string all;
  for (int i = 0; i < 5; ++i) all += "brake;hold;reset;";
  return all;
}

StopMessages brake() { return {.first = {"brake;"}, .delay = 0, .then = {}}; }

// Runs `program` in a process of its own and returns its number.
template <class Program>
pid_t started(const Program& program) {
  const pid_t child = ::fork();
  if (child == 0) {
    program();
    ::_exit(0);
  }
  return child;
}

TEST(Guard, StopsDevicesWhenTheProgramIsKilled) {
  Line line;
  const pid_t program = started([&] {
    Guard guard(1000);
    guard.protect(*line.host, brake_then_reset());
    guard.beat(false);
    (void)line.host->write("go;");
    ::pause();
  });
  EXPECT_EQ(line.device->read(guard_patience).value(), "go;");
  ::kill(program, SIGKILL);
  ::waitpid(program, nullptr, 0);
  EXPECT_EQ(line.all_heard(), repeated_stop());
}

TEST(Guard, StopsDevicesWhenTheProgramHangs) {
  Line line;
  Guard guard(0.05);
  guard.protect(*line.host, brake_then_reset());
  const double start = steady_seconds();
  EXPECT_TRUE(guard.beat(true));
  std::string heard;
  while (heard.size() < std::string_view("brake;hold;reset;").size() &&
         steady_seconds() < start + guard_patience)
    heard += line.device->read(guard_patience).value();
  EXPECT_GE(steady_seconds() - start, 0.05);
  EXPECT_TRUE(heard.starts_with("brake;hold;reset;")) << heard;
  EXPECT_FALSE(guard.beat(false)) << "the program must learn that the devices were stopped";
  EXPECT_TRUE(guard.beat(false));
}

TEST(Guard, DoesNothingWhileTheArmRestsOrTheProgramEndsInOrder) {
  Line line;
  {
    Guard guard(0.005);
    guard.protect(*line.host, brake_then_reset());
    guard.beat(true);
    guard.beat(false);
    EXPECT_EQ(line.device->read(0.05).value(), "");
  }
  EXPECT_EQ(line.all_heard(), "");
}

TEST(Guard, SurvivesWhatEndsTheProgram) {
  Line line;
  const pid_t program = started([&] {
    ::setpgid(0, 0);
    Guard guard(1000);
    guard.protect(*line.host, brake_then_reset());
    (void)line.host->write("go;");
    ::pause();
  });
  EXPECT_EQ(line.device->read(guard_patience).value(), "go;");
  ::kill(-program, SIGINT);  // As Ctrl-C in a terminal does.
  ::waitpid(program, nullptr, 0);
  EXPECT_EQ(line.all_heard(), repeated_stop());
}

TEST(Guard, StopsAtOnceOnRequest) {
  Line line;
  Guard guard(1000);
  guard.protect(*line.host, brake_then_reset());
  guard.stop();
  // This process sends the first messages, the other all of them.
  std::string heard;
  while (heard.find("reset;") == std::string::npos) {
    const std::string part = line.device->read(guard_patience).value();
    ASSERT_FALSE(part.empty());
    heard += part;
  }
  EXPECT_TRUE(heard.starts_with("brake;")) << heard;
}

TEST(Guard, StopsAllDevicesAlsoWhenOneIsGone) {
  Line gone, line;
  Guard guard(0.01);
  guard.protect(*gone.host, brake_then_reset());
  guard.protect(*line.host, brake_then_reset());
  gone.device.reset();
  guard.beat(true);
  EXPECT_EQ(line.device->read(guard_patience).value().substr(0, 6), "brake;");
}

TEST(Guard, DiscardsWhatASerialLineHasNotSent) {
  const SerialPair pair = open_serial_pair();
  auto opened = open_link(parse_link_address(pair.path), 0.01);
  Link& host = *opened.value();
  EXPECT_FALSE(host.write(std::string(1 << 20, 'x'))) << "the line is full";
  Guard guard(1000);
  guard.protect(host, {.first = {"!"}, .delay = 0, .then = {}});
  // The guard may wait until the device takes bytes again.
  guard.stop();
  std::string heard;
  for (std::string part = "x"; !part.empty() && heard.find('!') == std::string::npos; heard += part)
    part = pair.device->read(1).value();
  EXPECT_NE(heard.find('!'), std::string::npos);
}

// A device that takes its stop over a new connection.
struct StopListener {
  StopListener() : socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET, place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof place;
    if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&place), size) != 0 ||
        ::listen(socket.get(), 4) != 0 ||
        ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&place), &size) != 0)
      throw std::runtime_error("no socket");
    address = parse_link_address("tcp:127.0.0.1:" + std::to_string(ntohs(place.sin_port)));
  }
  // Returns what the next connection says until it is closed.
  std::string heard() const {
    const auto link = adopt_link(Descriptor(::accept(socket.get(), nullptr, nullptr)), "device");
    std::string all;
    for (;;) {
      const auto part = link->read(guard_patience);
      if (!part || part.value().empty()) return all;
      all += part.value();
    }
  }
  Descriptor socket;
  LinkAddress address;
};

TEST(Guard, StopsADeviceAtAnAddressByItsNewestMessages) {
  const StopListener device;
  Line line;  // Links are stopped too, however long a connection takes.
  const pid_t program = started([&] {
    Guard guard(1000);
    const std::size_t number = guard.protect(device.address, {.first = {"old"}, .delay = 0, .then = {}});
    guard.protect(*line.host, brake_then_reset());
    guard.renew(number, {.first = {"new;", std::string(3000, 'x')}, .delay = 0, .then = {}});
    (void)line.host->write("go;");
    ::pause();
  });
  EXPECT_EQ(line.device->read(guard_patience).value(), "go;");
  ::kill(program, SIGKILL);
  ::waitpid(program, nullptr, 0);
  EXPECT_EQ(device.heard(), "new;" + std::string(3000, 'x'));
  EXPECT_EQ(line.all_heard(), repeated_stop());
}

TEST(Guard, EndsAlsoWhenADeviceAtAnAddressIsGone) {
  Line line;
  Guard guard(1000);
  {
    const StopListener gone;
    guard.protect(gone.address, brake());
  }
  guard.protect(*line.host, brake_then_reset());
  guard.stop();
  std::string heard;
  while (heard.find("reset;") == std::string::npos) heard += line.device->read(guard_patience).value();
}

TEST(Guard, RefusesWhatItCannotDo) {
  EXPECT_THROW(Guard(0.0), std::invalid_argument);
  EXPECT_THROW(Guard(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  Guard guard(1);
  Line line;
  EXPECT_THROW(guard.protect(*line.host,
                             {.first = {std::string(Guard::messages_size + 1, 'x')}, .delay = 0, .then = {}}),
               std::invalid_argument);
  EXPECT_THROW(
      guard.protect(*line.host, {.first = std::vector<std::string>(17, "x"), .delay = 0, .then = {}}),
      std::invalid_argument);
  EXPECT_THROW(guard.protect(parse_link_address("udp:127.0.0.1:9"), brake()), std::invalid_argument);
  EXPECT_THROW(guard.protect(parse_link_address("tcp:127.0.0.1:9"), brake_then_reset()),
               std::invalid_argument);
  EXPECT_THROW(guard.renew(0, brake()), std::invalid_argument);
  for (std::size_t i = 0; i < Guard::most_links; ++i) guard.protect(*line.host, brake_then_reset());
  EXPECT_THROW(guard.protect(*line.host, brake_then_reset()), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
