#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "flexura/experiment/experiment.h"
#include "flexura/mechanics/place_record.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"

namespace flexura {

/// Part of a motion to read, s. An empty `from` is the motion's start, an empty `to` its end.
struct TimeSpan {
  std::optional<double> from = {}, to = {};

  /// Returns whether the time is within the span.
  [[nodiscard]] bool has(double time) const { return (!from || time >= *from) && (!to || time <= *to); }
};

/// Measured or logged positions along an arm over time, in the frame of its base.
struct MeasuredMotion {
  std::vector<RodPlace> places;
  std::vector<RodPlaceSample> samples;
  bool is_logged = false;               ///< Whether the positions are from a run's log, and therefore exact.
  std::vector<std::string> notes = {};  ///< What is missing in the log (log_notes).
};

/// Returns the place of a rod at an arc length at rest, m; std::nullopt for a length that is not on the rod,
/// or 0.
[[nodiscard]] std::optional<RodPlace> place_at(const Rod& rod, double s);

/// Reads the motion of the arm of `experiment`, whose rod is `rod`, from `file`. `file` is a results folder,
/// a log of a run, or a table FILE.csv of measured positions (docs/command-line.md, "identify"). From a log,
/// it reads positions and tensions of the true arm. Throws InputError if the file is missing or damaged, does
/// not contain a motion of this arm, or if the arm touches something.
[[nodiscard]] MeasuredMotion read_motion(const std::filesystem::path& file, const Experiment& experiment,
                                         const Rod& rod, const TimeSpan& span);

}  // namespace flexura
