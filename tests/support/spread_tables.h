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

// Tables of studies, line by line: what many values are, and whether they are what was aimed at.
namespace flexura {

inline constexpr const char* spread_head = "| | rms | 95 % | worst |\n| --- | ---: | ---: | ---: |\n";

/// Of the values' sizes.
inline std::string spread_row(const std::string& name, std::vector<double> values, double unit, int digits) {
  const std::vector<double> sizes = sizes_of(std::move(values));
  return fmt::format("| {} | {:.{}f} | {:.{}f} | {:.{}f} |\n", name, root_mean_square(sizes) / unit, digits,
                     quantile(sizes, 0.95) / unit, digits, quantile(sizes, 1) / unit, digits);
}

/// That a share of all trials keeps to a bound.
struct Aim {
  std::string name;            ///< With the bound: "focal length within 0.3 %".
  double most = 0, unit = 1;   ///< The bound, and in what the table says the values.
  std::vector<double> values;  ///< Of the trials that ended; the others do not keep to it.
  double share = 1;            ///< Of the trials.
  bool has_rms = true;         ///< Whether the values' root mean square is judged as well.
};

inline constexpr const char* aim_head =
    "| | aim | within | verdict | rms verdict | worst |\n"
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
