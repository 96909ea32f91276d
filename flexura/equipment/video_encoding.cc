#include "flexura/equipment/video_server.h"

namespace flexura {

const std::vector<std::string>& names_of(const VideoEncoding*) {
  static const std::vector<std::string> names = {"raw", "jpeg", "h264"};
  return names;
}

}  // namespace flexura
