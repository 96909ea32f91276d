#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "flexura/experiment/identify_arm.h"

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

/// Prints the identified material of an arm, as text or as JSON lines. Returns exit_missed if nothing was
/// identified. Throws InputError for bad input.
int identify_command(const IdentifyArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace flexura
