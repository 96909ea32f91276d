// Any bytes as frames of a CAN bus: for SDO transfers of both sides, for a simulated drive, and as all that a
// driver hears while it starts, moves, reads, homes and halts. Time is simulated.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "flexura/equipment/cia402_device.h"
#include "flexura/equipment/cia402_drive.h"

namespace {

using namespace flexura;  // NOLINT(google-build-using-namespace)

void require(bool holds) {
  if (!holds) std::abort();
}

class FuzzClock : public ClockPort {
 public:
  [[nodiscard]] double now() const override { return time; }
  void wait_until(double until) override { time = until; }
  double time = 0;
};

// Frames of nodes 1 and 2 from a few bytes each: most identifiers would be heard by nobody.
class Script {
 public:
  Script(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  [[nodiscard]] bool is_over() const { return at_ == size_; }
  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : std::uint8_t{0}; }
  CanFrame frame() {
    static constexpr std::uint32_t ids[] = {0x581, 0x181, 0x081, 0x701, 0x601, 0x201, 0x301, 0x000,
                                            0x080, 0x182, 0x582, 0x702, 0x77F, 0x082, 0x040, 0x281};
    const std::uint8_t kind = byte();
    CanFrame frame{.id = ids[kind & 15U]};
    frame.size = static_cast<std::uint8_t>(kind >> 4U);
    frame.is_error = frame.size == 15;
    if (frame.size > 8) frame.size = 8;
    for (std::size_t i = 0; i < frame.size; ++i) frame.data[i] = byte();
    return frame;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

// Answers requests truthfully as a device does, except where the script has other frames.
class FuzzLink : public Link {
 public:
  FuzzLink(Script& script, FuzzClock& clock, Cia402Device& device)
      : script_(script), clock_(clock), device_(device) {}
  [[nodiscard]] const std::string& name() const override { return name_; }
  CommandOutcome write(std::string_view bytes) override {
    require(parse_can_frame(bytes).has_value());
    clock_.time += 0.0005;
    for (std::string& answer : device_.receive(bytes, clock_.time)) queue_.push_back(std::move(answer));
    return Accepted{};
  }
  Outcome<std::string> read(double timeout) override {
    clock_.time += 0.0001;
    ++reads_;
    require(reads_ < 200'000);
    // An odd byte now and then inserts a frame or withholds an answer.
    if (!script_.is_over() && reads_ % 4 == 0) {
      const std::uint8_t choice = script_.byte();
      if (choice % 4 == 0) return bytes_of(script_.frame());
      if (choice % 4 == 1 && at_ < queue_.size()) ++at_;
      if (choice == 2) return PortFault{FaultKind::link_lost, "bus: down"};
      if (choice == 6) return std::string(choice, 'x');
    }
    if (at_ < queue_.size()) return queue_[at_++];
    queue_.clear(), at_ = 0;
    clock_.time += timeout;
    return std::string();
  }

 private:
  Script& script_;
  FuzzClock& clock_;
  Cia402Device& device_;
  std::vector<std::string> queue_;
  std::size_t at_ = 0;
  std::string name_ = "bus";
  int reads_ = 0;
};

template <class T>
void check(const Outcome<T>& outcome) {
  if (const auto fault = outcome.fault()) {
    require(!fault->what.empty() && fault->what.find('\n') == std::string::npos);
    for (const char c : fault->what) require(c >= ' ' && c <= '~');
  }
}

void drive_a_device(Script script) {
  Cia402Config config;
  config.axes.resize(1);
  config.axes[0].homing_method = 35;
  config.power_timeout = config.homing_timeout = 0.05;
  config.answer_timeout = 0.005;
  config.tries = 1;
  Cia402Device device(std::vector<Cia402NodeConfig>(1));
  FuzzClock clock;
  FuzzLink link(script, clock, device);
  Cia402Drive drive(link, clock, config);
  check(drive.start());
  const std::vector<double> targets{100.0 * script.byte()};
  check(drive.command(targets, 0.01 * script.byte()));
  const auto reading = drive.read();
  check(reading);
  if (reading) require(reading.value().values.size() == 1 && std::isfinite(reading.value().values[0]));
  if (script.byte() % 4 == 0) check(drive.home());
  check(drive.halt());
}

void hear(Script script) {
  SdoTransfer reading = SdoTransfer::reading(1, {0x1008, 0}),
              writing = SdoTransfer::writing(1, {0x6040, 0}, 6, 2);
  std::vector<Cia402NodeConfig> nodes(2);
  nodes[1].node = 2;
  Cia402Device device(nodes);
  double now = 0;
  while (!script.is_over()) {
    const CanFrame frame = script.frame();
    (void)can_error_text(frame);
    (void)drive_error_text(emergency_in(frame).code);
    (void)sdo_abort_text(number_at(frame, 4, 4));
    require(parse_can_frame(bytes_of(frame)).has_value());
    reading.take(frame), writing.take(frame);
    require(reading.data().size() <= SdoTransfer::longest + 7);
    now += 0.001 * frame.data[7];
    for (const std::string& answer : device.receive(bytes_of(frame), now))
      require(answer.size() == can_frame_size);
    for (const double position : device.positions(now)) require(std::isfinite(position));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  (void)parse_can_frame({reinterpret_cast<const char*>(data), size});
  hear({data, size});
  drive_a_device({data, size});
  return 0;
}
