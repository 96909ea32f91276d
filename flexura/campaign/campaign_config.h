#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/campaign/parameter.h"
#include "flexura/campaign/sampler.h"

namespace flexura {

/// A value of the summary of each run.
struct CampaignMeasureConfig {
  std::string key;   ///< Path in summary.json: "servos.0.rms". Indices count from 0.
  std::string name;  ///< Name of the column in the results; "": the key.
  /// Bounds within which a run is a success. A measure that is true or false needs no bounds.
  std::optional<double> min, max;
  double scale = 1;       ///< Factor on the number in the summary: 100 for percent.
  bool absolute = false;  ///< Whether the absolute value of the number counts.

  [[nodiscard]] const std::string& label() const { return name.empty() ? key : name; }
};

/// The quantity whose precision a rule requires.
enum class Precise { mean, rate };
const std::vector<std::string>& names_of(const Precise*);

/// A rule that ends the campaign when a mean or a success rate is known precisely enough.
struct PrecisionConfig {
  std::string measure;           ///< Name of the measure.
  Precise of = Precise::mean;    ///< The mean of the values, or the rate of successes.
  double half_width = 0.01;      ///< Largest half width of the 95 % confidence interval.
  std::int64_t least_runs = 30;  ///< The rule decides only after this number of runs.
};

/// Conditions under which a campaign ends before all its runs are done.
struct StopConfig {
  std::optional<std::int64_t> runs;        ///< Largest number of runs.
  std::optional<double> time;              ///< Longest time of one call of the program, s.
  std::vector<PrecisionConfig> precision;  ///< The campaign ends when all these rules are fulfilled.
};

/// A campaign file: an experiment that runs many times with varied values.
struct CampaignConfig {
  std::string title;
  std::string description;       ///< Text about the campaign in its report; Markdown.
  std::string experiment;        ///< The experiment file, relative to the campaign file.
  std::vector<std::string> set;  ///< Changes to the experiment, "path=value", the same in all runs.
  std::int64_t seed = 1;
  Sampling sampling = Sampling::random;
  std::int64_t samples = 1;  ///< Samples of the distributions, for each combination of grids and lists.
  std::int64_t repeats = 1;  ///< Runs with equal parameters and different seeds.
  std::vector<ParameterConfig> parameter;
  std::vector<CampaignMeasureConfig> measure;
  StopConfig stop;
};

const Table<CampaignMeasureConfig>& fields_of(const CampaignMeasureConfig*);
const Table<PrecisionConfig>& fields_of(const PrecisionConfig*);
const Table<StopConfig>& fields_of(const StopConfig*);
const Table<CampaignConfig>& fields_of(const CampaignConfig*);

}  // namespace flexura
