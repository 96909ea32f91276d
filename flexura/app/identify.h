#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "flexura/app/identify_log.h"
#include "flexura/mechanics/rod.h"

namespace flexura {

/// What `flexura identify` is told.
struct IdentifyArguments {
  std::string experiment = {};
  std::string motion = {};  ///< A results folder, a log or a table of places.
  std::vector<std::string> sets = {};
  std::optional<double> from = {}, to = {};  ///< s
  std::optional<double> noise_mm = {};       ///< Of measured places; a log's places get it.
  std::optional<double> window = {};         ///< s
  std::optional<std::int64_t> seed = {};     ///< Of the errors that a log's places get.
  bool mass = false;                         ///< Look for a factor on the mass too.
  bool alike = false;                        ///< All sections are of one material.
  bool json = false;
};

/// A number of an arm that a motion tells.
struct IdentifiedValue {
  std::string name;  ///< "youngs_modulus", "stiffness_factor", "damping_time" or "mass_factor".
  std::string unit;  ///< "Pa", "s" or "".
  std::optional<std::size_t> section = {};  ///< From 1; none: all of the arm.
  bool is_determined = false;               ///< Else value and sigma say nothing.
  double value = 0;
  double sigma = 0;    ///< Its standard deviation.
  double nominal = 0;  ///< In the file.
};

/// What a motion tells of an arm.
struct IdentifiedArm {
  std::vector<IdentifiedValue> values;
  std::size_t samples = 0, places = 0;
  int equations = 0;
  double misfit = 0;       ///< As Identification's; where it is above 1, all sigmas are larger by its root.
  double noise = 0;        ///< Of a place's coordinates, m.
  double rms = 0;          ///< What the strain modes leave of these, root mean square, m.
  double missed_file = 0;  ///< places_missed, m: of the arm of the file, and of the arm as identified;
  double missed = 0;       ///< infinite where its motion cannot be computed.
};

/// What of an arm is looked for, and how.
struct IdentifySettings {
  double noise = 0;   ///< m; 0: not known.
  double window = 0;  ///< s; 0: as the period of the arm's slowest swing, if it has one.
  bool mass = false;
  bool alike = false;
};

/// The stiffness of each section and its damping time by a motion of the arm. The rod is that of `arm`, as
/// believed. std::invalid_argument: as record_of_places() and identify().
[[nodiscard]] IdentifiedArm identify_arm(const ArmConfig& arm, const Rod& rod, const MeasuredMotion& motion,
                                         const IdentifySettings& settings);

/// Prints what a motion tells of an arm's material, for people or as JSON lines. exit_missed: nothing.
/// InputError for bad input.
int identify_command(const IdentifyArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace flexura
