#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/camera/camera_config.h"
#include "flexura/equipment/camera_feed.h"

namespace flexura {

/// Transport of an RTSP stream's pictures. tcp: within the RTSP connection; nothing is lost, but a slow
/// network delays. udp: in packets of their own, which may be lost.
enum class StreamTransport { tcp, udp };

/// Source of a camera's pictures: a pipeline of GStreamer.
struct GStreamerConfig {
  /// An address "rtsp://..." or "rtsps://...", or the text of a pipeline of gst-launch-1.0 whose last element
  /// gives raw pictures.
  std::string source;
  StreamTransport transport = StreamTransport::tcp;
  double buffer = 0.05;      ///< Time for which an RTSP stream waits for late packets, s.
  double silence = 5;        ///< Time without a frame after which the connection is made again, s.
  double longest_pause = 5;  ///< Longest pause before a new connection, s.
};

const std::vector<std::string>& names_of(const StreamTransport*);
const Table<GStreamerConfig>& fields_of(const GStreamerConfig*);

/// Returns whether this program was built with GStreamer.
[[nodiscard]] bool has_gstreamer();

/// Returns the whole pipeline for a camera, as gst-launch-1.0 would take it.
[[nodiscard]] std::string gstreamer_pipeline(const GStreamerConfig& config, const SensorConfig& sensor);

/// Starts a camera on a pipeline. The frames have the size and the channels of `camera.sensor`, with 8 bits
/// per value; a stream of another size is a fault. The connection is made, and made again, in the background.
///
/// Frame::time is the stream's time stamp. That of an RTSP stream is on the camera's clock. Over TCP it is as
/// sent. Over UDP it is on this clock from the camera's first report of its time (RTCP sender report) on, and
/// before on this machine's monotonic clock. Use ClockedCamera for times on the rig's clock. Frame::exposure
/// is that of `camera.sensor`.
///
/// `clock` must outlive the camera. Refuses a sensor with more than 8 bits, and every camera if the program
/// was built without GStreamer.
[[nodiscard]] Outcome<std::unique_ptr<CountedCamera>> open_gstreamer_camera(const GStreamerConfig& config,
                                                                            const CameraConfig& camera,
                                                                            const ClockPort& clock);

}  // namespace flexura
