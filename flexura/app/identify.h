#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "flexura/app/identify_log.h"
#include "flexura/mechanics/rod.h"

namespace flexura {

/// Arguments of `flexura identify`.
struct IdentifyArguments {
  std::string experiment = {};
  std::string motion = {};  ///< Results folder, log, or table of places.
  std::vector<std::string> sets = {};
  std::optional<double> from = {}, to = {};  ///< Part of the motion to use, s.
  std::optional<double> noise_mm = {};       ///< Standard deviation of places; noise for a log's places.
  std::optional<double> window = {};         ///< Length of motion in one equation, s.
  std::optional<std::int64_t> seed = {};     ///< Seed of the noise added to a log's places.
  bool mass = false;                         ///< Also identify a mass factor.
  bool friction = false;                     ///< Also identify the friction coefficient of the tendons.
  bool alike = false;                        ///< Whether all sections are of one material.
  bool json = false;
};

/// One value identified from a motion.
struct IdentifiedValue {
  std::string name;  ///< "youngs_modulus", "stiffness_factor", "damping_time", "mass_factor", "friction".
  std::string unit;  ///< "Pa", "s" or "".
  std::optional<std::size_t> section = {};  ///< From 1; empty: the whole arm.
  bool is_determined = false;               ///< If false, the motion does not determine value and sigma.
  /// False for a determined value that no material has: a negative damping time or friction, or no stiffness
  /// or mass above 0. The value is not constrained, so that its standard deviation remains valid.
  bool is_physical = true;
  double value = 0;
  double sigma = 0;    ///< Standard deviation of the value.
  double nominal = 0;  ///< Value in the file.
};

/// The result of the identification.
struct IdentifiedArm {
  std::vector<IdentifiedValue> values;
  std::size_t samples = 0, places = 0;
  int equations = 0;
  double misfit = 0;  ///< Identification::misfit. If above 1, all sigmas are scaled by its square root.
  double noise = 0;   ///< Standard deviation of a place's coordinates, m.
  double rms = 0;     ///< Rms residual of the coordinates after fitting the strain modes, m.
  /// Rms distance from the places (places_missed) of the arm in the file, m. Infinite if the motion cannot be
  /// computed.
  double missed_file = 0;
  double missed = 0;      ///< The same distance for the identified arm, m. Unphysical values: as in the file.
  double step = 0;        ///< Mean time between two samples, s.
  bool converged = true;  ///< Identification::converged.
};

/// What to identify, and how.
struct IdentifySettings {
  double noise = 0;   ///< Standard deviation of measured places, m; 0: unknown.
  double window = 0;  ///< Length of motion in one equation, s; 0: the period of the slowest mode, if any.
  bool mass = false;
  bool friction = false;
  bool alike = false;
};

/// Identifies the stiffness and damping time of each section from a motion of the arm; with `mass` a mass
/// factor of the arm, with `friction` one friction coefficient of all its tendons. `rod` is the nominal rod
/// of `arm`. Throws std::invalid_argument as record_of_places() and identify() do.
[[nodiscard]] IdentifiedArm identify_arm(const ArmConfig& arm, const Rod& rod, const MeasuredMotion& motion,
                                         const IdentifySettings& settings);

/// Prints the identified material of an arm, for people or as JSON lines. Returns exit_missed if nothing was
/// identified. Throws InputError for bad input.
int identify_command(const IdentifyArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace flexura
