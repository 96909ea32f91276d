#include "flexura/rig/seeing_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <set>

#include "flexura/base/bytes.h"
#include "flexura/base/table.h"
#include "flexura/rig/setup.h"
#include "flexura/store/text_file.h"
#include "flexura/vision/arm_scene.h"
#include "flexura/vision/picture_file.h"

namespace flexura {
namespace {

constexpr std::size_t most_corners = 1000;
constexpr double farthest_corner = 1e5;  // px, beyond every picture.

Photograph picture_of(const Setup& setup, const std::string& name, const CameraConfig& camera) {
  const std::filesystem::path path = file_inside(setup.folder, name);
  Photograph photograph = decode_picture(bytes_of(read_text_file(path, most_picture_bytes)), path.string());
  const SensorConfig& sensor = camera.sensor;
  const Image<std::uint8_t>& bytes = photograph.bytes;
  if (bytes.width() != sensor.width || bytes.height() != sensor.height)
    throw input_error(path.string(),
                      fmt::format("{} x {} px: expected {} x {} px, the picture size of camera {}",
                                  bytes.width(), bytes.height(), sensor.width, sensor.height, camera.name));
  return photograph;
}

ArmScene scene_of(const Setup& setup, const SeeingConfig& seeing, const CameraConfig& camera) {
  ArmScene scene;
  for (const auto& [u, v] : seeing.region) scene.region.emplace_back(u, v);
  if (scene.region.size() == 2) {
    const Eigen::Vector2d a = scene.region[0], b = scene.region[1];
    scene.region = {a, {b.x(), a.y()}, b, {a.x(), b.y()}};
  }
  if (!seeing.background.empty()) scene.background = picture_of(setup, seeing.background, camera).bytes;
  if (seeing.color) scene.color = Eigen::Vector3d(seeing.color->data());
  return scene;
}

const CameraConfig* camera_of(const std::vector<CameraConfig>& cameras, const std::string& name) {
  const auto found = std::ranges::find(cameras, name, &CameraConfig::name);
  return found == cameras.end() ? nullptr : &*found;
}

// Reports unknown and repeated cameras of a list.
template <class Config>
void check_names(const std::vector<Config>& list, const std::string& key,
                 const std::vector<CameraConfig>& cameras, Reader& reader) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string path = fmt::format("{}[{}].camera", key, i);
    if (camera_of(cameras, list[i].camera) == nullptr)
      reader.problem_at(path,
                        fmt::format("\"{}\" is no camera: expected the name of a camera", list[i].camera));
    else if (!names.insert(list[i].camera).second)
      reader.problem_at(path,
                        fmt::format("\"{}\" is given twice: expected each camera once", list[i].camera));
  }
}

// Adds the problem of reading the file `key` of the entry `i` of the list `list`.
template <class Read>
void try_file(const Node& document, const std::string& list, std::size_t i, const std::string& key,
              std::vector<Problem>& problems, const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    const Node* entries = document.find(list);
    const auto* array = entries == nullptr ? nullptr : entries->as<Node::Array>();
    const Node* entry = array == nullptr || i >= array->size() ? nullptr : (*array)[i].find(key);
    for (const Problem& problem : error.problems())
      problems.push_back(
          {entry == nullptr ? document.where : entry->where,
           fmt::format("{}[{}].{}: {}{}", list, i, key,
                       problem.where.source ? *problem.where.source + ": " : "", problem.what)});
  }
}

}  // namespace

const Table<SeeingConfig>& fields_of(const SeeingConfig*) {
  using S = SeeingConfig;
  static const auto table =
      Table<S>("seeing",
               "Properties that distinguish the arm from its surroundings in the pictures of one camera. "
               "Servos and calibrations with the arm use them. A pixel belongs to the arm only if all "
               "given properties agree.")
          .field("camera", &S::camera, {.meaning = "Name of the camera.", .required = true})
          .field("region", &S::region,
                 {.meaning = "Corners [u, v] of the region in which the arm is, px: two opposite corners of "
                             "a rectangle, or at least three of a polygon.",
                  .range = between(-farthest_corner, farthest_corner),
                  .count = {0, most_corners},
                  .default_text = "the whole picture"})
          .field("background", &S::background,
                 {.meaning = "Picture file of the same view without the arm, in this file's folder or below. "
                             "The camera must not move.",
                  .default_text = "none"})
          .field("color", &S::color,
                 {.meaning = "Red, green and blue of the arm in the pictures.",
                  .range = between(0, 255),
                  .default_text = "not set"});
  return table;
}

const Table<BackdropConfig>& fields_of(const BackdropConfig*) {
  using B = BackdropConfig;
  static const auto table =
      Table<B>("backdrop",
               "Picture that a simulated camera sees behind everything else. It stays in place when the "
               "camera moves. Screens are in front of it: use `stand.screen = []`.")
          .field("camera", &B::camera, {.meaning = "Name of the camera.", .required = true})
          .field("picture", &B::picture,
                 {.meaning = "Picture file in this file's folder or below, with the size of the camera's "
                             "pictures.",
                  .required = true});
  return table;
}

void check_seeing(const Setup& setup, Reader& reader) {
  const std::vector<CameraConfig> cameras = setup.cameras();
  check_names(setup.seeing, "seeing", cameras, reader);
  check_names(setup.backdrop, "backdrop", cameras, reader);
  for (std::size_t i = 0; i < setup.seeing.size(); ++i) {
    const SeeingConfig& one = setup.seeing[i];
    if (one.region.size() == 1)
      reader.problem_at(fmt::format("seeing[{}].region", i),
                        "has one corner: expected two of a rectangle, or at least three of a polygon");
    const CameraConfig* camera = camera_of(cameras, one.camera);
    if (one.color && camera != nullptr && camera->sensor.pixels == PixelKind::gray)
      reader.problem_at(
          fmt::format("seeing[{}].color", i),
          fmt::format("camera {} takes gray pictures: expected a camera with pixels = \"color\"",
                      one.camera));
  }
}

std::vector<Problem> seeing_file_problems(const Setup& setup, const Node& document) {
  std::vector<Problem> problems;
  const std::vector<CameraConfig> cameras = setup.cameras();
  for (std::size_t i = 0; i < setup.seeing.size(); ++i) {
    const SeeingConfig& one = setup.seeing[i];
    const CameraConfig* camera = camera_of(cameras, one.camera);
    if (camera == nullptr || one.background.empty()) continue;
    try_file(document, "seeing", i, "background", problems,
             [&] { (void)picture_of(setup, one.background, *camera); });
  }
  for (std::size_t i = 0; i < setup.backdrop.size(); ++i) {
    const BackdropConfig& one = setup.backdrop[i];
    const CameraConfig* camera = camera_of(cameras, one.camera);
    if (camera == nullptr) continue;
    try_file(document, "backdrop", i, "picture", problems,
             [&] { (void)picture_of(setup, one.picture, *camera); });
  }
  return problems;
}

void copy_seeing_files(const Setup& setup, const std::filesystem::path& results) {
  if (setup.folder.empty()) return;
  std::set<std::filesystem::path> names;
  for (const SeeingConfig& one : setup.seeing)
    if (!one.background.empty()) names.insert(one.background);
  for (const BackdropConfig& one : setup.backdrop) names.insert(one.picture);
  for (const std::filesystem::path& name : names) {
    // A file with an absolute path is where it was.
    if (name.is_absolute()) continue;
    const std::string file = read_text_file(file_inside(setup.folder, name.string()), most_picture_bytes);
    const std::filesystem::path copy = results / name.lexically_normal();
    std::filesystem::create_directories(copy.parent_path());
    write_new_file(copy, file);
  }
}

std::vector<std::shared_ptr<const ArmScene>> arm_scenes(const Setup& setup) {
  const std::vector<CameraConfig> cameras = setup.cameras();
  std::vector<std::shared_ptr<const ArmScene>> scenes(cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const auto found = std::ranges::find(setup.seeing, cameras[i].name, &SeeingConfig::camera);
    if (found != setup.seeing.end())
      scenes[i] = std::make_shared<const ArmScene>(scene_of(setup, *found, cameras[i]));
  }
  return scenes;
}

Image<float> backdrop_light(const Setup& setup, std::size_t camera) {
  const std::vector<CameraConfig> cameras = setup.true_rig().cameras;
  const CameraConfig& config = cameras.at(camera);
  const auto found = std::ranges::find(setup.backdrop, config.name, &BackdropConfig::camera);
  // Only the text of an experiment has no folder, and then no files.
  if (found == setup.backdrop.end() || setup.folder.empty()) return {};
  const Image<std::uint8_t> picture = picture_of(setup, found->picture, config).bytes;
  const int channels = config.sensor.channels();
  Image<float> light(picture.width(), picture.height(), channels);
  const auto linear = [&](double value) {
    constexpr double full = 255;
    return std::pow(value / full, config.sensor.gamma) / config.sensor.gain;
  };
  const Image<std::uint8_t> shown = channels == 1 ? gray_picture(picture) : picture;
  for (int v = 0; v < light.height(); ++v)
    for (int u = 0; u < light.width(); ++u)
      for (int c = 0; c < channels; ++c)
        light.at(u, v, c) = static_cast<float>(linear(shown.at(u, v, shown.channels() == channels ? c : 0)));
  return light;
}

}  // namespace flexura
