#include "flexura/equipment/gstreamer_camera.h"

#include <fmt/format.h>
#include <gst/app/gstappsink.h>
#include <gst/gst.h>
#include <gst/video/video.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "flexura/base/one_line.h"
#include "flexura/equipment/frame_gaps.h"
#include "flexura/equipment/wall_clock.h"

namespace flexura {
namespace {

struct Unref {
  void operator()(void* object) const { gst_object_unref(object); }
  void operator()(GstSample* sample) const { gst_sample_unref(sample); }
  void operator()(GstMessage* message) const { gst_message_unref(message); }
  void operator()(GstCaps* caps) const { gst_caps_unref(caps); }
  void operator()(GError* error) const { g_error_free(error); }
  void operator()(gchar* text) const { g_free(text); }
};
template <class T>
using Held = std::unique_ptr<T, Unref>;

// Throws nothing: an installation that does not work is a fault of each camera.
std::string started() {
  static const std::string problem = [] {
    GError* error = nullptr;
    if (gst_init_check(nullptr, nullptr, &error) != 0) return std::string();
    const Held<GError> held(error);
    return std::string(held ? held->message : "unknown error");
  }();
  return problem;
}

// Returns the source for messages, without the user's name and password.
std::string shown(const std::string& source) {
  const std::size_t start = source.find("://");
  if (start == std::string::npos) return one_line(source);
  const std::size_t host = start + 3, end = source.find_first_of("/ ", host);
  const std::size_t at = source.substr(0, end).rfind('@');
  if (at == std::string::npos || at < host) return one_line(source);
  return one_line(source.substr(0, host) + source.substr(at + 1));
}

// One connection: a pipeline and what its threads leave for the connection's own thread.
class GStreamerConnection {
 public:
  GStreamerConnection(CameraFeed& feed, const GStreamerConfig& config, const CameraConfig& camera)
      : feed_(feed), config_(config), camera_(camera), gaps_(camera.sensor.frame_rate) {}

  ConnectionEnd run();

 private:
  ConnectionEnd refusal(const std::string& what, bool is_final) const {
    return {{FaultKind::refused, camera_prefix(camera_.name) + what}, is_final};
  }
  ConnectionEnd loss(const std::string& what) const {
    return {{FaultKind::link_lost,
             fmt::format("{}{}: {}", camera_prefix(camera_.name), shown(config_.source), what)},
            false};
  }
  [[nodiscard]] ConnectionEnd watch(GstElement* pipeline, bool is_live);
  [[nodiscard]] std::optional<ConnectionEnd> end_of(GstMessage* message, bool is_live) const;
  // Called in the pipeline's threads.
  static GstFlowReturn on_sample(GstAppSink* sink, gpointer self);
  static GstPadProbeReturn on_event(GstPad* pad, GstPadProbeInfo* info, gpointer self);
  void take(GstSample* sample);
  [[nodiscard]] std::optional<Picture> copied(GstBuffer* buffer, GstCaps* caps);
  [[nodiscard]] double time_of(GstBuffer* buffer, const GstSegment* segment);

  CameraFeed& feed_;
  const GStreamerConfig& config_;
  const CameraConfig& camera_;
  GstElement* pipeline_ = nullptr;
  StampGaps gaps_;
  std::optional<std::int64_t> reference_;  // Server's clock minus this machine's, ns.
  bool is_first_ = true, is_after_gap_ = false;
  std::mutex problem_mutex_;
  std::string problem_;
};

ConnectionEnd GStreamerConnection::run() {
  GError* error = nullptr;
  Held<GstElement> pipeline(gst_parse_launch_full(gstreamer_pipeline(config_, camera_.sensor).c_str(),
                                                  nullptr, GST_PARSE_FLAG_FATAL_ERRORS, &error));
  const Held<GError> held_error(error);
  if (!pipeline || error != nullptr) {
    return refusal(
        fmt::format("GStreamer does not accept \"{}\": {} (a missing element is in one of the packages "
                    "gstreamer1.0-plugins-good, -bad, -ugly or gstreamer1.0-libav)",
                    shown(config_.source), error != nullptr ? one_line(error->message) : "unknown error"),
        true);
  }
  pipeline_ = pipeline.get();
  {
    const Held<GstElement> sink(gst_bin_get_by_name(GST_BIN(pipeline_), "flexura_sink"));
    GstAppSinkCallbacks callbacks{};
    callbacks.new_sample = on_sample;
    gst_app_sink_set_callbacks(GST_APP_SINK(sink.get()), &callbacks, this, nullptr);
    const Held<GstPad> pad(gst_element_get_static_pad(sink.get(), "sink"));
    gst_pad_add_probe(pad.get(), GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, on_event, this, nullptr);
    // A file is played at its own pace; a live source's frames are taken as they come.
    const GstStateChangeReturn paused = gst_element_set_state(pipeline_, GST_STATE_PAUSED);
    const bool is_live = paused == GST_STATE_CHANGE_NO_PREROLL;
    g_object_set(sink.get(), "sync", is_live ? FALSE : TRUE, nullptr);
    gst_element_set_state(pipeline_, GST_STATE_PLAYING);
    ConnectionEnd end = watch(pipeline_, is_live);
    gst_element_set_state(pipeline_, GST_STATE_NULL);
    return end;
  }
}

ConnectionEnd GStreamerConnection::watch(GstElement* pipeline, bool is_live) {
  const Held<GstBus> bus(gst_element_get_bus(pipeline));
  constexpr auto kinds = static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS);
  std::int64_t count = 0;
  double last = steady_seconds();
  while (!feed_.is_over()) {
    const Held<GstMessage> message(gst_bus_timed_pop_filtered(bus.get(), 50 * GST_MSECOND, kinds));
    if (message) {
      if (auto end = end_of(message.get(), is_live)) return *end;
    }
    {
      const std::scoped_lock lock(problem_mutex_);
      if (!problem_.empty()) return refusal(problem_, false);
    }
    if (const std::int64_t now = feed_.put_count(); now != count) count = now, last = steady_seconds();
    if (steady_seconds() - last > config_.silence) {
      return loss(
          fmt::format("no frame for {:.3g} s: check that the camera is on and its cable is plugged in; "
                      "trying again",
                      config_.silence));
    }
  }
  return loss("closed");
}

std::optional<ConnectionEnd> GStreamerConnection::end_of(GstMessage* message, bool is_live) const {
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS) {
    if (is_live) return loss("the camera has ended the stream; trying again");
    return ConnectionEnd{
        {FaultKind::link_lost,
         fmt::format("{}{}: the recording has ended", camera_prefix(camera_.name), shown(config_.source))},
        true};
  }
  GError* error = nullptr;
  gchar* details = nullptr;
  gst_message_parse_error(message, &error, &details);
  const Held<GError> held_error(error);
  const Held<gchar> held_details(details);
  // The last line of the details has the reason of the system, for example "Failed to connect".
  std::string why = error != nullptr ? error->message : "unknown error";
  if (details != nullptr) {
    std::string reason = details;
    while (!reason.empty() && reason.back() == '\n') reason.pop_back();
    reason.erase(0, reason.rfind('\n') + 1);
    if (!reason.empty()) why += " " + reason;
  }
  return loss(one_line(why) + ": check the address and that the camera is on; trying again");
}

GstFlowReturn GStreamerConnection::on_sample(GstAppSink* sink, gpointer self) {
  const Held<GstSample> sample(gst_app_sink_pull_sample(sink));
  if (sample) static_cast<GStreamerConnection*>(self)->take(sample.get());
  return GST_FLOW_OK;
}

// Events and buffers of one pad come in one thread, in order.
GstPadProbeReturn GStreamerConnection::on_event(GstPad* /*pad*/, GstPadProbeInfo* info, gpointer self) {
  if (GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) == GST_EVENT_GAP) {
    static_cast<GStreamerConnection*>(self)->is_after_gap_ = true;
  }
  return GST_PAD_PROBE_OK;
}

void GStreamerConnection::take(GstSample* sample) {
  GstBuffer* buffer = gst_sample_get_buffer(sample);
  GstCaps* caps = gst_sample_get_caps(sample);
  if (buffer == nullptr || caps == nullptr) return;
  // Unpacked pictures are marked as discontinuous if one of their packets is missing. Other elements mark the
  // first picture so.
  const bool is_first = std::exchange(is_first_, false);
  const bool is_broken = !is_first && GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_DISCONT);
  const bool is_after_gap = std::exchange(is_after_gap_, false);
  // The gap in the time stamps counts it as lost.
  if (is_broken || is_after_gap || GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_CORRUPTED)) return;
  auto picture = copied(buffer, caps);
  if (!picture) return;
  const double time = time_of(buffer, gst_sample_get_segment(sample));
  const std::int64_t lost = gaps_.lost_before(time);
  feed_.put(
      {.picture = std::move(*picture), .time = time, .exposure = camera_.sensor.exposure, .lost = lost});
}

std::optional<Picture> GStreamerConnection::copied(GstBuffer* buffer, GstCaps* caps) {
  GstVideoInfo info;
  if (gst_video_info_from_caps(&info, caps) == 0) return std::nullopt;
  const SensorConfig& sensor = camera_.sensor;
  const int width = GST_VIDEO_INFO_WIDTH(&info), height = GST_VIDEO_INFO_HEIGHT(&info);
  if (width != sensor.width || height != sensor.height) {
    const std::scoped_lock lock(problem_mutex_);
    problem_ = fmt::format(
        "the stream has {} x {} pixels, the file's sensor has {} x {}: set sensor.width and "
        "sensor.height, or the camera's stream",
        width, height, sensor.width, sensor.height);
    return std::nullopt;
  }
  GstVideoFrame mapped;
  if (gst_video_frame_map(&mapped, &info, buffer, GST_MAP_READ) == 0) return std::nullopt;
  Image<std::uint8_t> image(width, height, sensor.channels());
  const auto* data = static_cast<const std::uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&mapped, 0));
  const int stride = GST_VIDEO_FRAME_PLANE_STRIDE(&mapped, 0);
  for (int v = 0; v < height; ++v) {
    const auto row = image.row(v);
    std::copy_n(data + static_cast<std::ptrdiff_t>(v) * stride, row.size(), row.begin());
  }
  gst_video_frame_unmap(&mapped);
  return Picture(std::move(image));
}

double GStreamerConnection::time_of(GstBuffer* buffer, const GstSegment* segment) {
  const GstClockTime base = gst_element_get_base_time(pipeline_);
  GstClockTime running = gst_segment_to_running_time(segment, GST_FORMAT_TIME, GST_BUFFER_PTS(buffer));
  if (!GST_CLOCK_TIME_IS_VALID(running)) {
    const Held<GstClock> clock(gst_element_get_clock(pipeline_));
    running = clock ? gst_clock_get_time(clock.get()) - base : 0;
  }
  const auto local = static_cast<std::int64_t>(base + running);
  static GstCaps* const ntp = gst_caps_from_string("timestamp/x-ntp");
  const auto* stamp = gst_buffer_get_reference_timestamp_meta(buffer, ntp);
  std::int64_t time = local;
  if (stamp != nullptr) {
    const auto server = static_cast<std::int64_t>(stamp->timestamp);
    // The server's clock continues from the local time of its first stamp, so that times have no step.
    if (!reference_) reference_ = server - local;
    time = server - *reference_;
  }
  return static_cast<double>(time) * 1e-9;
}

}  // namespace

bool has_gstreamer() { return true; }

Outcome<std::unique_ptr<CountedCamera>> open_gstreamer_camera(const GStreamerConfig& config,
                                                              const CameraConfig& camera,
                                                              const ClockPort& clock) {
  const auto refused = [&](const std::string& what) {
    return PortFault{FaultKind::refused, camera_prefix(camera.name) + what};
  };
  if (camera.sensor.bits != 8) return refused("pictures through GStreamer have 8 bits: set sensor.bits = 8");
  if (const std::string problem = started(); !problem.empty())
    return refused(fmt::format("GStreamer does not start: {}", one_line(problem)));
  return std::unique_ptr<CountedCamera>(std::make_unique<CameraFeed>(
      camera.name, camera.sensor.frame_rate, clock,
      [config, camera](CameraFeed& feed) { return GStreamerConnection(feed, config, camera).run(); },
      CameraPatience{.longest_pause = config.longest_pause}));
}

}  // namespace flexura
