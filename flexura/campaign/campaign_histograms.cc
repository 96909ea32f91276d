#include "flexura/campaign/campaign_histograms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "flexura/campaign/statistics.h"

namespace flexura {
namespace {

// The range of a measure's numbers.
struct MeasureRange {
  std::int64_t count = 0;
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

std::optional<double> finite_number(const Node& value) {
  const std::optional<double> number = measured_number(value);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::size_t bin_count(const MeasureRange& range) {
  if (range.low == range.high) return 1;
  const double root = std::ceil(std::sqrt(static_cast<double>(range.count)));
  return static_cast<std::size_t>(std::clamp(root, 2.0, static_cast<double>(most_bins)));
}

}  // namespace

std::vector<CampaignHistogram> histograms_of(CampaignResults& results) {
  const std::vector<CampaignMeasureConfig>& measures = results.campaign().config().measure;
  std::vector<MeasureRange> ranges(std::min(measures.size(), most_histograms));
  const auto visit_numbers = [&](const auto& visit) {
    results.for_each([&](const CampaignRow& row) {
      for (std::size_t i = 0; i < ranges.size(); ++i)
        if (const auto number = finite_number(row.measures[i])) visit(i, *number);
    });
  };
  visit_numbers([&](std::size_t i, double number) {
    ++ranges[i].count;
    ranges[i].low = std::min(ranges[i].low, number), ranges[i].high = std::max(ranges[i].high, number);
  });
  std::vector<std::vector<std::int64_t>> bins(ranges.size());
  for (std::size_t i = 0; i < ranges.size(); ++i)
    if (ranges[i].count > 0) bins[i].resize(bin_count(ranges[i]));
  visit_numbers([&](std::size_t i, double number) {
    if (bins[i].empty()) return;  // The row is newer than the ranges.
    const double width = ranges[i].high - ranges[i].low;
    const double share = width > 0 ? std::clamp((number - ranges[i].low) / width, 0.0, 1.0) : 0;
    const auto place = static_cast<std::size_t>(share * static_cast<double>(bins[i].size()));
    ++bins[i][std::min(place, bins[i].size() - 1)];
  });
  std::vector<CampaignHistogram> histograms;
  for (std::size_t i = 0; i < ranges.size(); ++i)
    if (!bins[i].empty())
      histograms.push_back({measures[i].label(), ranges[i].low, ranges[i].high, std::move(bins[i])});
  return histograms;
}

}  // namespace flexura
