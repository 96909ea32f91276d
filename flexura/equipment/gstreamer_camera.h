#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/camera/camera_config.h"
#include "flexura/equipment/camera_feed.h"

namespace flexura {

/// Transport of the pictures of an RTSP stream. `tcp`: within the RTSP connection; no packets are lost, but a
/// slow network causes delays. `udp`: in separate packets, which may be lost.
enum class StreamTransport { tcp, udp };

/// Source of a camera's pictures: a GStreamer pipeline.
struct GStreamerConfig {
  /// An address "rtsp://..." or "rtsps://...", or the text of a pipeline as for gst-launch-1.0, whose last
  /// element outputs uncompressed pictures.
  std::string source;
  StreamTransport transport = StreamTransport::tcp;
  double buffer = 0.05;      ///< Time for which the receiver of an RTSP stream waits for late packets, s.
  double silence = 5;        ///< Time without a frame after which the program reconnects, s.
  double longest_pause = 5;  ///< Longest pause between two attempts to connect, s.
};

const std::vector<std::string>& names_of(const StreamTransport*);
const Table<GStreamerConfig>& fields_of(const GStreamerConfig*);

/// Returns whether this program was built with GStreamer.
[[nodiscard]] bool has_gstreamer();

/// Returns the complete pipeline for a camera, as text for gst-launch-1.0.
[[nodiscard]] std::string gstreamer_pipeline(const GStreamerConfig& config, const SensorConfig& sensor);

/// Starts a camera on a pipeline. The frames have the size and the channels of `camera.sensor`, with 8 bits
/// per value; a stream of another image size is a fault. A thread connects, and reconnects after a loss.
///
/// Frame::time is the stream's time stamp. For an RTSP stream over TCP, the time is on the camera's clock.
/// For an RTSP stream over UDP, the time is on the camera's clock after the camera's first RTCP sender
/// report. Before this report, the time is on this computer's monotonic clock. Use ClockedCamera for times on
/// the rig's clock. Frame::exposure has the value in `camera.sensor`.
///
/// `clock` must outlive the camera. Returns a fault for a sensor with more than 8 bits, and for every camera
/// if the program was built without GStreamer.
[[nodiscard]] Outcome<std::unique_ptr<CountedCamera>> open_gstreamer_camera(const GStreamerConfig& config,
                                                                            const CameraConfig& camera,
                                                                            const ClockPort& clock);

}  // namespace flexura
