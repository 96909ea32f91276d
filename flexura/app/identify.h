#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "flexura/app/identify_log.h"
#include "flexura/base/progress.h"
#include "flexura/mechanics/rod.h"

namespace flexura {

/// Arguments of `flexura identify`.
struct IdentifyArguments {
  std::string experiment = {};
  std::string motion = {};  ///< Results folder, log, or table of measured positions.
  std::vector<std::string> sets = {};
  std::optional<double> from = {}, to = {};  ///< Part of the motion to use, s.
  /// Standard deviation of measured positions, mm. A log's exact positions get noise of this size.
  std::optional<double> noise_mm = {};
  std::optional<double> window = {};      ///< Duration of motion in one equation, s.
  std::optional<std::int64_t> seed = {};  ///< Seed of the noise added to a log's positions.
  bool mass = false;                      ///< Whether to identify also a factor on the mass.
  bool friction = false;  ///< Whether to identify the friction coefficient of the tendons too.
  bool alike = false;     ///< Whether to assume that all sections have the same material.
  bool json = false;
};

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

/// Identifies the stiffness and damping time of each section from a motion of the arm. With `mass` it also
/// estimates a factor on the mass, with `friction` one friction coefficient for all tendons. `rod` is the
/// nominal rod of `arm`. Throws std::invalid_argument in the cases in which record_of_places() and identify()
/// throw it.
[[nodiscard]] IdentifiedArm identify_arm(const ArmConfig& arm, const Rod& rod, const MeasuredMotion& motion,
                                         const IdentifySettings& settings, Progress& progress);

/// Prints the identified material of an arm, as text or as JSON lines. Returns exit_missed if nothing was
/// identified. Throws InputError for bad input.
int identify_command(const IdentifyArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace flexura
