#include "flexura/campaign/statistics.h"

#include <algorithm>
#include <cmath>

namespace flexura {
namespace {

constexpr double two_sided_95 = 1.959963984540054;  // Quantile of the standard normal distribution.

}  // namespace

void RunningMean::add(double value) {
  ++count_;
  const double off = value - mean_;
  mean_ += off / static_cast<double>(count_);
  squares_ += off * (value - mean_);
}

double RunningMean::deviation() const {
  return count_ < 2 ? 0 : std::sqrt(squares_ / static_cast<double>(count_ - 1));
}

double RunningMean::half_width() const {
  return two_sided_95 * deviation() / std::sqrt(static_cast<double>(std::max<std::int64_t>(count_, 1)));
}

ConfidenceInterval wilson_interval(std::int64_t successes, std::int64_t count) {
  if (count == 0) return {};
  constexpr double z2 = two_sided_95 * two_sided_95;
  const auto n = static_cast<double>(count);
  const double rate = static_cast<double>(successes) / n;
  const double middle = (rate + z2 / (2 * n)) / (1 + z2 / n);
  const double half = two_sided_95 / (1 + z2 / n) * std::sqrt(rate * (1 - rate) / n + z2 / (4 * n * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::optional<double> measured_number(const Node& value) {
  if (const auto* truth = value.as<bool>()) return *truth ? 1 : 0;
  if (const auto* whole = value.as<std::int64_t>()) return static_cast<double>(*whole);
  if (const auto* real = value.as<double>()) return *real;
  return std::nullopt;
}

bool is_success(const CampaignMeasureConfig& measure, const Node& value) {
  const std::optional<double> number = measured_number(value);
  if (!number) return false;
  if (!measure.min && !measure.max) return *number == 1;
  return (!measure.min || *number >= *measure.min) && (!measure.max || *number <= *measure.max);
}

StopTracker::StopTracker(const CampaignConfig& config) : measures_(config.measure) {
  for (const PrecisionConfig& precision : config.stop.precision) {
    const auto found = std::ranges::find(measures_, precision.measure, &CampaignMeasureConfig::label);
    rules_.push_back({precision, static_cast<std::size_t>(found - measures_.begin()), {}, 0});
  }
}

StopTracker::Values StopTracker::values_of(const CampaignRow& row) const {
  Values values;
  for (const Rule& rule : rules_) {
    const Node& value = row.measures.at(rule.measure);
    if (rule.config.of == Precise::mean)
      values.push_back(measured_number(value));
    else
      values.emplace_back(row.status == "done" && is_success(measures_[rule.measure], value) ? 1 : 0);
  }
  return values;
}

void StopTracker::add(const CampaignRow& row) {
  if (stop_) return;
  if (row.id != prefix_) {
    ahead_.emplace(row.id, values_of(row));
    return;
  }
  take(values_of(row));
  while (!stop_ && !ahead_.empty() && ahead_.begin()->first == prefix_) {
    const Values next = std::move(ahead_.begin()->second);
    ahead_.erase(ahead_.begin());
    take(next);
  }
}

void StopTracker::take(const Values& values) {
  ++prefix_;
  for (std::size_t i = 0; i < rules_.size(); ++i) {
    if (!values[i]) continue;
    if (rules_[i].config.of == Precise::mean)
      rules_[i].mean.add(*values[i]);
    else
      rules_[i].successes += *values[i] == 1 ? 1 : 0;
  }
  if (!rules_.empty() && std::ranges::all_of(rules_, [this](const Rule& rule) { return is_fulfilled(rule); }))
    stop_ = prefix_;
}

bool StopTracker::is_fulfilled(const Rule& rule) const {
  if (prefix_ < rule.config.least_runs) return false;
  if (rule.config.of == Precise::mean)
    return rule.mean.count() >= 2 && rule.mean.half_width() <= rule.config.half_width;
  const ConfidenceInterval interval = wilson_interval(rule.successes, prefix_);
  return (interval.high - interval.low) / 2 <= rule.config.half_width;
}

}  // namespace flexura
