#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/base/progress.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/measured_motion.h"
#include "flexura/mechanics/rod.h"

namespace flexura {

/// Returns the nominal rod of an experiment's arm, as identify_arm() needs it. Throws InputError, with the
/// position `source`, for arms that cannot be identified: arms without material, in a fluid, or with
/// payloads.
[[nodiscard]] Rod identifiable_rod(const Experiment& experiment, const std::string& source);

/// Adds Gaussian noise of the given standard deviation, m, to the positions of a motion.
void add_noise(MeasuredMotion& motion, double noise, std::int64_t seed);

/// One value identified from a motion.
struct IdentifiedValue {
  std::string name;  ///< "youngs_modulus", "stiffness_factor", "damping_time", "mass_factor", "friction".
  std::string unit;  ///< "Pa", "s" or "".
  std::optional<std::size_t> section = {};  ///< Number of the section, from 1; empty: the whole arm.
  bool is_determined = false;               ///< Whether the motion determines `value` and `sigma`.
  /// False if a determined value is impossible for a material: a negative damping time or friction, or a
  /// stiffness or mass that is not above 0. The estimate may take impossible values, because a constraint
  /// would invalidate the standard deviation.
  bool is_physical = true;
  double value = 0;
  double sigma = 0;    ///< Standard deviation of the value.
  double nominal = 0;  ///< Value in the experiment file.
};

/// The result of the identification.
struct IdentifiedArm {
  std::vector<IdentifiedValue> values;
  std::size_t samples = 0, places = 0;
  int equations = 0;
  /// Identification::misfit. If the misfit is above 1, all sigmas are multiplied by its square root.
  double misfit = 0;
  double noise = 0;  ///< Standard deviation of the coordinates of measured positions, m.
  double rms = 0;    ///< Rms residual of the coordinates after fitting the strain modes, m.
  /// Rms distance of the arm in the file from the measured positions (places_missed), m. Infinite if the
  /// motion cannot be computed.
  double missed_file = 0;
  /// Rms distance of the identified arm from the measured positions, m. The identified arm has the file's
  /// values in place of impossible ones.
  double missed = 0;
  double step = 0;        ///< Mean time between two samples, s.
  bool converged = true;  ///< Identification::converged.
};

/// Settings of an identification.
struct IdentifySettings {
  double noise = 0;   ///< Standard deviation of measured positions, m; 0: unknown.
  double window = 0;  ///< Duration of motion in one equation, s; 0: the period of the slowest mode, if any.
  bool mass = false;
  bool friction = false;
  bool alike = false;
};

/// Identifies the stiffness and damping time of each section from a motion of the arm. If `mass` is true, the
/// identification also estimates a factor on the mass. If `friction` is true, it also estimates one friction
/// coefficient for all tendons. `rod` is the nominal rod of `arm`. Throws std::invalid_argument in the cases
/// in which record_of_places() and identify() throw it.
[[nodiscard]] IdentifiedArm identify_arm(const ArmConfig& arm, const Rod& rod, const MeasuredMotion& motion,
                                         const IdentifySettings& settings, Progress& progress);

/// Returns the words for a value: "section 1: Young's modulus, Pa".
[[nodiscard]] std::string label_of(const IdentifiedValue& value);
/// Returns a value as `flexura identify --json` prints it.
[[nodiscard]] Node identified_node(const IdentifiedValue& value);
/// Returns the rest of the result: numbers of samples, places and equations, misfit, and residuals.
[[nodiscard]] Node identified_node(const IdentifiedArm& found);

/// Returns the notes of `flexura identify` on a result: what may be wrong with it. `noise`: as in
/// IdentifySettings.
[[nodiscard]] std::vector<std::string> identification_notes(const IdentifiedArm& found, double noise);

}  // namespace flexura
