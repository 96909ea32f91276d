#include "flexura/tasks/camera_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "flexura/base/reader.h"

namespace flexura {
namespace {

std::vector<std::string> quoted_names(const std::vector<CameraConfig>& cameras) {
  std::vector<std::string> names;
  names.reserve(cameras.size());
  for (const CameraConfig& camera : cameras) names.push_back(Node{camera.name, {}}.brief());
  return names;
}

}  // namespace

std::array<std::size_t, 2> two_cameras(const std::vector<std::string>& names,
                                       const std::vector<CameraConfig>& cameras) {
  std::array<std::size_t, 2> places = {0, 1};
  for (std::size_t i = 0; i < names.size() && i < 2; ++i) {
    const auto found = std::ranges::find(cameras, names[i], &CameraConfig::name);
    places[i] = static_cast<std::size_t>(found - cameras.begin());
  }
  return places;
}

void check_two_cameras(const std::vector<std::string>& names, const std::vector<CameraConfig>& cameras,
                       const std::string& path, Reader& reader) {
  if (names.empty() && cameras.size() < 2)
    reader.problem_at(path, "needs two cameras: expected a second [[camera]]");
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::ranges::find(cameras, names[i], &CameraConfig::name) == cameras.end())
      reader.problem_at(fmt::format("{}.cameras[{}]", path, i),
                        fmt::format("there is no camera {}: expected one of {}", Node{names[i], {}}.brief(),
                                    fmt::join(quoted_names(cameras), ", ")));
  }
  if (names.size() == 2 && names[0] == names[1])
    reader.problem_at(path + ".cameras", "names one camera twice: expected two different cameras");
}

}  // namespace flexura
