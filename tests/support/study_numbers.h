#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

// Statistics of many values. NaN values are ignored.
namespace flexura {

inline std::vector<double> numbers_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  return values;
}

/// Returns the quantile by nearest rank: the smallest value that at least this share of the values does not
/// exceed. NaN if there are no values.
inline double quantile(const std::vector<double>& values, double share) {
  std::vector<double> numbers = numbers_of(values);
  if (numbers.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double count = static_cast<double>(numbers.size()), place = std::ceil(share * count);
  const auto nth = numbers.begin() + static_cast<std::ptrdiff_t>(std::clamp(place, 1.0, count)) - 1;
  std::ranges::nth_element(numbers, nth);
  return *nth;
}

/// Returns the root mean square; NaN if there are no values.
inline double root_mean_square(const std::vector<double>& values) {
  const std::vector<double> numbers = numbers_of(values);
  double squares = 0;
  for (const double value : numbers) squares += value * value;
  return std::sqrt(squares / static_cast<double>(numbers.size()));
}

inline std::vector<double> sizes_of(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return values;
}

/// Returns whether a value is within the goal `most`; "not tested" if it is NaN.
inline std::string verdict(double value, double most) {
  if (std::isnan(value)) return "not tested";
  return value <= most ? "met" : "missed";
}

/// Returns chi^2 for the uniformity of shares between 0 and 1 in ten equal classes: nine degrees of freedom.
inline double unevenness(const std::vector<double>& shares) {
  constexpr std::size_t parts = 10;
  std::array<double, parts> counts{};
  for (const double share : shares)
    ++counts[static_cast<std::size_t>(std::clamp(share * parts, 0.0, parts - 1.0))];
  const double expected = static_cast<double>(shares.size()) / parts;
  double square = 0;
  for (const double count : counts) square += (count - expected) * (count - expected) / expected;
  return square;
}

}  // namespace flexura
