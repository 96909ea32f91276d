#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "flexura/app/threshold_arguments.h"

namespace flexura {

/// What `flexura estimate` is told.
struct EstimateArguments {
  std::vector<std::string> images;  ///< One a camera, in the cameras' order.
  std::string cameras;              ///< A file of measured cameras.
  std::vector<double> base;         ///< p_WB, three numbers; none: not known.
  std::optional<double> length;     ///< m.
  std::string arm;                  ///< A file with the arm's sections; "" for none.
  /// Where the arm's bands are: arc lengths, m ("0.25"), or shares of its length ("25%"); empty: not known.
  std::vector<std::string> markers;
  ThresholdArguments threshold;
  std::int64_t points = 101;  ///< Of the backbone, as it is printed.
};

/// Prints the shape of the arm that the pictures show, as one JSON document (docs/estimation.md). Returns
/// exit_missed when no shape was found. InputError for bad input.
int estimate_command(const EstimateArguments& arguments, std::ostream& out);

}  // namespace flexura
