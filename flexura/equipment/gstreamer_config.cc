#include <fmt/format.h>

#include "flexura/base/table.h"
#include "flexura/equipment/gstreamer_camera.h"

namespace flexura {
namespace {

// Returns text as a quoted value of a pipeline.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

std::string source_text(const GStreamerConfig& config) {
  if (!config.source.starts_with("rtsp://") && !config.source.starts_with("rtsps://")) return config.source;
  // Over TCP nothing overtakes, so the stream's own time stamps are best (buffer-mode none): a slow receiver
  // does not distort them. Over UDP the buffer must follow the clocks' drift, and the server's reports undo
  // that.
  const bool is_tcp = config.transport == StreamTransport::tcp;
  // The filter keeps a sound track out. decodebin picks the decoder.
  return fmt::format(
      "rtspsrc location={} protocols={} latency={:.0f} {} ! application/x-rtp,media=video ! decodebin",
      quoted(config.source), name_of(config.transport), config.buffer * 1e3,
      is_tcp ? "buffer-mode=none" : "add-reference-timestamp-meta=true");
}

}  // namespace

const std::vector<std::string>& names_of(const StreamTransport*) {
  static const std::vector<std::string> names = {"tcp", "udp"};
  return names;
}

const Table<GStreamerConfig>& fields_of(const GStreamerConfig*) {
  static const auto table =
      Table<GStreamerConfig>("gstreamer", "Pictures from a network camera, or from a pipeline of GStreamer.")
          .field("source", &GStreamerConfig::source,
                 {.meaning = "Address `rtsp://...` of a network camera, or a pipeline as for "
                             "`gst-launch-1.0` whose last element outputs uncompressed pictures.",
                  .required = true})
          .field("transport", &GStreamerConfig::transport,
                 {.meaning = "Transport of an RTSP stream. `tcp`: no packets are lost, but a slow network "
                             "causes delays. `udp`: packets may be lost."})
          .field("buffer", &GStreamerConfig::buffer,
                 {.meaning = "Time for which the receiver of an RTSP stream waits for late packets.",
                  .unit = Unit::second,
                  .range = between(0, 10)})
          .field("silence", &GStreamerConfig::silence,
                 {.meaning = "Time without a frame after which the program reconnects.",
                  .unit = Unit::second,
                  .range = between(0.1, 600)})
          .field("longest_pause", &GStreamerConfig::longest_pause,
                 {.meaning = "Longest pause between two attempts to connect.",
                  .unit = Unit::second,
                  .range = between(0.1, 600)});
  return table;
}

std::string gstreamer_pipeline(const GStreamerConfig& config, const SensorConfig& sensor) {
  return fmt::format(
      "{} ! videoconvert ! video/x-raw,format={} ! appsink name=flexura_sink max-buffers=2 drop=true",
      source_text(config), sensor.pixels == PixelKind::color ? "RGB" : "GRAY8");
}

}  // namespace flexura
