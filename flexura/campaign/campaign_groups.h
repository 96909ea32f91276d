#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flexura/campaign/campaign_summary.h"
#include "flexura/report/report.h"

namespace flexura {

/// The runs of a campaign that have equal values of grids, lists and choices.
struct CampaignGroup {
  std::vector<std::string> values;  ///< In the order of the parameters that distinguish the groups.
  std::vector<std::size_t> runs;    ///< Indices of the summary's runs, in order.
};

/// The runs of a campaign by groups, in the order of their first runs.
struct CampaignGroups {
  std::vector<std::string> parameters;  ///< Names of the parameters that distinguish the groups.
  std::vector<CampaignGroup> groups;
};

/// Largest number of groups. Further parameters do not distinguish groups.
inline constexpr std::size_t most_campaign_groups = 200;

[[nodiscard]] CampaignGroups groups_of(const CampaignSummary& summary, const CampaignConfig& config);

/// Returns a table with one row per group: number of runs, of runs that are done, and for each measure the
/// median, the 95 % quantile (nearest rank) and the largest value of the runs that are done. For measures
/// with bounds or truth values, it also has the number of runs within the bounds, or true.
[[nodiscard]] ChapterTable group_table(const CampaignGroups& groups, const CampaignSummary& summary,
                                       const CampaignConfig& config);

/// Returns a table of the most frequent reasons of runs that are not done, with the number of runs in each
/// group. Numbers in the reasons are replaced by "...".
[[nodiscard]] ChapterTable reason_table(const CampaignGroups& groups, const CampaignSummary& summary);

/// Returns the description and both tables as a Markdown document.
[[nodiscard]] std::string campaign_markdown(CampaignResults& results);

}  // namespace flexura
