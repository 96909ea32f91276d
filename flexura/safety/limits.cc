#include "flexura/safety/limits.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexura {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double largest_radius(const Section& section) { return std::max(section.radius[0], section.radius[1]); }

// Returns the tube's radius over the section's length. It is finite for any length, so that bounds on
// products with it are finite too.
double slenderness(const Section& section) {
  return std::min(largest_radius(section) / section.length, 1e200);
}

// Returns a bound on |d/dt (bend r / (length stretch))|. Its bend is at most, and its stretch at least, what
// the middle and the rates allow.
double folding_rate(const Section& section, const Motion& motion, std::size_t i, double start, double end) {
  const SectionRates rates = rates_of(motion, i, start, end);
  const ArmState middle = motion.at((start + end) / 2);
  const double half = (end - start) / 2;
  const double bend = middle.bends[i].norm() + rates.bend * half;
  const double stretch = middle.stretches[i] - rates.stretch * half;
  if (middle.stretches[i] + rates.stretch * half <= 0) return 0;  // No length anywhere: always infinite.
  if (stretch <= 0) return infinity;
  return slenderness(section) * (rates.bend / stretch + bend * rates.stretch / (stretch * stretch));
}

void add_watches(const Section& section, std::size_t i, std::vector<LimitWatch>& watches) {
  const auto stretch = [i](const ArmState& state) { return state.stretches[i]; };
  const auto stretch_rate = [i](const Motion& motion, double a, double b) {
    return rates_of(motion, i, a, b).stretch;
  };
  if (std::isfinite(section.max_bend)) {
    watches.push_back(
        {Hazard::bend, i, section.max_bend, 1, [i](const ArmState& state) { return state.bends[i].norm(); },
         [i](const Motion& motion, double a, double b) { return rates_of(motion, i, a, b).bend; }});
  }
  watches.push_back({Hazard::stretch, i, section.stretch_limits[1], 1, stretch, stretch_rate});
  watches.push_back({Hazard::stretch, i, section.stretch_limits[0], -1, stretch, stretch_rate});
  watches.push_back({Hazard::folding, i, 1, 1,
                     [i, section](const ArmState& state) {
                       if (state.stretches[i] <= 0) return infinity;
                       return state.bends[i].norm() * slenderness(section) / state.stretches[i];
                     },
                     [i, section](const Motion& motion, double a, double b) {
                       return folding_rate(section, motion, i, a, b);
                     }});
}

WatchedQuantity watched_rate(const Motion& motion, std::size_t section, double SectionRates::* which) {
  const auto value = [&motion, section, which](double t) { return rates_of(motion, section, t, t).*which; };
  // A rate has no known bound on its rate of change, only a largest value. A short interval counts as too
  // fast throughout if its ends and middle are too fast.
  const double short_interval = motion.duration() * 1e-4;
  return {value, [&motion, section, which, value, short_interval](double start, double end) {
            const double high = rates_of(motion, section, start, end).*which;
            const double low = end - start > short_interval
                                   ? 0.0
                                   : std::min({value(start), value((start + end) / 2), value(end)});
            return QuantityBounds{low, high};
          }};
}

}  // namespace

double LimitWatch::threshold() const {
  const double tolerance = std::abs(limit) * limit_tolerance;
  return sign * limit + (hazard == Hazard::folding ? -tolerance : tolerance);
}

std::vector<LimitWatch> limit_watches(const Arm& arm) {
  std::vector<LimitWatch> watches;
  for (std::size_t i = 0; i < arm.sections.size(); ++i) add_watches(arm.sections[i], i, watches);
  return watches;
}

SectionRates rates_of(const Motion& motion, std::size_t section, double start, double end) {
  return motion.rates(section, start, end).value_or(SectionRates{});
}

WatchedQuantity bend_rate(const Motion& motion, std::size_t section) {
  return watched_rate(motion, section, &SectionRates::bend);
}

WatchedQuantity stretch_rate(const Motion& motion, std::size_t section) {
  return watched_rate(motion, section, &SectionRates::stretch);
}

}  // namespace flexura
