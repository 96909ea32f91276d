#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexura/servo/servo_step.h"
#include "flexura/tasks/servo/servo_messages.h"
#include "flexura/view/describe.h"
#include "flexura/view/extras.h"
#include "flexura/view/viewed_rig.h"

namespace flexura {

/// Observation of a servo in one picture, as logged.
struct ServoPicture {
  ServoObservationMessage observation;
  std::optional<std::int64_t> number =
      {};  ///< Number of the picture in messages to clients; missing if clients do not get the picture.
};

/// State of a servo at one time: its last command, and the pictures used for it.
struct ShownServo {
  ServoStep step;
  std::vector<ServoPicture> pictures;
};

/// Returns the extras of a servo. The extras include the target shape, the observed shape and the true shape
/// as ghosts, measured centerlines, images of the target shape, and distances along the arm. The true shape
/// is omitted if its arcs do not correspond to those of the rig's arm, for example for a rod. Throws
/// InputError if the shapes do not fit the rig's arm.
[[nodiscard]] Extras servo_extras(const ViewedRig& rig, const ShownServo& servo);

/// Returns the names of a servo's errors. The errors are in percent of the arm's length.
[[nodiscard]] std::vector<Quantity> servo_quantities();
/// Returns the values of the errors of servo_quantities() at one command.
[[nodiscard]] std::vector<std::optional<double>> servo_values(const ServoStep& step);

}  // namespace flexura
