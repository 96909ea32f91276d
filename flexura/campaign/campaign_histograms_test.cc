#include "flexura/campaign/campaign_histograms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "tests/support/campaign_files.h"

namespace flexura {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

// Adds rows with these heights (NaN: no value), of which every fourth failed.
void add_heights(CampaignFile& file, const Campaign& campaign, const std::vector<double>& heights) {
  std::vector<CampaignRow> rows;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const auto id = static_cast<std::int64_t>(i);
    rows.push_back(
        {.id = id,
         .seed = campaign.design().seed(id),
         .parameters = campaign.design().values(id),
         .status = i % 4 == 3 ? "failed" : "done",
         .error = {},
         .measures = {std::isnan(heights[i]) ? Node{} : Node{heights[i], {}}, text_node("done"), {true, {}}},
         .seconds = 0.1});
  }
  file.add(rows);
}

TEST(CampaignHistograms, CountTheRunsOfEachInterval) {
  const CampaignFolder folder;
  const Campaign campaign = folder.campaign();
  CampaignFile file(folder.path("a.db"), campaign);
  add_heights(file, campaign, {0, 0.1, 1, 1.9, no_number, 2, 3.9, 4, 4, no_number});
  CampaignResults results(folder.path("a.db"));
  const auto histograms = histograms_of(results);
  // The measure `outcome` is a text.
  ASSERT_EQ(histograms.size(), 2);
  EXPECT_EQ(histograms[0].name, "height");
  EXPECT_EQ(histograms[0].low, 0);
  EXPECT_EQ(histograms[0].high, 4);
  EXPECT_EQ(histograms[0].bins, (std::vector<std::int64_t>{3, 2, 3}));
  EXPECT_EQ(histograms[1].name, "of_summary");
  EXPECT_EQ(histograms[1].low, 1);
  EXPECT_EQ(histograms[1].high, 1);
  EXPECT_EQ(histograms[1].bins, (std::vector<std::int64_t>{10}));
}

TEST(CampaignHistograms, AreBounded) {
  const CampaignFolder folder;
  const Campaign campaign = folder.campaign({"samples=500"});
  CampaignFile file(folder.path("a.db"), campaign);
  std::vector<double> heights(2000);
  std::iota(heights.begin(), heights.end(), 0.0);
  heights.back() = std::numeric_limits<double>::infinity();
  add_heights(file, campaign, heights);
  CampaignResults results(folder.path("a.db"));
  const auto histograms = histograms_of(results);
  ASSERT_EQ(histograms[0].bins.size(), most_bins);
  EXPECT_EQ(std::reduce(histograms[0].bins.begin(), histograms[0].bins.end()), 1999)
      << "infinity is left out";
}

TEST(CampaignResults, CountTheRowsThatTheFileHasNow) {
  const CampaignFolder folder;
  const Campaign campaign = folder.campaign();
  CampaignFile file(folder.path("a.db"), campaign);
  CampaignResults results(folder.path("a.db"));
  EXPECT_EQ(results.counts().runs, 0);
  EXPECT_TRUE(histograms_of(results).empty());
  add_heights(file, campaign, std::vector<double>(9, 0.5));
  CampaignCounts counts = results.counts();
  EXPECT_EQ(counts.runs, 9);
  EXPECT_EQ(counts.statuses, (std::map<std::string, std::int64_t>{{"done", 7}, {"failed", 2}}));
  EXPECT_EQ(counts.reason, "");
  file.complete(5, "enough");
  counts = results.counts();
  EXPECT_EQ(counts.runs, 5);
  EXPECT_EQ(counts.reason, "enough");
}

}  // namespace
}  // namespace flexura
