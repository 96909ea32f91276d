// Any bytes as HTTP and SOAP: to the parsers of both sides, to a simulated camera, and to the driver in
// between the answers of that camera. The driver must end each request after a bounded number of reads,
// without an exception, and report finite positions only.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "flexura/equipment/onvif_device.h"
#include "flexura/equipment/onvif_head.h"

namespace {

using namespace flexura;

void require(bool holds) {
  if (!holds) std::abort();
}

bool is_finite(const std::optional<double>& value) { return !value || std::isfinite(*value); }

void check_soap(std::string_view text) {
  (void)parse_soap_fault(text);
  require(is_finite(parse_onvif_clock(text)));
  (void)is_onvif_answer(text, "StopResponse");
  if (const auto services = parse_onvif_services(text))
    for (const std::string& path : {services->media, services->ptz})
      require(path.empty() || (path.starts_with('/') && path.find_first_of("\r\n ") == std::string::npos));
  (void)parse_onvif_profiles(text);
  if (const auto nodes = parse_onvif_nodes(text))
    for (const OnvifNode& node : *nodes)
      for (const OnvifSpace& space : node.turn)
        require(space.x.min <= space.x.max && space.y.min <= space.y.max);
  if (const auto status = parse_onvif_status(text); status && status->place)
    require(std::isfinite(status->place->pan) && std::isfinite(status->place->tilt) &&
            is_finite(status->place->zoom));
  if (const auto request = parse_onvif_request(text))
    require(is_finite(request->pan) && is_finite(request->tilt) && is_finite(request->zoom));
  if (const auto time = parse_onvif_time(text)) require(parse_onvif_time(onvif_time_text(*time)).has_value());
}

void check_http(std::string_view bytes, HttpReader::Side side) {
  for (const std::size_t step : {std::size_t{7}, bytes.size() + 1}) {
    HttpReader reader(side);
    std::size_t messages = 0;
    for (std::size_t i = 0; i < bytes.size(); i += step) {
      reader.put(bytes.substr(i, step));
      while (const auto message = reader.next()) {
        check_soap(message->body);
        require(++messages <= bytes.size());
      }
    }
    reader.close();
    (void)reader.next();
    require(reader.problem().find('\n') == std::string::npos);
  }
}

void check_device(std::string_view bytes) {
  OnvifDevice device;
  device.model().user.clear();
  OnvifStream stream(device);
  for (std::size_t i = 0; i < bytes.size(); i += 100)
    for (const OnvifChunk& chunk : stream.receive(bytes.substr(i, 100), 0.01 * static_cast<double>(i)))
      require(chunk.bytes.starts_with("HTTP/1.1 "));
  const OnvifPlace place = device.place(1e3);
  require(std::abs(place.pan) <= 1.001 && std::abs(place.tilt) <= 1.001 && std::abs(*place.zoom) <= 1.001);
}

// The script decides what becomes of each answer of the camera.
class FuzzedCamera {
 public:
  explicit FuzzedCamera(std::string_view script) : script_(script) { device_.model().reply_delay = 0; }

  OnvifPorts ports() {
    return {[this]() -> Outcome<std::unique_ptr<Link>> {
              if (take() >= 0xF8) return PortFault{FaultKind::link_lost, "refused"};
              return std::unique_ptr<Link>(std::make_unique<FuzzedConnection>(*this));
            },
            [this] { return time_; }};
  }

 private:
  class FuzzedConnection : public Link {
   public:
    explicit FuzzedConnection(FuzzedCamera& camera) : camera_(camera), stream_(camera.device_) {}
    [[nodiscard]] const std::string& name() const override { return camera_.name_; }
    CommandOutcome write(std::string_view bytes) override {
      for (OnvifChunk& chunk : stream_.receive(bytes, camera_.time_)) answers_ += chunk.bytes;
      return Accepted{};
    }
    Outcome<std::string> read(double timeout) override { return camera_.heard(answers_, timeout); }

   private:
    FuzzedCamera& camera_;
    OnvifStream stream_;
    std::string answers_;
  };

  unsigned take() {
    if (script_.empty()) return 0;
    const auto first = static_cast<unsigned char>(script_.front());
    script_.remove_prefix(1);
    return first;
  }
  Outcome<std::string> heard(std::string& answers, double timeout) {
    constexpr int most = 2000;
    require(++reads_ < most);
    const unsigned what = take();
    if (what >= 0xC0) {
      // Its own bytes, before, instead of or within the answer.
      const std::string own(script_.substr(0, what - 0xC0));
      script_.remove_prefix(own.size());
      time_ += 0.01;
      if ((what & 1) != 0) return own + std::exchange(answers, {});
      const std::size_t at = answers.size() * (what & 31) / 32;
      return std::exchange(answers, {}).replace(at, own.size(), own);
    }
    if (what >= 0xB0) return PortFault{FaultKind::link_lost, "closed"};
    if (what >= 0xA0) answers.clear();
    if (answers.empty()) time_ += timeout;
    if (what >= 0x90) return std::exchange(answers, {}).substr(0, what);
    return std::exchange(answers, {});
  }

  OnvifDevice device_;
  std::string_view script_;
  std::string name_ = "fuzz";
  double time_ = 100;
  int reads_ = 0;
};

void check_driver(std::string_view script) {
  FuzzedCamera camera(script);
  OnvifConfig config;
  config.link = "tcp:fuzz:80";
  config.user = "operator", config.password_file = "unused";
  config.tries = 2;
  OnvifHead head(camera.ports(), config, "secret");
  const auto check = [](const std::optional<PortFault>& fault) {
    if (!fault) return;
    require(!fault->what.empty() && fault->what.find('\n') == std::string::npos &&
            fault->what.find("secret") == std::string::npos);
  };
  const auto started = head.start();
  check(started.fault());
  if (!started) return;
  for (int i = 0; i < 2; ++i) {
    check(head.command({0.2 * i, 0.1, 0.3 * i}).fault());
    const auto read = head.read();
    check(read.fault());
    if (read)
      require(std::isfinite(read.value().time) && std::isfinite(read.value().state.pan) &&
              std::isfinite(read.value().state.tilt) && std::isfinite(read.value().state.zoom));
    check(head.halt().fault());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 4) {
    case 0:
      check_soap(bytes);
      break;
    case 1:
      check_http(bytes, HttpReader::Side::replies);
      break;
    case 2:
      check_http(bytes, HttpReader::Side::requests);
      check_device(bytes);
      break;
    default:
      check_driver(bytes);
  }
  return 0;
}
