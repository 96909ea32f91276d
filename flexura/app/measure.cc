#include "flexura/app/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "flexura/app/commands.h"
#include "flexura/app/words.h"
#include "flexura/base/bytes.h"
#include "flexura/base/problems.h"
#include "flexura/base/source.h"
#include "flexura/base/table.h"
#include "flexura/camera/measured_camera.h"
#include "flexura/picture/image_file.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "flexura/store/toml.h"
#include "flexura/vision/picture_file.h"

namespace flexura {
namespace {

MeasureConfig config_of(const MeasureArguments& arguments) {
  MeasureConfig config;
  config.what = named<MeasureTarget>("--what", arguments.what);
  config.finder.threshold = threshold_config(arguments.threshold);
  if (arguments.base.size() == 2) {
    constexpr double most = 1e5;  // px, beyond every picture.
    const auto is_place = [](double x) { return std::abs(x) <= most; };
    if (!is_place(arguments.base[0]) || !is_place(arguments.base[1]))
      throw input_error("--base", fmt::format("expected two numbers u,v within {:g} px", most));
    config.finder.base = Eigen::Vector2d(arguments.base[0], arguments.base[1]);
    config.finder.cuts_at_base = true;
  }
  constexpr double thinnest = 1e-6, thickest = 1e3;
  const auto is_size = [](double x) { return x >= thinnest && x <= thickest; };
  if (arguments.radius && !is_size(*arguments.radius))
    throw input_error("--radius", fmt::format("{} m: expected a number from {:g} to {:g}", *arguments.radius,
                                              thinnest, thickest));
  config.radius = arguments.radius;
  constexpr double least_gamma = 0.1, most_gamma = 10;
  const auto is_gamma = [](double x) { return x >= least_gamma && x <= most_gamma; };
  if (arguments.gamma && !is_gamma(*arguments.gamma))
    throw input_error("--gamma", fmt::format("{}: expected a number from {:g} to {:g}", *arguments.gamma,
                                             least_gamma, most_gamma));
  config.gamma = arguments.gamma.value_or(1);
  if (config.what == MeasureTarget::circle || config.what == MeasureTarget::etalon) {
    for (const auto& [option, is_given] : {std::pair{"--base", !arguments.base.empty()},
                                           {"--camera", !arguments.camera.empty()},
                                           {"--radius", arguments.radius.has_value()},
                                           {"--region", !arguments.scene.regions.empty()},
                                           {"--background", !arguments.scene.backgrounds.empty()},
                                           {"--color", !arguments.scene.color.empty()},
                                           {"--mask", !arguments.scene.masks.empty()}})
      if (is_given)
        throw input_error(
            option, fmt::format("has no effect with --what {}: expected only for arms", arguments.what));
  }
  return config;
}

void add_scenes(const MeasureArguments& arguments, std::vector<MeasureConfig>& configs) {
  std::vector<double> gammas;
  gammas.reserve(configs.size());
  for (const MeasureConfig& config : configs) gammas.push_back(config.gamma);
  const auto scenes = arm_scenes(arguments.scene, gammas);
  for (std::size_t i = 0; i < scenes.size(); ++i) configs[i].finder.scene = scenes[i];
}

// Returns the settings for each picture, with the camera that took it if there is a file of cameras.
std::vector<MeasureConfig> configs_of(const MeasureArguments& arguments) {
  std::vector<MeasureConfig> configs(arguments.images.size(), config_of(arguments));
  if (arguments.camera.empty()) {
    if (arguments.radius) throw input_error("--radius", "needs --camera, a file of measured cameras");
    add_scenes(arguments, configs);
    return configs;
  }
  const Node file = read_toml_file(arguments.camera);
  const auto cameras = read_as<MeasuredCameras>(file).camera;
  if (cameras.size() != 1 && cameras.size() != configs.size())
    throw InputError({{file.find("camera")->where,
                       fmt::format("camera: {} for {} picture{}: expected one, or one for each picture",
                                   cameras.size(), configs.size(), configs.size() == 1 ? "" : "s")}});
  for (std::size_t i = 0; i < configs.size(); ++i) {
    const MeasuredCamera& camera = cameras[cameras.size() == 1 ? 0 : i];
    configs[i].camera = camera;
    if (!arguments.gamma) configs[i].gamma = camera.gamma;
  }
  add_scenes(arguments, configs);
  return configs;
}

int measure_one(const MeasureArguments& arguments, const MeasureConfig& config, std::ostream& out) {
  const std::string& name = arguments.images.front();
  const Measurement found = measure_picture(bytes_of(read_text_file(name, most_picture_bytes)), name, config,
                                            !arguments.overlay.empty());
  if (!arguments.overlay.empty()) replace_file(arguments.overlay, png(found.overlay));
  out << write_json(found.answer, 2) << '\n';
  return found.is_found ? exit_done : exit_missed;
}

int measure_many(const MeasureArguments& arguments, std::span<const MeasureConfig> configs,
                 std::ostream& out) {
  int status = exit_done;
  for (std::size_t i = 0; i < arguments.images.size(); ++i) {
    const std::string& name = arguments.images[i];
    try {
      const Measurement found =
          measure_picture(bytes_of(read_text_file(name, most_picture_bytes)), name, configs[i]);
      out << write_json(found.answer) << '\n';
      if (!found.is_found && status == exit_done) status = exit_missed;
    } catch (const InputError& error) {
      const Node line{Node::Table{{"image", {}, {name, {}}}, {"error", {}, {joined(error.problems()), {}}}},
                      {}};
      out << write_json(line) << '\n';
      status = exit_bad_input;
    }
  }
  return status;
}

}  // namespace

int measure_command(const MeasureArguments& arguments, std::ostream& out) {
  if (!arguments.overlay.empty()) {
    if (arguments.images.size() != 1)
      throw input_error("--overlay", "expected one picture, over which the findings are drawn");
    if (std::filesystem::path(arguments.overlay).extension() != ".png")
      throw input_error("--overlay",
                        fmt::format("\"{}\": expected a file name that ends in .png", arguments.overlay));
    std::error_code none;
    if (std::filesystem::equivalent(arguments.overlay, arguments.images.front(), none))
      throw input_error("--overlay", fmt::format("\"{}\" is the measured picture: expected another file",
                                                 arguments.overlay));
  }
  const auto configs = configs_of(arguments);
  return configs.size() == 1 ? measure_one(arguments, configs.front(), out)
                             : measure_many(arguments, configs, out);
}

}  // namespace flexura
