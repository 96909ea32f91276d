#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "tests/support/study_numbers.h"

// Output of the study of an arm that swings.
namespace flexura {

// Results of one target's run; errors are those of the simulated truth, as shares of the length.
struct Arrival {
  bool is_done = false;
  std::string reason;
  double settled = 0, overshoot = 0, rms = 0, most = 0, tip = 0;
};

// Formats a number; "-" if it is NaN.
inline std::string number(double value, int digits) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, digits);
}

// Strips the numbers from a reason, so that equal reasons can be counted.
inline std::string kind_of(const std::string& reason) {
  std::string kind;
  for (const char c : reason) {
    const bool is_number = (c >= '0' && c <= '9') || c == '.';
    if (!is_number) kind += c;
    if (is_number && !kind.ends_with('#')) kind += '#';
  }
  return kind;
}

inline void print_reasons(const std::string& name, const std::vector<Arrival>& arrivals) {
  std::map<std::string, int> reasons;
  for (const Arrival& one : arrivals)
    if (!one.is_done) ++reasons[kind_of(one.reason)];
  for (const auto& [reason, count] : reasons) fmt::print("- {}: {} ended with \"{}\"\n", name, count, reason);
}

}  // namespace flexura
