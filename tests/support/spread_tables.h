#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/study_numbers.h"

// Table rows of studies: the distribution of many values and the comparison with goals.
namespace flexura {

inline constexpr const char* spread_head =
    "| quantity | RMS | 95 % | largest |\n| --- | ---: | ---: | ---: |\n";

/// Returns a row with the distribution of the absolute values.
inline std::string spread_row(const std::string& name, std::vector<double> values, double unit, int digits) {
  const std::vector<double> sizes = sizes_of(std::move(values));
  return fmt::format("| {} | {:.{}f} | {:.{}f} | {:.{}f} |\n", name, root_mean_square(sizes) / unit, digits,
                     quantile(sizes, 0.95) / unit, digits, quantile(sizes, 1) / unit, digits);
}

/// A goal: a share of all trials must stay within a bound.
struct Aim {
  std::string name;            ///< Name with the bound: "focal length within 0.3 %".
  double most = 0, unit = 1;   ///< Bound, and the unit of the table.
  std::vector<double> values;  ///< Values of the completed trials; the others count as failed.
  double share = 1;            ///< Required share of the trials.
  bool has_rms = true;         ///< Whether the root mean square is judged as well.
};

inline constexpr const char* aim_head =
    "| case | aim | trials that reach it | all trials | RMS | largest |\n"
    "| --- | --- | ---: | --- | --- | ---: |\n";

inline std::string aim_row(const std::string& of, const Aim& aim, std::size_t trials) {
  const std::vector<double> sizes = sizes_of(aim.values);
  const auto kept = std::ranges::count_if(sizes, [&](double size) { return size <= aim.most; });
  constexpr double rounding = 1e-12;
  const double failed = trials == 0 ? std::numeric_limits<double>::quiet_NaN()
                                    : 1 - static_cast<double>(kept) / static_cast<double>(trials);
  const double rms = root_mean_square(sizes);
  const auto number = [&](double value) {
    return std::isnan(value) ? std::string() : fmt::format("{:.4g}", value / aim.unit);
  };
  return fmt::format("| {} | {} | {} of {} | {} | {} | {} |\n", of, aim.name, kept, trials,
                     verdict(failed, 1 - aim.share + rounding),
                     aim.has_rms ? fmt::format("{} ({})", verdict(rms, aim.most), number(rms)) : "",
                     number(quantile(sizes, 1)));
}

}  // namespace flexura
