#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "flexura/tasks/calibrate/calibration_messages.h"
#include "flexura/view/extras.h"

namespace flexura {

/// What a calibration measured in one picture, as the log has it.
struct CalibrationPicture {
  CalibrationObservationMessage observation;
  std::optional<std::int64_t> number =
      {};  ///< Of the picture for clients; none: of no picture that they get.
};

/// A calibration at one time: the last that it decided, and the last picture of each camera.
struct ShownCalibration {
  std::optional<CalibrationDecisionMessage> decision;
  std::vector<CalibrationPicture> pictures;
};

/// What is drawn of a calibration: upon each picture what was measured in it, and in words what follows from
/// that.
[[nodiscard]] Extras calibration_extras(const ShownCalibration& calibration);

}  // namespace flexura
