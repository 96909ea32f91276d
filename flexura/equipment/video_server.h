#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/camera/sensor.h"

namespace flexura {

/// Encoding of a served video.
enum class VideoEncoding {
  raw,   ///< Uncompressed: all values arrive unchanged.
  jpeg,  ///< Each picture is compressed separately. Colours have half the resolution.
  h264,  ///< Differences between pictures are compressed. Colours have half the resolution.
};

/// One video of a server.
struct VideoStream {
  std::string name;  ///< Path of the video in the address. The path has only characters that addresses allow.
  int width = 640, height = 480;
  PixelKind pixels = PixelKind::gray;  ///< Pixels. A gray video is sent with three equal colours.
  double frame_rate = 30;              ///< Frame rate, Hz, > 0.
};

/// Settings of a video server.
struct VideoServerConfig {
  VideoEncoding encoding = VideoEncoding::raw;
  int quality = 90;        ///< Quality of JPEG, 1 to 100.
  std::uint16_t port = 0;  ///< Port of the RTSP server on this computer; 0: any free port.
};

const std::vector<std::string>& names_of(const VideoEncoding*);

/// Sends videos to programs on this computer, as network cameras do: over RTSP, with the pictures in RTP
/// packets.
class VideoServer {
 public:
  virtual ~VideoServer() = default;
  VideoServer() = default;
  VideoServer(const VideoServer&) = delete;
  VideoServer& operator=(const VideoServer&) = delete;

  /// Returns the address of a stream, "rtsp://127.0.0.1:PORT/NAME".
  [[nodiscard]] virtual std::string address(std::size_t stream) const = 0;
  /// Returns whether a program receives the stream. If no program receives the stream, put() has no effect.
  [[nodiscard]] virtual bool is_watched(std::size_t stream) = 0;
  /// Sends a picture, which must have the size and the channels (1 or 3) of the stream. `time`: time stamp of
  /// the picture on the clock steady_seconds(), not in the future. Time stamps of a stream must increase. May
  /// be called from any thread.
  virtual void put(std::size_t stream, const Image<std::uint8_t>& picture, double time) = 0;
};

/// Returns whether this program was built with a video server.
[[nodiscard]] bool has_video_server();

/// Starts a server. Throws std::runtime_error with one clear line if the server cannot run. Possible reasons:
/// the program was built without it, the port is in use, a plug-in of GStreamer is missing, or JPEG does not
/// support the image size.
[[nodiscard]] std::unique_ptr<VideoServer> open_video_server(std::vector<VideoStream> streams,
                                                             const VideoServerConfig& config);

}  // namespace flexura
