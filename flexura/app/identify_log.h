#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "flexura/experiment/experiment.h"
#include "flexura/mechanics/place_record.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"

namespace flexura {

/// Which of a motion is read, s; none: from its start, to its end.
struct TimeSpan {
  std::optional<double> from = {}, to = {};

  /// Whether it has the time.
  [[nodiscard]] bool has(double time) const { return (!from || time >= *from) && (!to || time <= *to); }
};

/// Places of an arm over time, in the frame of its base, as they were measured or logged.
struct MeasuredMotion {
  std::vector<RodPlace> places;
  std::vector<RodPlaceSample> samples;
  bool is_logged = false;  ///< By a run, exactly.
  bool is_cut = false;     ///< The log ends where its run was cut short.
};

/// The motion in `file`, of the arm of `experiment`, whose rod is `rod`: a results folder or a log of a run
/// (the true arm's places and tensions), or a table of measured places, FILE.csv (docs/command-line.md,
/// "identify"). InputError: there is no such file, it is damaged, has no such motion or that of another arm,
/// or the arm touches something.
[[nodiscard]] MeasuredMotion read_motion(const std::filesystem::path& file, const Experiment& experiment,
                                         const Rod& rod, const TimeSpan& span);

}  // namespace flexura
