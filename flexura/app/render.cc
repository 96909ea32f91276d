#include "flexura/app/render.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <variant>

#include "flexura/app/commands.h"
#include "flexura/camera/camera.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/photographer.h"
#include "flexura/experiment/schedule.h"
#include "flexura/experiment/truth_files.h"
#include "flexura/store/image_file.h"
#include "flexura/store/text_file.h"

namespace flexura {
namespace {

std::size_t place_of(const std::vector<CameraConfig>& cameras, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (cameras[i].name == name) return i;
    names.push_back(cameras[i].name);
  }
  throw input_error("--camera", fmt::format("there is no camera \"{}\": expected one of \"{}\"", name,
                                            fmt::join(names, "\", \"")));
}

void check_arguments(const RenderArguments& arguments, const Schedule& schedule) {
  if (!std::isfinite(arguments.time) || arguments.time < 0 || arguments.time > schedule.duration())
    throw input_error("--time", fmt::format("{} s is not in the experiment: expected 0 to {:.6g} s",
                                            arguments.time, schedule.duration()));
  if (std::filesystem::path(arguments.out).extension() != ".png")
    throw input_error("--out", fmt::format("\"{}\": expected a file name that ends in .png", arguments.out));
}

}  // namespace

int render_command(const RenderArguments& arguments, std::ostream& out) {
  const Experiment experiment = load_experiment(arguments.experiment, {arguments.sets, {}});
  const Schedule schedule(experiment);
  check_arguments(arguments, schedule);
  const RigConfig rig = arguments.model ? experiment.model_rig() : experiment.true_rig();
  const std::size_t place = place_of(rig.cameras, arguments.camera);
  const Camera camera(rig.cameras[place]);
  const View view = camera.view(camera.initial_stage(), camera.initial_head());
  const Arm arm = rig.arm.arm();

  Shot shot;
  shot.camera = place;
  shot.sensor = &camera.config().sensor;
  shot.frame = std::llround(arguments.time * shot.sensor->frame_rate);
  shot.seed = static_cast<std::uint64_t>(experiment.seed);
  shot.start = arguments.time;
  shot.view = [still = view](double) { return still; };
  // An exposure may last longer than the experiment.
  shot.backbone = [&](double time) {
    return Backbone(arm, schedule.state_at(std::min(time, schedule.duration())));
  };
  Photographer photographer(arm, experiment);
  const Picture picture = photographer.take(shot);
  replace_file(arguments.out, std::visit([](const auto& image) { return png(image); }, picture));
  out << "image: " << arguments.out << '\n';
  if (!arguments.truth) return exit_done;
  const auto shown = [&](double time) { return ShownScene{photographer.scene(shot.backbone(time)), view}; };
  const double next = arguments.time + 1 / shot.sensor->frame_rate;
  const auto files =
      write_truth(shown(arguments.time),
                  next <= schedule.duration() ? std::optional(shown(next)) : std::nullopt, arguments.out);
  for (const auto& file : files) out << "truth: " << file.string() << '\n';
  return exit_done;
}

}  // namespace flexura
