// Stands in for video_server.cc in a build without the library gst-rtsp-server.
#include <stdexcept>

#include "flexura/equipment/video_server.h"

namespace flexura {

bool has_video_server() { return false; }

std::unique_ptr<VideoServer> open_video_server(std::vector<VideoStream> /*streams*/,
                                               const VideoServerConfig& /*config*/) {
  throw std::runtime_error(
      "this program was built without a video server: install libgstrtspserver-1.0-dev, then build again");
}

}  // namespace flexura
