// Any bytes as an experiment file must give an experiment or an InputError, and an experiment must survive
// writing and reading. First lines that begin with "--set " override values, as on the command line.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "flexura/base/source.h"
#include "flexura/camera/camera.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/schedule.h"
#include "flexura/model/backbone.h"
#include "flexura/safety/motion_check.h"

namespace {

using namespace flexura;

// Removes the override lines from `text`.
Overrides take_overrides(std::string_view& text) {
  constexpr std::string_view option = "--set ";
  Overrides overrides;
  while (text.starts_with(option) && overrides.sets.size() < 10) {
    const std::size_t end = text.find('\n');
    overrides.sets.emplace_back(text.substr(option.size(), end - option.size()));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return overrides;
}

void check_cameras(const std::vector<CameraConfig>& cameras) {
  for (const CameraConfig& config : cameras) {
    const Camera camera(config);
    const Pose X_WC = camera.pose(camera.initial_stance());
    if (!config.mount.pose().rotation.allFinite() || !X_WC.position.allFinite()) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  const Overrides overrides = take_overrides(text);
  Experiment experiment;
  try {
    experiment = parse_experiment(text, "fuzz.toml", overrides);
  } catch (const InputError& error) {
    if (error.problems().empty() || std::string_view(error.what()).empty()) std::abort();
    return 0;
  }
  const std::string written = experiment_toml(experiment);
  if (experiment_toml(parse_experiment(written, "written.toml")) != written) std::abort();
  check_cameras(experiment.cameras());
  check_cameras(experiment.true_rig().cameras);
  const Arm arm = experiment.arm.arm();
  const Schedule schedule(experiment);
  const ArmState last = schedule.state_at(schedule.duration());
  if (!is_possible(last)) return 0;  // A run stops before.
  const Backbone backbone(arm, last);
  if (!backbone.tip().position.allFinite() || !backbone.tip().rotation.allFinite()) std::abort();
  return 0;
}
