#include "flexura/app/scene_arguments.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "flexura/base/bytes.h"
#include "flexura/base/source.h"
#include "flexura/store/text_file.h"
#include "flexura/vision/linear_light.h"
#include "flexura/vision/picture_file.h"

namespace flexura {
namespace {

// Returns the numbers of a list "1,2.5,3"; nothing if it is none.
std::vector<double> numbers_in(std::string_view list) {
  std::vector<double> numbers;
  while (true) {
    const std::size_t comma = std::min(list.find(','), list.size());
    const std::string_view word = list.substr(0, comma);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return {};
    numbers.push_back(value);
    if (comma == list.size()) return numbers;
    list.remove_prefix(comma + 1);
  }
}

std::vector<Eigen::Vector2d> corners_of(const std::string& list) {
  constexpr double most = 1e5;  // px, beyond every picture.
  const std::vector<double> numbers = numbers_in(list);
  const bool are_near = std::ranges::all_of(numbers, [](double x) { return std::abs(x) <= most; });
  if (numbers.size() < 4 || numbers.size() % 2 != 0 || !are_near)
    throw input_error("--region",
                      fmt::format("\"{}\": expected two corners U,V,U,V of a rectangle, or three or "
                                  "more of a polygon, within {:g} px",
                                  list, most));
  std::vector<Eigen::Vector2d> corners;
  for (std::size_t i = 0; i < numbers.size(); i += 2) corners.emplace_back(numbers[i], numbers[i + 1]);
  if (corners.size() > 2) return corners;
  const Eigen::Vector2d a = corners[0], b = corners[1];
  return {a, {b.x(), a.y()}, b, {a.x(), b.y()}};
}

Eigen::Vector3d color_of(const std::string& list, double gamma) {
  constexpr double full = 255;
  const std::vector<double> numbers = numbers_in(list);
  const bool are_values = std::ranges::all_of(numbers, [](double x) { return x >= 0 && x <= full; });
  if (numbers.size() != 3 || !are_values)
    throw input_error("--color",
                      fmt::format("\"{}\": expected red, green and blue from 0 to 255: R,G,B", list));
  Eigen::Vector3d color(numbers.data());
  for (double& value : color) value = full * std::pow(value / full, gamma);
  return color;
}

Photograph picture_in(const std::string& file) {
  return decode_picture(bytes_of(read_text_file(file, most_picture_bytes)), file);
}

// Returns the element for picture i.
const std::string* element(const std::vector<std::string>& list, std::size_t i) {
  return list.empty() ? nullptr : &list[list.size() == 1 ? 0 : i];
}

ArmScene scene_at(const SceneArguments& arguments, std::size_t i, double gamma) {
  ArmScene scene;
  if (const auto* region = element(arguments.regions, i)) scene.region = corners_of(*region);
  if (const auto* file = element(arguments.backgrounds, i))
    scene.background = linear_light(picture_in(*file), gamma).bytes;
  if (!arguments.color.empty()) scene.color = color_of(arguments.color, gamma);
  if (const auto* file = element(arguments.masks, i)) scene.mask = gray_picture(picture_in(*file).bytes);
  return scene;
}

}  // namespace

std::vector<std::shared_ptr<const ArmScene>> arm_scenes(const SceneArguments& arguments,
                                                        std::span<const double> gammas) {
  std::vector<std::shared_ptr<const ArmScene>> scenes(gammas.size());
  bool is_common = true;
  for (const auto& [option, list] : {std::pair{"--region", &arguments.regions},
                                     {"--background", &arguments.backgrounds},
                                     {"--mask", &arguments.masks}}) {
    if (list->size() > 1 && list->size() != gammas.size())
      throw input_error(option,
                        fmt::format("given {} times for {} picture{}: expected once, or once per picture",
                                    list->size(), gammas.size(), gammas.size() == 1 ? "" : "s"));
    is_common = is_common && list->size() <= 1;
  }
  if (arguments.regions.empty() && arguments.backgrounds.empty() && arguments.color.empty() &&
      arguments.masks.empty())
    return scenes;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    if (i > 0 && is_common && gammas[i] == gammas[i - 1])
      scenes[i] = scenes[i - 1];
    else
      scenes[i] = std::make_shared<const ArmScene>(scene_at(arguments, i, gammas[i]));
  }
  return scenes;
}

}  // namespace flexura
