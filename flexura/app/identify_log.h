#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "flexura/experiment/experiment.h"
#include "flexura/mechanics/place_record.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"

namespace flexura {

/// Part of a motion to read, s; empty: from its start, to its end.
struct TimeSpan {
  std::optional<double> from = {}, to = {};

  /// Returns whether the time is in the part.
  [[nodiscard]] bool has(double time) const { return (!from || time >= *from) && (!to || time <= *to); }
};

/// Measured or logged positions along an arm over time, in the frame of its base.
struct MeasuredMotion {
  std::vector<RodPlace> places;
  std::vector<RodPlaceSample> samples;
  bool is_logged = false;  ///< Whether a run logged them, which makes them exact.
  bool is_cut = false;     ///< Whether the log ends where its run was cut short.
};

/// Reads the motion of the arm of `experiment`, whose rod is `rod`, from `file`. The file is a results folder
/// or a log of a run (positions and tensions of the true arm), or a table of measured places, FILE.csv
/// (docs/command-line.md, "identify"). Throws InputError if the file is missing or damaged, has no such
/// motion or that of another arm, or if the arm touches something.
[[nodiscard]] MeasuredMotion read_motion(const std::filesystem::path& file, const Experiment& experiment,
                                         const Rod& rod, const TimeSpan& span);

}  // namespace flexura
