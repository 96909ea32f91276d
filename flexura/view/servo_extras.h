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

/// What a servo sees in one picture, as the log has it.
struct ServoPicture {
  ServoObservationMessage observation;
  std::optional<std::int64_t> number =
      {};  ///< Of the picture for clients; none: of no picture that they get.
};

/// What a servo does at one time: its last command, and the pictures that go with that.
struct ShownServo {
  ServoStep step;
  std::vector<ServoPicture> pictures;
};

/// What is drawn of a servo: the wanted shape, the one that is seen and the simulated truth as ghosts, the
/// measured axes and the wanted shape's images, the distances along the arm. Of a truth that has other arcs
/// than the rig's arm (a rod) there is no shape. InputError where its shapes do not fit the rig's arm.
[[nodiscard]] Extras servo_extras(const ViewedRig& rig, const ShownServo& servo);

/// A servo's errors over time, in percent of the arm's length, and those at one command.
[[nodiscard]] std::vector<Quantity> servo_quantities();
[[nodiscard]] std::vector<std::optional<double>> servo_values(const ServoStep& step);

}  // namespace flexura
