#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/campaign/campaign.h"

namespace flexura {

/// Mean and variance of numbers, added one by one (B. Welford, Technometrics 4, 1962).
class RunningMean {
 public:
  void add(double value);
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] double mean() const { return mean_; }
  /// Returns the standard deviation of the numbers (with count - 1); 0 for fewer than two numbers.
  [[nodiscard]] double deviation() const;
  /// Returns the half width of the 95 % confidence interval of the mean (normal approximation).
  [[nodiscard]] double half_width() const;

 private:
  std::int64_t count_ = 0;
  double mean_ = 0, squares_ = 0;
};

/// A confidence interval.
struct ConfidenceInterval {
  double low = 0, high = 1;
};

/// Returns the 95 % interval of a probability after `successes` of `count` trials (E. Wilson, Journal of the
/// American Statistical Association 22, 1927). Without trials: 0 to 1.
[[nodiscard]] ConfidenceInterval wilson_interval(std::int64_t successes, std::int64_t count);

/// Returns a value as a number; std::nullopt for texts and missing values. Truth values are 0 and 1.
[[nodiscard]] std::optional<double> measured_number(const Node& value);

/// Returns whether a measure has a success rate: it has bounds, or its values are true or false.
[[nodiscard]] bool is_success(const CampaignMeasureConfig& measure, const Node& value);

/// Decides when a campaign has reached its precision, from its rows in the order of their numbers. The
/// decision depends on the first rows alone, whatever the order in which they arrive.
class StopTracker {
 public:
  explicit StopTracker(const CampaignConfig& config);

  /// Adds a row; its number must be new.
  void add(const CampaignRow& row);
  /// Returns the number of runs after which all rules were fulfilled; std::nullopt: not yet.
  [[nodiscard]] std::optional<std::int64_t> stop() const { return stop_; }
  /// Returns the first number without a row.
  [[nodiscard]] std::int64_t prefix() const { return prefix_; }
  /// Returns whether a row at or after prefix() was added.
  [[nodiscard]] bool has(std::int64_t id) const { return id < prefix_ || ahead_.contains(id); }

 private:
  // The values of a row that the rules need, one per rule.
  using Values = std::vector<std::optional<double>>;
  struct Rule {
    PrecisionConfig config;
    std::size_t measure = 0;
    RunningMean mean;
    std::int64_t successes = 0;
  };
  [[nodiscard]] Values values_of(const CampaignRow& row) const;
  void take(const Values& values);
  [[nodiscard]] bool is_fulfilled(const Rule& rule) const;

  std::vector<CampaignMeasureConfig> measures_;
  std::vector<Rule> rules_;
  std::map<std::int64_t, Values> ahead_;  // Rows after the first missing one.
  std::int64_t prefix_ = 0;
  std::optional<std::int64_t> stop_;
};

}  // namespace flexura
