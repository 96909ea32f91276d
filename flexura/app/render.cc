#include "flexura/app/render.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <variant>
#include <vector>

#include "flexura/app/commands.h"
#include "flexura/app/words.h"
#include "flexura/camera/camera_config.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/schedule.h"
#include "flexura/picture/image_file.h"
#include "flexura/rig/filming.h"
#include "flexura/rig/truth_files.h"
#include "flexura/sim/simulated_camera.h"
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
    throw input_error("--time", fmt::format("{} s is outside the experiment's time: expected 0 to {:.6g} s",
                                            arguments.time, schedule.duration()));
  if (std::filesystem::path(arguments.out).extension() != ".png")
    throw input_error("--out", fmt::format("\"{}\": expected a file name that ends in .png", arguments.out));
}

}  // namespace

int render_command(const RenderArguments& arguments, std::ostream& out) {
  Experiment experiment = load_experiment(arguments.experiment, {arguments.sets, {}});
  if (arguments.model) experiment.truth.reset();
  const Schedule schedule(experiment);
  check_arguments(arguments, schedule);
  const std::vector<CameraConfig> cameras = experiment.true_rig().cameras;
  const std::size_t place = place_of(cameras, arguments.camera);
  const SensorConfig& sensor = cameras[place].sensor;
  const FrameTimes frame = times_of_frame_at(sensor, arguments.time);
  const FrameTimes next = times_of_frame_at(sensor, arguments.time + 1 / sensor.frame_rate);

  Filming filming(experiment);
  const double played = play_unfilmed(next.end, schedule, filming);
  if (arguments.time > played) {
    throw input_error("--time", fmt::format("{} s is after the run's end: the run ends at {:.6g} s, because "
                                            "the arm's shape is impossible there",
                                            arguments.time, played));
  }
  const bool has_next = next.start <= played;
  const Shot shot = filming.shot(place, arguments.time);
  const Picture picture = filming.take(shot);
  replace_file(arguments.out, std::visit([](const auto& image) { return png(image); }, picture));
  print_line(out, "image", arguments.out);
  if (!arguments.truth) return exit_done;
  const auto files =
      write_truth(filming.shown(shot, frame.middle),
                  has_next ? std::optional(filming.shown(shot, next.middle)) : std::nullopt, arguments.out);
  for (const auto& file : files) print_line(out, "truth", file.string());
  return exit_done;
}

}  // namespace flexura
