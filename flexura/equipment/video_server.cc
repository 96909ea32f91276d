#include "flexura/equipment/video_server.h"

#include <fmt/format.h>
#include <gst/app/gstappsrc.h>
#include <gst/gst.h>
#include <gst/rtsp-server/rtsp-server.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "flexura/base/one_line.h"
#include "flexura/equipment/wall_clock.h"

namespace flexura {
namespace {

template <class Object>
struct ServedUnref {
  void operator()(Object* object) const { g_object_unref(object); }
};
template <class Object>
using Owned = std::unique_ptr<Object, ServedUnref<Object>>;

void start_gstreamer() {
  GError* error = nullptr;
  if (gst_init_check(nullptr, nullptr, &error) != 0) return;
  const std::string why = error != nullptr ? one_line(error->message) : "unknown error";
  g_clear_error(&error);
  throw std::runtime_error("GStreamer does not start: " + why);
}

// The elements that an encoding needs, with the Debian packages that have them.
const std::map<std::string, std::string>& encoders(VideoEncoding encoding) {
  static const std::map<std::string, std::string> raw = {{"rtpvrawpay", "gstreamer1.0-plugins-good"}};
  static const std::map<std::string, std::string> jpeg = {{"jpegenc", "gstreamer1.0-plugins-good"},
                                                          {"rtpjpegpay", "gstreamer1.0-plugins-good"}};
  static const std::map<std::string, std::string> h264 = {{"openh264enc", "gstreamer1.0-plugins-bad"},
                                                          {"rtph264pay", "gstreamer1.0-plugins-good"}};
  if (encoding == VideoEncoding::raw) return raw;
  return encoding == VideoEncoding::jpeg ? jpeg : h264;
}

void check_video(const VideoStream& stream, const VideoServerConfig& config) {
  for (const auto& [element, package] : encoders(config.encoding)) {
    const Owned<GstElementFactory> found(gst_element_factory_find(element.c_str()));
    if (!found)
      throw std::runtime_error(fmt::format("GStreamer has no element {}: install {}", element, package));
  }
  constexpr int block = 8, most = 2040;  // RFC 2435.
  const auto fits = [](int size) { return size % block == 0 && size <= most; };
  if (config.encoding == VideoEncoding::jpeg && !(fits(stream.width) && fits(stream.height)))
    throw std::runtime_error(
        fmt::format("{}: JPEG over RTP has no pictures of {} x {} pixels: expected multiples of {} up to {}",
                    stream.name, stream.width, stream.height, block, most));
}

// Returns the pipeline from pictures to packets, as gst-rtsp-server takes it.
std::string pipeline_text(const VideoStream& stream, const VideoServerConfig& config) {
  constexpr double most_bits = 1e8, bits_a_pixel = 1;
  std::string encoder = "rtpvrawpay";
  if (config.encoding == VideoEncoding::jpeg)
    encoder = fmt::format("videoconvert ! video/x-raw,format=I420 ! jpegenc quality={} ! rtpjpegpay",
                          config.quality);
  if (config.encoding == VideoEncoding::h264)
    encoder =
        fmt::format("videoconvert ! openh264enc gop-size=10 bitrate={:.0f} ! rtph264pay config-interval=1",
                    std::min(most_bits, bits_a_pixel * stream.width * stream.height * stream.frame_rate));
  // If nobody takes the pictures, old ones are dropped.
  return fmt::format(
      "( appsrc name=pictures is-live=true format=time max-buffers=2 leaky-type=downstream "
      "caps=video/x-raw,format=RGB,width={},height={},framerate={}/1000 ! {} name=pay0 pt=96 )",
      stream.width, stream.height, std::llround(1000 * stream.frame_rate), encoder);
}

// A stream, and where its pictures go while somebody watches.
struct Served {
  VideoStream stream;
  std::mutex mutex;
  Owned<GstElement> app;
};

void on_unprepared(GstRTSPMedia* /*media*/, gpointer served) {
  auto& one = *static_cast<Served*>(served);
  const std::scoped_lock lock(one.mutex);
  one.app.reset();
}

void on_configure(GstRTSPMediaFactory* /*factory*/, GstRTSPMedia* media, gpointer served) {
  auto& one = *static_cast<Served*>(served);
  const Owned<GstElement> element(gst_rtsp_media_get_element(media));
  const std::scoped_lock lock(one.mutex);
  one.app.reset(gst_bin_get_by_name_recurse_up(GST_BIN(element.get()), "pictures"));
  g_signal_connect(media, "unprepared", G_CALLBACK(on_unprepared), served);
}

// Copies a picture, each row padded to a multiple of 4 bytes, as GStreamer expects.
GstBuffer* buffer_of(const Image<std::uint8_t>& picture) {
  const auto row_size = static_cast<std::size_t>(picture.width()) * 3;
  const std::size_t stride = (row_size + 3) / 4 * 4;
  GstBuffer* buffer =
      gst_buffer_new_allocate(nullptr, stride * static_cast<std::size_t>(picture.height()), nullptr);
  GstMapInfo map;
  if (buffer == nullptr || gst_buffer_map(buffer, &map, GST_MAP_WRITE) == 0)
    throw std::runtime_error("no memory for a picture");
  for (int v = 0; v < picture.height(); ++v) {
    const auto row = picture.row(v);
    std::uint8_t* to = map.data + stride * static_cast<std::size_t>(v);
    if (picture.channels() == 3) {
      std::ranges::copy(row, to);
    } else {
      for (const std::uint8_t value : row) to = std::fill_n(to, 3, value);
    }
  }
  gst_buffer_unmap(buffer, &map);
  return buffer;
}

class RtspServer : public VideoServer {
 public:
  RtspServer(std::vector<VideoStream> streams, const VideoServerConfig& config);
  ~RtspServer() override;

  [[nodiscard]] std::string address(std::size_t stream) const override {
    return fmt::format("rtsp://127.0.0.1:{}/{}", port_, served_.at(stream)->stream.name);
  }
  [[nodiscard]] bool is_watched(std::size_t stream) override {
    const std::scoped_lock lock(served_.at(stream)->mutex);
    return served_[stream]->app != nullptr;
  }
  void put(std::size_t stream, const Image<std::uint8_t>& picture, double time) override;

 private:
  std::vector<std::unique_ptr<Served>> served_;
  GMainContext* context_ = nullptr;
  GMainLoop* loop_ = nullptr;
  Owned<GstRTSPServer> server_;
  int port_ = 0;
  std::thread thread_;
};

RtspServer::RtspServer(std::vector<VideoStream> streams, const VideoServerConfig& config) {
  start_gstreamer();
  server_.reset(gst_rtsp_server_new());
  gst_rtsp_server_set_address(server_.get(), "127.0.0.1");
  gst_rtsp_server_set_service(server_.get(), std::to_string(config.port).c_str());
  const Owned<GstRTSPMountPoints> mounts(gst_rtsp_server_get_mount_points(server_.get()));
  for (VideoStream& stream : streams) {
    check_video(stream, config);
    auto one = std::make_unique<Served>();
    one->stream = std::move(stream);
    GstRTSPMediaFactory* factory = gst_rtsp_media_factory_new();
    gst_rtsp_media_factory_set_launch(factory, pipeline_text(one->stream, config).c_str());
    gst_rtsp_media_factory_set_shared(factory, TRUE);
    g_signal_connect(factory, "media-configure", G_CALLBACK(on_configure), one.get());
    gst_rtsp_mount_points_add_factory(mounts.get(), ("/" + one->stream.name).c_str(), factory);
    served_.push_back(std::move(one));
  }
  context_ = g_main_context_new();
  if (gst_rtsp_server_attach(server_.get(), context_) == 0) {
    g_main_context_unref(context_);
    throw std::runtime_error(fmt::format("port {} is taken", config.port));
  }
  port_ = gst_rtsp_server_get_bound_port(server_.get());
  loop_ = g_main_loop_new(context_, FALSE);
  thread_ = std::thread([this] {
    g_main_context_push_thread_default(context_);
    g_main_loop_run(loop_);
    g_main_context_pop_thread_default(context_);
  });
}

RtspServer::~RtspServer() {
  // Ends all connections; their media are unprepared in the loop's thread or in the clients' threads.
  const auto end_client = [](GstRTSPServer*, GstRTSPClient*, gpointer) { return GST_RTSP_FILTER_REMOVE; };
  gst_rtsp_server_client_filter(server_.get(), end_client, nullptr);
  constexpr double patience = 2;  // s
  const auto is_any_watched = [this] {
    for (std::size_t i = 0; i < served_.size(); ++i)
      if (is_watched(i)) return true;
    return false;
  };
  for (const double end = steady_seconds() + patience; is_any_watched() && steady_seconds() < end;)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  // A loop that has not begun yet would not notice a call from here.
  GSource* quit = g_idle_source_new();
  g_source_set_callback(
      quit, [](gpointer loop) { return g_main_loop_quit(static_cast<GMainLoop*>(loop)), gboolean{FALSE}; },
      loop_, nullptr);
  g_source_attach(quit, context_);
  g_source_unref(quit);
  thread_.join();
  server_.reset();
  g_main_loop_unref(loop_);
  g_main_context_unref(context_);
}

void RtspServer::put(std::size_t stream, const Image<std::uint8_t>& picture, double time) {
  Served& one = *served_.at(stream);
  const VideoStream& is = one.stream;
  if (picture.width() != is.width || picture.height() != is.height ||
      picture.channels() != (is.pixels == PixelKind::color ? 3 : 1))
    throw std::invalid_argument(
        fmt::format("the picture has {} x {} pixels with {} channels: expected {} x {}", picture.width(),
                    picture.height(), picture.channels(), is.width, is.height));
  const std::scoped_lock lock(one.mutex);
  if (!one.app) return;
  const Owned<GstClock> clock(gst_element_get_clock(one.app.get()));
  GstState state = GST_STATE_NULL;
  gst_element_get_state(one.app.get(), &state, nullptr, 0);
  if (!clock || state != GST_STATE_PLAYING) return;
  // A time of this machine's clock becomes one of the pipeline's.
  const auto running = static_cast<std::int64_t>(gst_clock_get_time(clock.get())) -
                       static_cast<std::int64_t>(gst_element_get_base_time(one.app.get()));
  const std::int64_t stamp = running - std::llround((steady_seconds() - time) * 1e9);
  if (stamp < 0) return;
  GstBuffer* buffer = buffer_of(picture);
  GST_BUFFER_PTS(buffer) = static_cast<GstClockTime>(stamp);
  GST_BUFFER_DURATION(buffer) = static_cast<GstClockTime>(std::llround(1e9 / is.frame_rate));
  gst_app_src_push_buffer(GST_APP_SRC(one.app.get()), buffer);
}

}  // namespace

bool has_video_server() { return true; }

std::unique_ptr<VideoServer> open_video_server(std::vector<VideoStream> streams,
                                               const VideoServerConfig& config) {
  return std::make_unique<RtspServer>(std::move(streams), config);
}

}  // namespace flexura
