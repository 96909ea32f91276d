#include "flexura/view/seeing_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "flexura/base/table.h"
#include "flexura/camera/camera_config.h"
#include "flexura/rig/seeing_config.h"
#include "flexura/view/session.h"

namespace flexura {
namespace {

// The limits of [[seeing]] in an experiment file.
constexpr std::size_t most_corners = 1000;
constexpr double farthest_corner = 1e5;
const NumberRange any_pixel = between(-farthest_corner, farthest_corner);

template <class S>
Table<S> with_choice(const char* name, const char* meaning) {
  return Table<S>(name, meaning)
      .field("region", static_cast<decltype(SeeingChoice::region) S::*>(&S::region),
             {.meaning = "corners of the region of the arm", .range = any_pixel, .count = {0, most_corners}})
      .field("color", static_cast<decltype(SeeingChoice::color) S::*>(&S::color),
             {.meaning = "red, green and blue of the arm", .range = between(0, 255)})
      .field("base", static_cast<decltype(SeeingChoice::base) S::*>(&S::base),
             {.meaning = "a pixel near the base of the arm", .range = any_pixel})
      .check([](const S& choice, Reader& reader) {
        if (choice.region.size() == 1)
          reader.problem_at("region",
                            "has one corner: expected two of a rectangle, or at least three of a polygon");
      });
}

}  // namespace

const Table<SeeingChoice>& fields_of(const SeeingChoice*) {
  static const auto table =
      with_choice<SeeingChoice>("seeing", "What separates the arm from its surroundings in a picture.");
  return table;
}

const Table<CameraSeeingChoice>& fields_of(const CameraSeeingChoice*) {
  static const auto table =
      with_choice<CameraSeeingChoice>("seeing", "What separates the arm from its surroundings.")
          .field("camera", &CameraSeeingChoice::camera, {.meaning = "camera", .required = true});
  return table;
}

std::shared_ptr<const ArmScene> chosen_scene(const std::shared_ptr<const ArmScene>& scene,
                                             const SeeingChoice& choice) {
  ArmScene chosen = scene == nullptr ? ArmScene{} : *scene;
  chosen.region.clear();
  for (const auto& [u, v] : choice.region) chosen.region.emplace_back(u, v);
  if (chosen.region.size() == 2) {
    const Eigen::Vector2d a = chosen.region[0], b = chosen.region[1];
    chosen.region = {a, {b.x(), a.y()}, b, {a.x(), b.y()}};
  }
  chosen.color.reset();
  if (choice.color) chosen.color = Eigen::Vector3d(choice.color->data());
  if (chosen.region.empty() && !chosen.has_cues()) return nullptr;
  return std::make_shared<const ArmScene>(std::move(chosen));
}

Experiment with_choices(Experiment experiment, std::span<const CameraSeeingChoice> choices) {
  const std::vector<CameraConfig> cameras = experiment.cameras();
  std::set<std::string> names;
  for (const CameraSeeingChoice& choice : choices) {
    const auto refuse = [&](std::string_view why) {
      throw ViewRefusal(fmt::format("camera = {}: {}", text_node(choice.camera).brief(), why));
    };
    const auto camera = std::ranges::find(cameras, choice.camera, &CameraConfig::name);
    if (camera == cameras.end()) refuse("there is no camera with this name");
    if (!names.insert(choice.camera).second) refuse("is given twice: expected each camera once");
    if (choice.color && camera->sensor.pixels == PixelKind::gray)
      refuse("takes gray pictures: expected no colour of the arm");
    const auto found = std::ranges::find(experiment.seeing, choice.camera, &SeeingConfig::camera);
    SeeingConfig seeing;
    if (found != experiment.seeing.end()) seeing = *found;
    seeing.camera = choice.camera;
    seeing.region = choice.region;
    seeing.color = choice.color;
    if (found != experiment.seeing.end()) experiment.seeing.erase(found);
    if (!seeing.region.empty() || seeing.color || !seeing.background.empty())
      experiment.seeing.push_back(std::move(seeing));
  }
  return experiment;
}

std::array<int, 3> color_at(const Image<std::uint8_t>& picture, int u, int v) {
  if (u < 0 || v < 0 || u >= picture.width() || v >= picture.height())
    throw std::out_of_range(fmt::format("({}, {}) is outside the image: expected less than {} x {}", u, v,
                                        picture.width(), picture.height()));
  if (picture.channels() != 3)
    throw ViewRefusal("the picture is gray and has no colour: expected a region or a base instead");
  constexpr int around = 2;
  std::array<int, 3> color{};
  std::vector<std::uint8_t> values;
  for (int channel = 0; channel < 3; ++channel) {
    values.clear();
    for (int y = std::max(0, v - around); y <= std::min(picture.height() - 1, v + around); ++y)
      for (int x = std::max(0, u - around); x <= std::min(picture.width() - 1, u + around); ++x)
        values.push_back(picture.at(x, y, channel));
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    color[static_cast<std::size_t>(channel)] = *middle;
  }
  return color;
}

Node color_answer(const Image<std::uint8_t>& picture, std::int64_t number, int u, int v) {
  Node::Array color;
  for (const int value : color_at(picture, u, v)) color.push_back({std::int64_t{value}, {}});
  return {Node::Table{{"color", {}, {std::move(color), {}}}, {"number", {}, {number, {}}}}, {}};
}

}  // namespace flexura
