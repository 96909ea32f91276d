#include "flexura/view/branch.h"

#include <fmt/format.h>

#include <cstddef>

#include "flexura/base/source.h"
#include "flexura/view/session.h"

namespace flexura {

RigInstant instant_at(const Recording& recording, double time) {
  const std::size_t place = recording.state_at(time);
  const ViewedRig& rig = *recording.rig();
  RigInstant instant{recording.state(place), {}};
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    instant.cameras.push_back(rig.reading(i, recording.stance(i, recording.time_of_state(place))));
  return instant;
}

Experiment experiment_from(const Recording& recording, double time) {
  Experiment experiment = started_at(*recording.rig(), instant_at(recording, time));
  const double start = recording.time_of_state(recording.state_at(time));
  experiment.title = fmt::format("{} (from {:.4g} s)", experiment.title, start);
  // A start that no file may have is refused here, and not when the results of a run are opened.
  try {
    Experiment checked = parse_experiment(experiment_toml(experiment), "");
    checked.folder = experiment.folder;
    return checked;
  } catch (const InputError& error) {
    throw ViewRefusal(
        fmt::format("a rig cannot start in the state at {:.4g} s: {}", start, error.problems().front().what));
  }
}

}  // namespace flexura
