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
  jpeg,  ///< Each picture compressed by itself. Colors have half the resolution.
  h264,  ///< Compressed from picture to picture. Colors have half the resolution.
};

/// One video of a server.
struct VideoStream {
  std::string name;  ///< Path in the address, without characters that addresses do not have.
  int width = 640, height = 480;
  PixelKind pixels = PixelKind::gray;  ///< A gray video is sent with three equal colors.
  double frame_rate = 30;              ///< Hz, > 0.
};

/// How videos are served.
struct VideoServerConfig {
  VideoEncoding encoding = VideoEncoding::raw;
  int quality = 90;        ///< Quality of JPEG, 1 to 100.
  std::uint16_t port = 0;  ///< Port of the RTSP server on this machine; 0: any that is free.
};

const std::vector<std::string>& names_of(const VideoEncoding*);

/// Serves videos to programs on this machine, as network cameras do: RTSP, with the pictures in RTP packets.
class VideoServer {
 public:
  virtual ~VideoServer() = default;
  VideoServer() = default;
  VideoServer(const VideoServer&) = delete;
  VideoServer& operator=(const VideoServer&) = delete;

  /// Returns the address of a stream, "rtsp://127.0.0.1:PORT/NAME".
  [[nodiscard]] virtual std::string address(std::size_t stream) const = 0;
  /// Returns whether anybody receives a stream. If not, put() does nothing.
  [[nodiscard]] virtual bool is_watched(std::size_t stream) = 0;
  /// Sends a picture of the stream's size, with 1 or 3 channels as the stream's pixels. `time`: its time
  /// stamp, steady_seconds(), not in the future. Callable in any thread; a stream's times must increase.
  virtual void put(std::size_t stream, const Image<std::uint8_t>& picture, double time) = 0;
};

/// Returns whether this program was built with a video server.
[[nodiscard]] bool has_video_server();

/// Starts a server. Throws std::runtime_error with one clear line if it cannot run. Reasons: The program was
/// built without it, the port is taken, a plug-in of GStreamer is missing, or JPEG does not have this size.
[[nodiscard]] std::unique_ptr<VideoServer> open_video_server(std::vector<VideoStream> streams,
                                                             const VideoServerConfig& config);

}  // namespace flexura
