#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <deque>
#include <optional>
#include <random>
#include <stdexcept>
#include <thread>

#include "flexura/equipment/cia402_device.h"
#include "flexura/equipment/cia402_drive.h"
#include "flexura/equipment/grbl_device.h"
#include "flexura/equipment/grbl_drive.h"
#include "flexura/equipment/guarded_drive.h"
#include "flexura/equipment/wall_clock.h"

// Programs that are killed by SIGKILL at random moments while they move an arm. What follows the kill is
// measured on the device's clock, so that a busy machine does not matter. The waits only end a test that
// hangs.
namespace flexura {
namespace {

constexpr double kill_patience = 120;  // s
constexpr int kills = 10;              // Of each kind of drive, all at the same time.

// Time, in small steps, of a device; when its motors moved, and when it first heard a stop.
class WatchedDevice : public ServedDevice {
 public:
  std::vector<std::string> receive(std::string_view bytes, double now) override {
    pass(now);
    if (!stopped_ && is_stop(bytes)) stopped_ = now;
    return device().receive(bytes, now);
  }
  std::vector<std::string> advance(double now) override {
    pass(now);
    return device().advance(now);
  }
  [[nodiscard]] std::optional<double> moved() const { return moved_; }
  [[nodiscard]] std::optional<double> stopped() const { return stopped_; }

 private:
  virtual ServedDevice& device() = 0;
  virtual std::vector<double> positions_at(double now) = 0;
  [[nodiscard]] virtual bool is_stop(std::string_view bytes) const = 0;
  void pass(double now) {
    constexpr double step = 0.001;  // s
    for (double time = time_.value_or(now); time < now; time += step) look(time);
    look(now);
    time_ = now;
  }
  void look(double time) {
    std::vector<double> now = positions_at(time);
    if (!at_.empty() && now != at_) moved_ = time;
    at_ = std::move(now);
  }
  std::optional<double> time_, moved_, stopped_;
  std::vector<double> at_;
};

// One kind of drive: its device, the two ends of its line, and the program that is killed.
class KilledGrbl {
 public:
  // s; it begins with the next segment, at most 0.06 s later, and takes 0.1 s from 10,000 microsteps/s at
  // 100,000 microsteps/s^2.
  static constexpr double braking = 0.18;

  std::unique_ptr<Link> device_end() { return std::move(pair_.device); }
  WatchedDevice& device() { return device_; }
  void program(std::uint64_t seed) const {
    GrblConfig config;
    config.answer_timeout = 10, config.stop_timeout = 30, config.connect_timeout = kill_patience;
    auto link = open_link(parse_link_address(pair_.path));
    const WallClock clock;
    GrblDrive drive(std::move(link).value(), clock, config);
    Guard guard(kill_patience);
    guard.protect(drive.link(), grbl_stop(config));
    (void)drive.connect();
    (void)drive.set_positions(std::vector<double>(3, 0));
    move(drive, guard, seed);
  }

  // Commands the drive like a servo, or far away.
  static void move(DrivePort& drive, Guard& guard, std::uint64_t seed) {
    GuardedDrive guarded(drive, guard);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> share(-1, 1);
    std::vector<double> target(3);
    for (;;) {
      for (double& one : target) one = seed % 2 == 0 ? one + 100 * share(random) : 1e5 * share(random);
      (void)guarded.command(target, seed % 2 == 0 ? 1 / 30.0 : 10);
      std::this_thread::sleep_for(std::chrono::milliseconds(33));
      (void)guarded.read();
    }
  }

 private:
  class Device : public WatchedDevice {
    ServedDevice& device() override { return grbl_; }
    std::vector<double> positions_at(double now) override { return grbl_.positions(now); }
    [[nodiscard]] bool is_stop(std::string_view bytes) const override {
      return bytes.find(grbl::hold) != std::string_view::npos;
    }
    GrblDevice grbl_;
  };
  SerialPair pair_ = open_serial_pair();
  Device device_;
};

class KilledCia402 {
 public:
  static constexpr double braking = 0.1;  // s; from 20,000 microsteps/s at 400,000 microsteps/s^2.

  KilledCia402() {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
      throw std::runtime_error("no sockets");
    host_ = adopt_link(Descriptor(ends[0]), "can:killed"), end_ = adopt_link(Descriptor(ends[1]), "device");
  }
  std::unique_ptr<Link> device_end() { return std::move(end_); }
  WatchedDevice& device() { return device_; }
  void program(std::uint64_t seed) const {
    Cia402Config config;
    for (int node = 1; node <= 3; ++node) config.axes.emplace_back().node = node;
    config.answer_timeout = 10, config.power_timeout = config.settling = kill_patience;
    const WallClock clock;
    Cia402Drive drive(*host_, clock, config);
    Guard guard(kill_patience);
    guard.protect(*host_, cia402_stop(config));
    (void)drive.start();
    KilledGrbl::move(drive, guard, seed);
  }

 private:
  class Device : public WatchedDevice {
    static std::vector<Cia402NodeConfig> nodes() {
      std::vector<Cia402NodeConfig> nodes(3);
      for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].node = static_cast<std::uint8_t>(i + 1);
      return nodes;
    }
    ServedDevice& device() override { return drives_; }
    std::vector<double> positions_at(double now) override { return drives_.positions(now); }
    [[nodiscard]] bool is_stop(std::string_view bytes) const override {
      const auto frame = parse_can_frame(bytes);
      return frame && frame->id == cob::rpdo1 + 1 && number_at(*frame, 0, 2) == control_word::quick_stop;
    }
    Cia402Device drives_{nodes()};
  };
  std::unique_ptr<Link> host_, end_;
  Device device_;
};

// Waits until `is_done`. Returns false if that takes too long.
template <class Condition>
bool comes(const Condition& is_done) {
  for (const double end = steady_seconds() + kill_patience; !is_done();) {
    if (steady_seconds() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

template <class Drive>
void kill_programs() {
  std::deque<Drive> drives(kills);
  std::vector<pid_t> programs;
  // The programs start before this process has other threads.
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const pid_t program = ::fork();
    if (program == 0) {
      drives[i].program(i);
      ::_exit(1);
    }
    programs.push_back(program);
  }
  std::deque<DeviceServer> servers;
  for (Drive& drive : drives) servers.emplace_back(drive.device_end(), drive.device());
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  for (std::size_t i = 0; i < drives.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_TRUE(comes([&] {
      const auto lock = servers[i].lock();
      return drives[i].device().moved().has_value();
    })) << "the arm does not move";
    std::this_thread::sleep_for(std::chrono::duration<double>(0.1 * share(random)));
    {
      const auto lock = servers[i].lock();
      EXPECT_FALSE(drives[i].device().stopped()) << "the guard acts before the kill";
    }
    ::kill(programs[i], SIGKILL);
    ::waitpid(programs[i], nullptr, 0);
  }
  for (std::size_t i = 0; i < drives.size(); ++i) {
    SCOPED_TRACE(i);
    constexpr double watched = 0.5;  // s, after the last message of the guard.
    EXPECT_TRUE(comes([&] {
      const auto lock = servers[i].lock();
      const auto stopped = drives[i].device().stopped();
      return stopped && DeviceServer::now() > *stopped + 0.3 + watched;
    })) << "the guard does not stop the arm";
    const auto lock = servers[i].lock();
    WatchedDevice& device = drives[i].device();
    (void)device.advance(DeviceServer::now());
    EXPECT_LE(device.moved().value_or(0), device.stopped().value_or(0) + Drive::braking)
        << "the arm moves after the stop";
  }
}

TEST(GuardKill, LeavesAnArmOnGrblThatRests) { kill_programs<KilledGrbl>(); }

TEST(GuardKill, LeavesAnArmOnCanThatRests) { kill_programs<KilledCia402>(); }

}  // namespace
}  // namespace flexura
