// Any bytes as VISCA messages: to the parsers of both sides, to a simulated head, and to the driver in
// between the answers of that head. The driver must end each request after a bounded number of reads, without
// an exception, and report finite positions only.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include "flexura/equipment/visca_device.h"
#include "flexura/equipment/visca_head.h"

namespace {

using namespace flexura;

void require(bool holds) {
  if (!holds) std::abort();
}

void check_reply(std::string_view packet) {
  const auto reply = parse_visca_reply(packet);
  if (!reply) return;
  require(bytes_of(*reply) == packet);
  (void)parse_visca_version(reply->data);
  if (const auto place = parse_visca_place(reply->data, {5, 4}))
    require(visca_place_data(*place, {5, 4}) == reply->data);
  if (const auto zoom = parse_visca_zoom(reply->data)) require(visca_zoom_data(*zoom) == reply->data);
}

void check_parsers(std::string_view bytes) {
  ViscaSplitter splitter;
  for (const std::string& packet : splitter.take(bytes)) {
    require(packet.size() <= visca_longest && packet.ends_with('\xFF'));
    check_reply(packet);
    (void)parse_visca_request(packet, {});
    (void)parse_visca_request(packet, {5, 5});
  }
  check_reply(bytes);
  if (const auto message = parse_sony(bytes)) require(bytes_of(*message) == bytes);
}

void check_device(std::string_view bytes, ViscaFraming framing) {
  ViscaDevice device(framing);
  device.add({});
  if (framing == ViscaFraming::stream) {
    device.add({});
    (void)device.receive("\x88\x30\x01\xFF", 0);
  }
  constexpr std::size_t step = 13;
  double now = 0;
  for (std::size_t i = 0; i < bytes.size(); i += step) {
    now += 0.01;
    for (const std::string& answer : device.receive(bytes.substr(i, step), now)) {
      if (framing == ViscaFraming::sony) {
        require(parse_sony(answer).has_value());
      } else {
        require(parse_visca_reply(answer).has_value());
      }
    }
  }
}

// A simulated head whose answers the input loses, repeats or replaces by its own bytes.
class FuzzedWire : public Link {
 public:
  FuzzedWire(ViscaDevice& device, std::string_view script) : device_(device), script_(script) {}
  [[nodiscard]] const std::string& name() const override { return name_; }
  CommandOutcome write(std::string_view bytes) override {
    for (std::string& answer : device_.receive(bytes, time)) answers_ += answer, last_ = std::move(answer);
    return Accepted{};
  }
  Outcome<std::string> read(double timeout) override {
    constexpr int most = 20000;
    require(++reads_ < most);
    time += timeout;
    for (std::string& answer : device_.advance(time)) answers_ += answer, last_ = std::move(answer);
    if (timeout == 0) return std::string();
    const unsigned what = script_.empty() ? 0 : static_cast<unsigned char>(script_.front());
    if (!script_.empty()) script_.remove_prefix(1);
    std::string heard;
    if (what < 0x80) {
      heard.swap(answers_);
    } else if (what < 0x90) {
      answers_.clear();
    } else if (what < 0xA0) {
      heard = last_;
    } else {
      heard = script_.substr(0, what - 0xA0);
      script_.remove_prefix(heard.size());
      if ((what & 1) != 0) heard += answers_, answers_.clear();
    }
    return heard;
  }
  double time = 0;

 private:
  ViscaDevice& device_;
  std::string_view script_;
  std::string name_ = "fuzz", answers_, last_;
  int reads_ = 0;
};

void check_driver(std::string_view script, ViscaFraming framing) {
  ViscaHeadModel model;
  model.reply_delay = 0;
  ViscaDevice device(framing);
  device.add(model);
  auto made = std::make_unique<FuzzedWire>(device, script);
  const FuzzedWire& wire = *made;
  ViscaConfig config;
  config.bus.link = "/dev/fuzz";
  config.bus.framing = framing;
  config.bus.reply_timeout = 0.05;
  config.bus.tries = 2;
  const auto bus = std::make_shared<ViscaBus>(std::move(made), config.bus, [&] { return wire.time; });
  ViscaHead head(bus, config);
  (void)bus->start();
  (void)head.start();
  for (int i = 0; i < 3; ++i) {
    const auto sent = head.command({0.2 * i, 0.1, 100.0 * i});
    if (!sent) require(!sent.fault()->what.empty());
    const auto read = head.read();
    if (read) {
      const HeadReading& reading = read.value();
      require(std::isfinite(reading.time) && std::isfinite(reading.state.pan) &&
              std::isfinite(reading.state.tilt) && std::isfinite(reading.state.zoom));
    } else {
      require(!read.fault()->what.empty() && read.fault()->what.find('\n') == std::string::npos);
    }
    (void)head.halt();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto framing = static_cast<ViscaFraming>(data[0] % 3);
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  check_parsers(bytes);
  check_device(bytes, framing);
  check_driver(bytes, framing);
  return 0;
}
