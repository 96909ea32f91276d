#include "flexura/campaign/campaign_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "flexura/campaign/campaign_report.h"
#include "tests/support/campaign_files.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

// y = x1 + x2 / 2 of uniform numbers: x1 explains 1 / (1 + 1/4) of the variance, of which ten groups miss 1
// %.
TEST(CampaignSensitivity, IsTheShareOfTheVariance) {
  for_random_cases(10, [](TestRandom& random) {
    CampaignColumn a{"a", {}, {}, {}}, b{"b", {}, {}, {}}, none{"none", {}, {}, {}}, y{"y", {}, {}, {}},
        square{"square", {}, {}, {}};
    for (int i = 0; i < 20000; ++i) {
      a.values.push_back(random.uniform(-1, 1));
      b.values.push_back(random.uniform(-1, 1));
      none.values.push_back(random.uniform(-1, 1));
      y.values.push_back(a.values.back() + b.values.back() / 2);
      square.values.push_back(a.values.back() * a.values.back());
    }
    EXPECT_NEAR(sensitivity_of(y, a)->share, 0.8 * 0.99, 0.02);
    EXPECT_NEAR(sensitivity_of(y, b)->share, 0.2 * 0.99, 0.03);
    EXPECT_NEAR(sensitivity_of(y, none)->share, 0, 0.01);
    EXPECT_NEAR(sensitivity_of(y, none)->rank_correlation, 0, 0.05);
    EXPECT_EQ(sensitivity_of(a, a)->rank_correlation, 1);
    // Not monotonic: no rank correlation, but nearly all of the variance.
    EXPECT_NEAR(sensitivity_of(square, a)->rank_correlation, 0, 0.05);
    EXPECT_GT(sensitivity_of(square, a)->share, 0.9);
  });
}

TEST(CampaignSensitivity, NeedsRunsThatVary) {
  const CampaignColumn constant{"c", std::vector<double>(30, 1.0), {}, {}};
  CampaignColumn rising{"r", {}, {}, {}};
  for (int i = 0; i < 30; ++i) rising.values.push_back(i < 15 ? std::nan("") : i);
  EXPECT_FALSE(sensitivity_of(constant, constant));
  EXPECT_FALSE(sensitivity_of(rising, rising)) << "15 runs";
}

TEST(CampaignWorstRuns, AreTheFarthestFromTheBounds) {
  const CampaignColumn column{"c", {1, 5, -3, 2, std::nan("")}, {}, {true, false, false, true, false}};
  EXPECT_THAT(worst_runs(column, {.key = "c", .name = {}, .min = 0, .max = 3}, 9), ElementsAre(4, 2, 1));
  const CampaignColumn without{"c", {1, 5, -3, 2, std::nan("")}, {}, {}};
  EXPECT_THAT(worst_runs(without, {.key = "c", .name = {}, .min = {}, .max = {}}, 2), ElementsAre(1, 3));
}

// An error of 0 in each run is no "false".
TEST(CampaignSummary, NumbersAreNoTruthValues) {
  const CampaignFolder folder(std::string(bow_campaign_text) + "[[measure]]\nkey = \"time\"\n");
  const Campaign campaign = folder.campaign({"samples=2"});
  {
    CampaignFile file(folder.path("a.db"), campaign);
    std::vector<CampaignRow> rows;
    for (std::int64_t id = 0; id < campaign.design().runs(); ++id)
      rows.push_back({.id = id,
                      .seed = campaign.design().seed(id),
                      .parameters = campaign.design().values(id),
                      .status = "done",
                      .error = {},
                      .measures = {{0.0, {}}, text_node("done"), {true, {}}, {0.0, {}}},
                      .seconds = 1});
    file.add(rows);
  }
  CampaignResults results(folder.path("a.db"));
  const CampaignSummary summary = summary_of(results);
  EXPECT_EQ(summary.measures[0].successes.size(), summary.ids.size()) << "it has a bound";
  EXPECT_TRUE(summary.measures[1].successes.empty()) << "a text";
  EXPECT_EQ(summary.measures[2].successes, std::vector<bool>(summary.ids.size(), true));
  EXPECT_TRUE(summary.measures[3].successes.empty()) << "a number";
}

TEST(CampaignReport, EscapesTextsAndLoadsNothing) {
  const CampaignFolder folder(std::string("title = \"<b>&\"\n") + bow_campaign_text);
  const Campaign campaign = folder.campaign();
  (void)rows_of(campaign, folder.path("a.db"), 2);
  CampaignResults results(folder.path("a.db"));
  const std::string page = campaign_html(results, "a.db");
  EXPECT_THAT(page, HasSubstr("&lt;b&gt;&amp;"));
  EXPECT_THAT(page, Not(HasSubstr("<b>")));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, HasSubstr("60 of 60"));
  // With the interval of the share.
  const auto done = summary_of(results).statuses.at("done");
  const ConfidenceInterval interval = wilson_interval(done, 60);
  EXPECT_THAT(
      page, HasSubstr(fmt::format("{}: {:.1f} % ({:.1f} to {:.1f} %)", done, static_cast<double>(done) / 0.6,
                                  100 * interval.low, 100 * interval.high)));
}

}  // namespace
}  // namespace flexura
