#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "flexura/tasks/calibrate/calibration_messages.h"
#include "flexura/view/extras.h"

namespace flexura {

/// Observation of a calibration in one picture, as logged.
struct CalibrationPicture {
  CalibrationObservationMessage observation;
  std::optional<std::int64_t> number =
      {};  ///< Number of the picture in messages to clients; missing if clients do not get the picture.
};

/// State of a calibration at one time: its last decision, and the last picture of each camera.
struct ShownCalibration {
  std::optional<CalibrationDecisionMessage> decision;
  std::vector<CalibrationPicture> pictures;
};

/// Returns the extras of a calibration: the measurements as layers on each picture, and a text about the
/// estimate.
[[nodiscard]] Extras calibration_extras(const ShownCalibration& calibration);

}  // namespace flexura
