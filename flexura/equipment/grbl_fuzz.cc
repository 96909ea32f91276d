// Interprets any bytes as what travels on the serial line of a Grbl controller: to the driver's side, to the
// simulated controller, and between the two. Each call ends, no number is NaN, and nothing is thrown.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/equipment/grbl_device.h"
#include "flexura/equipment/grbl_drive.h"

namespace {

using namespace flexura;

void require(bool condition) {
  if (!condition) std::abort();
}

class FuzzClock : public ClockPort {
 public:
  [[nodiscard]] double now() const override { return time; }
  void wait_until(double) override {}
  double time = 0;
};

// Answers by the input, then not at all. Time passes when nothing arrives.
class ScriptedLink : public Link {
 public:
  ScriptedLink(std::string_view script, FuzzClock& clock) : script_(script), clock_(clock) {}
  [[nodiscard]] const std::string& name() const override { return name_; }
  CommandOutcome write(std::string_view bytes) override {
    if (bytes.find('\xff') != std::string_view::npos) return PortFault{FaultKind::link_lost, "gone"};
    return Accepted{};
  }
  Outcome<std::string> read(double timeout) override {
    clock_.time += 1e-3;
    if (script_.empty() || script_.front() == '\0') {
      script_.remove_prefix(std::min<std::size_t>(1, script_.size()));
      clock_.time += timeout;
      return std::string();
    }
    // What arrives at once ends at a zero byte.
    const std::string_view part = script_.substr(0, script_.find('\0'));
    script_.remove_prefix(part.size());
    return std::string(part);
  }

 private:
  std::string name_ = "fuzz";
  std::string_view script_;
  FuzzClock& clock_;
};

// Connects a drive to a simulated controller; the input disturbs the line.
class DisturbedLink : public Link {
 public:
  DisturbedLink(std::string_view script, FuzzClock& clock, GrblDevice& device)
      : script_(script), clock_(clock), device_(device) {}
  [[nodiscard]] const std::string& name() const override { return name_; }
  CommandOutcome write(std::string_view bytes) override {
    hear(device_.receive(disturbed(std::string(bytes)), clock_.time));
    return Accepted{};
  }
  Outcome<std::string> read(double timeout) override {
    clock_.time += std::max(1e-3, heard_.empty() ? timeout : 0);
    hear(device_.advance(clock_.time));
    return std::exchange(heard_, {});
  }

 private:
  std::uint8_t next() {
    if (script_.empty()) return 0;
    const auto byte = static_cast<std::uint8_t>(script_.front());
    script_.remove_prefix(1);
    return byte;
  }
  std::string disturbed(std::string message) {
    const std::uint8_t kind = next();
    if (kind > 250) return {};
    if (kind > 245) return message + message;
    if (kind > 240) return message.substr(0, message.size() / 2);
    if (kind > 220 && !message.empty()) message[next() % message.size()] = static_cast<char>(next());
    if (kind > 218) device_.restart(clock_.time);
    if (kind > 216) device_.raise_alarm(kind % 20, clock_.time);
    return message;
  }
  void hear(const std::vector<std::string>& messages) {
    for (const std::string& one : messages) heard_ += disturbed(one);
  }
  std::string name_ = "fuzz", heard_;
  std::string_view script_;
  FuzzClock& clock_;
  GrblDevice& device_;
};

GrblConfig impatient() {
  GrblConfig config;
  config.answer_timeout = 0.02, config.connect_timeout = 0.1, config.stop_timeout = 0.3;
  config.homing_timeout = 0.5, config.writes_settings = true;
  return config;
}

void use(GrblDrive& drive) {
  (void)drive.connect();
  (void)drive.unlock();
  (void)drive.set_positions(std::vector<double>{0, 0, 0});
  for (const double target : {50.0, -20.0, 1e9}) {
    (void)drive.command(std::vector<double>{target, 1, 2}, 0.05);
    const auto reading = drive.read();
    if (!reading) continue;
    require(std::isfinite(reading.value().time));
    for (const double one : reading.value().values) require(std::isfinite(one));
  }
  (void)drive.halt();
  (void)drive.home(std::vector<double>{0, 0, 0});
  (void)drive.read();
}

void fuzz_driver(std::string_view bytes) {
  for (std::string_view rest = bytes; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    const GrblMessage message = parse_grbl(line);
    if (const auto* const status = std::get_if<GrblStatus>(&message)) {
      require(!status->positions.empty() && status->positions.size() <= grbl::most_axes);
      (void)text(*status);
    }
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
  }
  FuzzClock clock;
  GrblDrive drive(std::make_unique<ScriptedLink>(bytes, clock), clock, impatient());
  use(drive);
  require(clock.time < 1000);
}

void fuzz_device(std::string_view bytes, bool is_grblhal) {
  GrblDevice device({.axes = is_grblhal ? 5U : 3U, .is_grblhal = is_grblhal, .settings = {{22, 1}}});
  double now = 0;
  while (!bytes.empty()) {
    const std::string_view part = bytes.substr(0, bytes.find('\0'));
    (void)device.receive(part, now);
    now += 0.01;
    bytes.remove_prefix(std::min(part.size() + 1, bytes.size()));
    for (const double one : device.positions(now)) require(std::isfinite(one));
  }
  (void)device.advance(now + 0.1);
}

void fuzz_both(std::string_view bytes) {
  FuzzClock clock;
  GrblDevice device;
  GrblDrive drive(std::make_unique<DisturbedLink>(bytes, clock, device), clock, impatient());
  use(drive);
  require(clock.time < 1000);
  for (const double one : device.positions(clock.time)) require(std::isfinite(one));
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 4) {
    case 0:
      fuzz_driver(bytes);
      break;
    case 1:
      fuzz_device(bytes, false);
      break;
    case 2:
      fuzz_device(bytes, true);
      break;
    default:
      fuzz_both(bytes);
  }
  return 0;
}
