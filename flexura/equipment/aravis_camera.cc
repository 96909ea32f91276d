#include "flexura/equipment/aravis_camera.h"

#include <arv.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <utility>

#include "flexura/base/one_line.h"
#include "flexura/equipment/frame_gaps.h"
#include "flexura/equipment/wall_clock.h"

namespace flexura {
namespace {

constexpr int buffer_count = 8;

struct UnrefObject {
  void operator()(void* object) const { g_object_unref(object); }
};
template <class T>
using Object = std::unique_ptr<T, UnrefObject>;

// Collects the error of a call of Aravis.
class Caught {
 public:
  Caught() = default;
  ~Caught() {
    if (error_ != nullptr) g_error_free(error_);
  }
  Caught(const Caught&) = delete;
  Caught& operator=(const Caught&) = delete;
  operator GError**() { return &error_; }  // NOLINT(google-explicit-constructor)
  [[nodiscard]] bool has_any() const { return error_ != nullptr; }
  [[nodiscard]] std::string text() const {
    return error_ != nullptr ? one_line(error_->message) : "unknown error";
  }

 private:
  GError* error_ = nullptr;
};

// Aravis' list of devices is shared by all threads.
std::mutex& finding() {
  static std::mutex mutex;
  return mutex;
}

class AravisConnection {
 public:
  AravisConnection(CameraFeed& feed, const AravisConfig& config, const CameraConfig& camera)
      : feed_(feed), config_(config), camera_(camera) {}

  ConnectionEnd run();

 private:
  [[nodiscard]] std::string shown() const {
    return config_.device.empty() ? "the first camera found" : one_line(config_.device);
  }
  [[nodiscard]] ConnectionEnd loss(const std::string& what) const {
    return {{FaultKind::link_lost, fmt::format("{}{}: {}", camera_prefix(camera_.name), shown(), what)},
            false};
  }
  [[nodiscard]] ConnectionEnd refusal(const std::string& what) const {
    return {{FaultKind::refused, fmt::format("{}{}: {}", camera_prefix(camera_.name), shown(), what)}, false};
  }
  // Sets the camera; returns what it refused, or "".
  [[nodiscard]] std::string set(ArvCamera* camera);
  [[nodiscard]] std::string set_region(ArvCamera* camera) const;
  [[nodiscard]] std::string set_light(ArvCamera* camera);
  [[nodiscard]] ConnectionEnd watch(ArvStream* stream);
  void take(ArvBuffer* buffer);

  CameraFeed& feed_;
  const AravisConfig& config_;
  const CameraConfig& camera_;
  double exposure_ = 0;  // s
  // GigE Vision numbers have 16 bits, or 64, and are never 0. Those of USB3 Vision have 64 and start at 0.
  NumberGaps gaps_{1, 0xffff};
  std::atomic<bool> is_lost_ = false;
};

ConnectionEnd AravisConnection::run() {
  Caught error;
  Object<ArvCamera> camera;
  {
    const std::scoped_lock lock(finding());
    if (config_.device.starts_with("Fake")) arv_enable_interface("Fake");
    camera.reset(arv_camera_new(config_.device.empty() ? nullptr : config_.device.c_str(), error));
  }
  if (!camera) return loss(error.text() + ": check that it is on, connected and not in use; trying again");
  if (const std::string problem = set(camera.get()); !problem.empty()) return refusal(problem);
  const Object<ArvStream> stream(arv_camera_create_stream(camera.get(), nullptr, nullptr, error));
  if (!stream) return loss(error.text() + "; trying again");
  const guint payload = arv_camera_get_payload(camera.get(), error);
  if (error.has_any()) return loss(error.text() + "; trying again");
  for (int i = 0; i < buffer_count; ++i)
    arv_stream_push_buffer(stream.get(), arv_buffer_new(payload, nullptr));
  ArvDevice* device = arv_camera_get_device(camera.get());
  const gulong handler = g_signal_connect(device, "control-lost", G_CALLBACK(+[](ArvDevice*, gpointer lost) {
                                            static_cast<std::atomic<bool>*>(lost)->store(true);
                                          }),
                                          &is_lost_);
  arv_camera_start_acquisition(camera.get(), error);
  ConnectionEnd end = error.has_any() ? loss(error.text() + "; trying again") : watch(stream.get());
  g_signal_handler_disconnect(device, handler);
  // A camera that does not answer would be waited for, and stops by itself without its controller.
  Caught ignored;
  if (feed_.is_over() && !is_lost_) arv_camera_stop_acquisition(camera.get(), ignored);
  return end;
}

std::string AravisConnection::set(ArvCamera* camera) {
  const SensorConfig& sensor = camera_.sensor;
  arv_camera_set_range_check_policy(camera, ARV_RANGE_CHECK_POLICY_ENABLE);
  Caught format;
  const ArvPixelFormat wanted =
      sensor.pixels == PixelKind::color ? ARV_PIXEL_FORMAT_RGB_8_PACKED : ARV_PIXEL_FORMAT_MONO_8;
  arv_camera_set_pixel_format(camera, wanted, format);
  if (format.has_any()) {
    return fmt::format("the camera has no pixel format {} ({}): set sensor.pixels to another",
                       sensor.pixels == PixelKind::color ? "RGB8" : "Mono8", format.text());
  }
  if (std::string problem = set_region(camera); !problem.empty()) return problem;
  Caught error;
  if (arv_camera_is_frame_rate_available(camera, error) != 0) {
    arv_camera_set_frame_rate(camera, sensor.frame_rate, error);
    if (error.has_any())
      return fmt::format("the camera refuses {:.6g} frames/s: {}", sensor.frame_rate, error.text());
  }
  Caught mode;
  arv_camera_set_acquisition_mode(camera, ARV_ACQUISITION_MODE_CONTINUOUS, mode);
  if (arv_camera_is_gv_device(camera) != 0) {
    if (!config_.packet_socket)
      arv_camera_gv_set_stream_options(camera, ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
    Caught size;
    if (config_.packet_size > 0)
      arv_camera_gv_set_packet_size(camera, static_cast<gint>(config_.packet_size), size);
    else
      arv_camera_gv_auto_packet_size(camera, size);
    if (size.has_any()) return "the camera refuses the packet size: " + size.text();
  } else {
    gaps_ = NumberGaps(0, UINT64_MAX);
  }
  return set_light(camera);
}

std::string AravisConnection::set_region(ArvCamera* camera) const {
  const auto width = static_cast<gint>(camera_.sensor.width),
             height = static_cast<gint>(camera_.sensor.height);
  Caught error;
  gint full_width = 0, full_height = 0;
  arv_camera_get_sensor_size(camera, &full_width, &full_height, error);
  if (error.has_any()) return error.text();
  if (width > full_width || height > full_height) {
    return fmt::format(
        "the camera's sensor has {} x {} pixels, fewer than {} x {}: set sensor.width and sensor.height",
        full_width, full_height, width, height);
  }
  // Offsets have increments, mostly 1, 2, 4 or 8.
  constexpr int grid = 16;
  const gint x = std::max(0, (full_width - width) / 2 / grid * grid);
  const gint y = std::max(0, (full_height - height) / 2 / grid * grid);
  const bool has_offset = arv_camera_is_region_offset_available(camera, error) != 0;
  arv_camera_set_region(camera, has_offset ? x : -1, has_offset ? y : -1, width, height, error);
  gint real_x = 0, real_y = 0, real_width = 0, real_height = 0;
  Caught reading;
  arv_camera_get_region(camera, &real_x, &real_y, &real_width, &real_height, reading);
  if (!error.has_any() && !reading.has_any() && real_width == width && real_height == height) return "";
  return fmt::format(
      "the camera gives {} x {} pixels (its sensor has {} x {}), not {} x {}: set sensor.width and "
      "sensor.height{}",
      real_width, real_height, full_width, full_height, width, height,
      error.has_any() ? " (" + error.text() + ")" : "");
}

std::string AravisConnection::set_light(ArvCamera* camera) {
  Caught error;
  if (config_.exposure) {
    if (arv_camera_is_exposure_auto_available(camera, error) != 0)
      arv_camera_set_exposure_time_auto(camera, ARV_AUTO_OFF, error);
    if (!error.has_any()) arv_camera_set_exposure_time(camera, *config_.exposure * 1e6, error);
    if (error.has_any())
      return fmt::format("the camera refuses an exposure of {:.6g} s: {}", *config_.exposure, error.text());
  }
  if (config_.gain) {
    if (arv_camera_is_gain_auto_available(camera, error) != 0)
      arv_camera_set_gain_auto(camera, ARV_AUTO_OFF, error);
    if (!error.has_any()) arv_camera_set_gain(camera, *config_.gain, error);
    if (error.has_any())
      return fmt::format("the camera refuses a gain of {:.6g}: {}", *config_.gain, error.text());
  }
  Caught reading;
  const double exposure = arv_camera_get_exposure_time(camera, reading) * 1e-6;
  exposure_ = reading.has_any() || !std::isfinite(exposure) ? 0 : std::max(exposure, 0.0);
  return "";
}

ConnectionEnd AravisConnection::watch(ArvStream* stream) {
  constexpr guint64 poll = 50000;  // µs
  std::int64_t count = 0;
  double last = steady_seconds();
  while (!feed_.is_over()) {
    if (ArvBuffer* buffer = arv_stream_timeout_pop_buffer(stream, poll); buffer != nullptr) {
      take(buffer);
      arv_stream_push_buffer(stream, buffer);
    }
    if (is_lost_) return loss("the connection is lost: check its power and its cable; trying again");
    if (const std::int64_t now = feed_.put_count(); now != count) count = now, last = steady_seconds();
    if (steady_seconds() - last > config_.silence) {
      return loss(
          fmt::format("no whole frame for {:.3g} s: check packet_size, the system's net.core.rmem_max, and "
                      "whether the camera waits "
                      "for a trigger; trying again",
                      config_.silence));
    }
  }
  return loss("closed");
}

void AravisConnection::take(ArvBuffer* buffer) {
  // The camera's numbers count damaged frames as lost.
  if (arv_buffer_get_status(buffer) != ARV_BUFFER_STATUS_SUCCESS) return;
  const SensorConfig& sensor = camera_.sensor;
  std::size_t size = 0;
  const auto* data = static_cast<const std::uint8_t*>(arv_buffer_get_image_data(buffer, &size));
  const gint width = arv_buffer_get_image_width(buffer), height = arv_buffer_get_image_height(buffer);
  if (data == nullptr || width != sensor.width || height != sensor.height) return;
  gint padding_x = 0, padding_y = 0;
  arv_buffer_get_image_padding(buffer, &padding_x, &padding_y);
  Image<std::uint8_t> image(width, height, sensor.channels());
  const std::size_t stride = image.row(0).size() + static_cast<std::size_t>(std::max(padding_x, 0));
  if (size < stride * static_cast<std::size_t>(height - 1) + image.row(0).size()) return;
  for (int v = 0; v < height; ++v)
    std::copy_n(data + static_cast<std::size_t>(v) * stride, image.row(v).size(), image.row(v).begin());
  const guint64 number = arv_buffer_get_frame_id(buffer);
  if (number > 0xffff) gaps_.widen();
  feed_.put({.picture = std::move(image),
             .time = static_cast<double>(arv_buffer_get_timestamp(buffer)) * 1e-9 + exposure_ / 2,
             .exposure = exposure_,
             .lost = gaps_.lost_before(number)});
}

}  // namespace

bool has_aravis() { return true; }

std::vector<std::string> aravis_cameras() {
  const std::scoped_lock lock(finding());
  arv_update_device_list();
  std::vector<std::string> found;
  for (guint i = 0; i < arv_get_n_devices(); ++i) {
    const char* const name = arv_get_device_id(i);
    const char* const address = arv_get_device_address(i);
    if (name == nullptr) continue;
    const std::string at = address == nullptr ? "" : fmt::format(" ({})", one_line(address));
    found.push_back(one_line(name) + at);
  }
  return found;
}

Outcome<std::unique_ptr<CountedCamera>> open_aravis_camera(const AravisConfig& config,
                                                           const CameraConfig& camera,
                                                           const ClockPort& clock) {
  if (camera.sensor.bits != 8) {
    return PortFault{FaultKind::refused,
                     camera_prefix(camera.name) + "pictures through Aravis have 8 bits: set sensor.bits = 8"};
  }
  return std::unique_ptr<CountedCamera>(std::make_unique<CameraFeed>(
      camera.name, camera.sensor.frame_rate, clock,
      [config, camera](CameraFeed& feed) { return AravisConnection(feed, config, camera).run(); },
      CameraPatience{.longest_pause = config.longest_pause}));
}

}  // namespace flexura
