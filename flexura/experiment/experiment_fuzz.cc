// Any bytes as an experiment file: an experiment or an InputError, and what is read survives being written
// and read.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/schedule.h"
#include "flexura/model/backbone.h"
#include "flexura/safety/motion_check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace flexura;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Experiment experiment;
  try {
    experiment = parse_experiment(text, "fuzz.toml");
  } catch (const InputError& error) {
    if (error.problems().empty() || std::string_view(error.what()).empty()) std::abort();
    return 0;
  }
  const std::string written = experiment_toml(experiment);
  if (experiment_toml(parse_experiment(written, "written.toml")) != written) std::abort();
  const Arm arm = experiment.arm.arm();
  const Schedule schedule(experiment);
  const ArmState last = schedule.state_at(schedule.duration());
  if (!is_possible(last)) return 0;  // A run stops before.
  const Backbone backbone(arm, last);
  if (!backbone.tip().position.allFinite() || !backbone.tip().rotation.allFinite()) std::abort();
  return 0;
}
