#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/experiment/experiment.h"
#include "flexura/model/arm.h"

namespace flexura {

/// An axis that `flexura jog` moves.
struct JogAxis {
  enum class Kind { motor, tendon, section, pan, tilt, zoom };
  Kind kind = Kind::motor;
  std::size_t index = 0;  ///< Motor, tendon or section, from 0; of a camera, its index in Setup::cameras().
  int component = 0;      ///< For a section: direction of the bend, 0 towards x, 1 towards y.
  std::string name;       ///< Name of the axis as the user gave it.

  /// Returns whether this is an axis of a camera's head.
  [[nodiscard]] bool is_of_camera() const {
    return kind == Kind::pan || kind == Kind::tilt || kind == Kind::zoom;
  }
  /// Returns the unit of distances of this axis in the user's text: "microsteps", "mm", "deg", or "" for a
  /// zoom.
  [[nodiscard]] std::string_view unit() const;
  /// Returns the factor from the unit in the user's text to the program's unit: microsteps, m, rad, or zoom
  /// positions.
  [[nodiscard]] double scale() const;
};

/// Returns the names of all axes of an experiment with equipment: "motor.1", "tendon.1", "section.1.x",
/// "front.pan".
[[nodiscard]] std::vector<std::string> jog_axis_names(const Experiment& experiment);
/// Returns the axis with this name. Throws InputError, with all names, if the name is unknown.
[[nodiscard]] JogAxis jog_axis(const Experiment& experiment, const std::string& name);
/// Returns the distance in `text`, a number with or without the axis's unit ("5", "5mm", "-2 deg"), in the
/// program's unit. Throws InputError for anything else, a number that is not finite, and 0.
[[nodiscard]] double jog_distance(const JogAxis& axis, const std::string& text);

/// How the arm moves in a jog.
struct ArmJog {
  std::vector<double> pulled;  ///< Displacement of each tendon at the end of the jog, m.
  ArmState from, to;           ///< Shapes of the model.
  double duration = 0;         ///< s
};
/// Returns the jog of a motor, a tendon or a section by `distance` (jog_distance) from the arm's initial
/// shape, slow enough for the limits in the file. Adds to `refusals` each reason why the jog could harm the
/// robot, one line each. Reasons are findings of the safety check, a tendon that pulls too far against the
/// others, and positions beyond the limits of the motors' controllers.
[[nodiscard]] ArmJog plan_arm_jog(const Experiment& experiment, const JogAxis& axis, double distance,
                                  std::vector<std::string>& refusals);

/// Largest displacement against the other tendons in one jog, m.
inline constexpr double most_jog_strain = 1e-3;

}  // namespace flexura
