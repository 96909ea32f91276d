#include "flexura/app/rehearse.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "flexura/app/commands.h"
#include "flexura/app/stop_signal.h"
#include "flexura/app/words.h"
#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"
#include "flexura/rig/rehearsal.h"
#include "flexura/store/text_file.h"

namespace flexura {
namespace {

constexpr std::string_view copy_mark = "# Written by flexura rehearse";

std::filesystem::path copy_of(const RehearseArguments& arguments) {
  if (!arguments.out.empty()) return arguments.out;
  const std::filesystem::path file = arguments.experiment;
  return file.parent_path() / (file.stem().string() + "-rehearsal.toml");
}

// Returns whether a file may be replaced.
bool is_copy(const std::filesystem::path& file) {
  constexpr std::size_t largest = std::size_t{1} << 26;
  return read_text_file(file, largest).starts_with(copy_mark);
}

void print_devices(const Experiment& experiment, const std::string& video, std::ostream& out) {
  const RigEquipment& rig = experiment.equipment.value();
  for (const GrblConfig& grbl : rig.grbl)
    print_line(out, "motors", fmt::format("{} ({} axes of a Grbl controller)", grbl.link, grbl.axes.size()));
  for (const CameraEquipment& camera : rig.camera) {
    print_line(out, "head", fmt::format("{} ({}, VISCA)", camera.visca.value().bus.link, camera.name));
    print_line(out, "camera",
               fmt::format("{} ({}, {})", camera.gstreamer.value().source, camera.name, video));
  }
}

}  // namespace

int rehearse_command(const RehearseArguments& arguments, std::ostream& out, std::ostream& err) {
  Experiment experiment = load_experiment(arguments.experiment, {arguments.sets, {}});
  const std::filesystem::path file = copy_of(arguments);
  if (!is_missing(file) && !is_copy(file))
    throw input_error(
        file.string(),
        "the file was not written by a rehearsal, and is not overwritten: expected another name");
  VideoServerConfig server = arguments.server;
  server.encoding = named<VideoEncoding>("--video", arguments.video);
  const StopSignal stop;
  std::optional<Rehearsal> rehearsal;
  try {
    rehearsal.emplace(experiment, server);
  } catch (const std::invalid_argument& error) {
    throw input_error(arguments.experiment, error.what());
  }
  experiment.equipment = rehearsal->equipment();
  experiment.truth.reset();
  replace_file(file, fmt::format("{}: the devices in it exist until the rehearsal ends.\n{}", copy_mark,
                                 experiment_toml(experiment)));
  print_devices(experiment, arguments.video, out);
  print_line(out, "wrote", file.string());
  print_line(out, "run in another terminal", fmt::format("flexura run {}", file.string()));
  out << "Ctrl-C ends the rehearsal\n" << std::flush;
  for (int runs = 0; stop.come() == 0 && rehearsal->failure().empty();) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (rehearsal->runs() == runs) continue;
    runs = rehearsal->runs();
    out << "arm and heads are back in their start positions for the next run\n" << std::flush;
  }
  const std::string failure = rehearsal->failure();
  for (std::size_t i = 0; i < experiment.equipment->camera.size(); ++i) {
    const RehearsedPictures pictures = rehearsal->pictures(i);
    print_line(out, experiment.equipment->camera[i].name,
               fmt::format("{} pictures sent, {} skipped", pictures.sent, pictures.skipped));
    if (pictures.skipped * 10 > pictures.sent)
      print_line(err, "note", "this machine is too slow: take smaller pictures or a lower sensor.frame_rate");
  }
  if (failure.empty()) return exit_done;
  print_line(err, "failed", failure);
  return exit_missed;
}

}  // namespace flexura
