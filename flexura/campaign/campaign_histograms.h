#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/campaign/campaign_file.h"

namespace flexura {

/// Numbers of runs by intervals of equal width of a measure.
struct CampaignHistogram {
  std::string name;                ///< Name of the measure.
  double low = 0, high = 0;        ///< Smallest and largest value.
  std::vector<std::int64_t> bins;  ///< Number of runs in each interval; one interval if low = high.
};

/// Largest number of intervals of a histogram.
inline constexpr std::size_t most_bins = 24;
/// Largest number of histograms: those of the first measures.
inline constexpr std::size_t most_histograms = 12;

/// Returns the histograms of the measures that are numbers or truth values (false is 0, true is 1). Reads all
/// rows twice, and stores none of them.
[[nodiscard]] std::vector<CampaignHistogram> histograms_of(CampaignResults& results);

}  // namespace flexura
