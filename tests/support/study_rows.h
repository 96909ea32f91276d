#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "tests/support/study_numbers.h"

// What the servo's study prints of its targets.
namespace flexura {

// What one target's run came to; errors are the simulated truth's, shares of the length.
struct Arrival {
  bool is_done = false;
  std::string reason;
  double settled = 0, overshoot = 0, rms = 0, most = 0, tip = 0, limit = 0;
  // Of those who believe their cameras, and of those who doubt them as the servo does.
  double without_prior = 0, with_prior = 0;
};

// "-" where there is none.
inline std::string number(double value, int digits) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, digits);
}

template <class Of>
std::vector<double> of_done(const std::vector<Arrival>& arrivals, Of of) {
  std::vector<double> values;
  for (const Arrival& one : arrivals)
    if (one.is_done) values.push_back(of(one));
  return values;
}

inline void print_row(const std::string& name, const std::vector<Arrival>& arrivals, bool has_floor) {
  const std::vector<double> settled = of_done(arrivals, [](const Arrival& a) { return a.settled; }),
                            over = of_done(arrivals,
                                           [](const Arrival& a) { return 100 * std::max(0.0, a.overshoot); }),
                            rms = of_done(arrivals, [](const Arrival& a) { return 100 * a.rms; }),
                            most = of_done(arrivals, [](const Arrival& a) { return 100 * a.most; }),
                            tip = of_done(arrivals, [](const Arrival& a) { return 100 * a.tip; }),
                            limit = of_done(arrivals, [](const Arrival& a) { return a.limit; }),
                            without_prior =
                                of_done(arrivals, [](const Arrival& a) { return 100 * a.without_prior; }),
                            with_prior =
                                of_done(arrivals, [](const Arrival& a) { return 100 * a.with_prior; });
  const auto pair = [&](const std::vector<double>& values) {
    return has_floor ? number(quantile(values, 0.5), 3) + " / " + number(quantile(values, 0.95), 3) : "-";
  };
  fmt::print("| {} | {}/{} | {} / {} | {} | {} / {} | {} | {} | {} | {} | {} |\n", name, rms.size(),
             arrivals.size(), number(quantile(settled, 0.5), 2), number(quantile(settled, 0.95), 2),
             number(quantile(over, 0.95), 1), number(quantile(rms, 0.5), 3), number(quantile(rms, 0.95), 3),
             number(quantile(most, 1), 3), number(quantile(tip, 0.95), 3), number(quantile(limit, 0), 2),
             pair(without_prior), pair(with_prior));
}

// Its numbers left out: reasons that differ in these are one.
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
