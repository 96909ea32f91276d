#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "flexura/campaign/campaign_file.h"
#include "flexura/campaign/statistics.h"

namespace flexura {

/// The values of one parameter or measure in all runs of a campaign.
struct CampaignColumn {
  std::string name;
  /// One per run; not a number where a run has no value. A text counts as the index of its category.
  std::vector<double> values;
  std::vector<std::string> categories;  ///< Distinct texts, in the order found; empty for numbers.
  std::vector<bool> successes;          ///< Of a measure with a success rate: one per run; otherwise empty.
};

/// The results of a campaign by columns.
struct CampaignSummary {
  /// A run that is not done.
  struct Fault {
    std::int64_t id = 0;
    std::string status, error;
  };
  std::vector<std::int64_t> ids;
  std::vector<CampaignColumn> parameters, measures;
  std::vector<bool> is_done;         ///< Of each run: the status is "done".
  std::vector<std::size_t> reasons;  ///< Of each run: index in `reason_kinds`.
  std::vector<std::string>
      reason_kinds;  ///< Distinct first reasons of errors, without numbers; the first is "".
  std::map<std::string, std::int64_t> statuses;  ///< Number of runs of each status.
  std::vector<Fault> faults;                     ///< The first most_faults of each status.
  double seconds = 0;                            ///< Time of all runs, s.
};

/// Largest number of faults of each status in a summary.
inline constexpr std::int64_t most_faults = 5;

/// Reads all rows. A measure has successes if it has bounds, or if all its values are truth values, which are
/// stored as the whole numbers 0 and 1.
[[nodiscard]] CampaignSummary summary_of(CampaignResults& results);

/// How a measure depends on a parameter.
struct Sensitivity {
  double rank_correlation = 0;  ///< C. Spearman's, from -1 to 1; 0 for a parameter that is a text.
  /// Share of the variance of the measure that a function of the parameter alone explains, from 0 to 1: the
  /// squared correlation ratio of at most 10 groups of equal size, without its bias (T. Kelley, Proceedings
  /// of the National Academy of Sciences 21, 1935).
  double share = 0;
};

/// Returns the sensitivity of a measure to a parameter; std::nullopt for fewer than 20 runs with both values,
/// or if one of them does not vary.
[[nodiscard]] std::optional<Sensitivity> sensitivity_of(const CampaignColumn& measure,
                                                        const CampaignColumn& parameter);

/// Returns the indices of the worst runs of a measure, worst first, at most `most`: those that are no
/// success, the farthest from the bounds first. Without a success rate: the runs with the largest values.
[[nodiscard]] std::vector<std::size_t> worst_runs(const CampaignColumn& column,
                                                  const CampaignMeasureConfig& measure, std::size_t most);

/// Writes all rows as CSV into the new file `out`: number, seed, status, error text, seconds, parameters and
/// measures. Throws std::system_error if the file exists or cannot be written.
void export_campaign_csv(CampaignResults& results, const std::filesystem::path& out);

}  // namespace flexura
