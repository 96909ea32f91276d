#include "flexura/campaign/campaign_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "flexura/campaign/braces.h"
#include "flexura/store/toml.h"
#include "tests/support/campaign_files.h"

namespace flexura {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string grouped_text = std::string("description = \"About | **bows**.\"\n") + bow_campaign_text;

TEST(CampaignGroups, HaveTheStatisticsOfTheirRows) {
  const CampaignFolder folder(grouped_text);
  (void)rows_of(folder.campaign(), folder.path("a.db"), 2);
  CampaignResults results(folder.path("a.db"));
  // From the rows, without the code under test.
  std::map<double, std::vector<double>> heights;
  std::map<double, int> runs, good;
  results.for_each([&](const CampaignRow& row) {
    const double bend = static_cast<double>(*row.parameters[1].as<std::int64_t>());
    ++runs[bend];
    if (row.status != "done") return;
    heights[bend].push_back(*row.measures[0].as<double>());
    if (heights[bend].back() >= 0.2) ++good[bend];
  });
  const CampaignSummary summary = summary_of(results);
  const CampaignGroups groups = groups_of(summary, results.campaign().config());
  EXPECT_THAT(groups.parameters, ElementsAre("task.0.to.bends_deg.1.1"));
  const ChapterTable table = group_table(groups, summary, results.campaign().config());
  EXPECT_THAT(table.columns,
              ElementsAre("task.0.to.bends_deg.1.1", "runs", "done", "height: median / 95 % / largest",
                          "height: within the bounds", "of_summary: median / 95 % / largest"));
  ASSERT_EQ(table.rows.size(), 2);
  for (const std::vector<std::string>& row : table.rows) {
    std::vector<double>& values = heights[std::stod(row[0])];
    std::ranges::sort(values);
    EXPECT_EQ(row[1], std::to_string(runs[std::stod(row[0])]));
    EXPECT_EQ(row[2], std::to_string(values.size()));
    EXPECT_EQ(row[4], std::to_string(good[std::stod(row[0])]) + " of " + row[1]);
    if (values.empty()) {
      EXPECT_EQ(row[3], "-");
      continue;
    }
    // At least half of the values are not above the median, and at least half are not below it.
    const double median = std::stod(row[3]);
    const auto below = std::ranges::count_if(values, [&](double v) { return v < median * 0.99; });
    const auto above = std::ranges::count_if(values, [&](double v) { return v > median * 1.01; });
    EXPECT_LE(2 * below, std::ssize(values));
    EXPECT_LE(2 * above, std::ssize(values));
  }
  const std::string page = campaign_markdown(results);
  EXPECT_THAT(page,
              testing::StartsWith("# campaign\n\nAbout | **bows**.\n\n| task.0.to.bends_deg.1.1 | runs |"));
  EXPECT_THAT(page, HasSubstr("\n| reason of a run that is not done | runs |\n| --- | --- |\n"));
}

TEST(CampaignGroups, CountReasonsWithoutTheirNumbers) {
  CampaignSummary summary;
  summary.ids = {0, 1, 2}, summary.is_done = {true, false, false}, summary.reasons = {0, 1, 1};
  summary.reason_kinds = {"", "bend of ... deg"};
  const CampaignGroups one{{}, {{{}, {0, 1, 2}}}};
  EXPECT_THAT(reason_table(one, summary).rows, ElementsAre(ElementsAre("bend of ... deg", "2")));
  const CampaignGroups two{{"law"}, {{{"a"}, {0, 1}}, {{"b"}, {2}}}};
  EXPECT_THAT(reason_table(two, summary).rows, ElementsAre(ElementsAre("bend of ... deg", "a: 1; b: 1")));
}

TEST(CampaignSummary, ReplacesNumbersOfReasons) {
  const CampaignFolder folder(grouped_text);
  (void)rows_of(folder.campaign(), folder.path("a.db"), 1);
  CampaignResults results(folder.path("a.db"));
  const CampaignSummary summary = summary_of(results);
  ASSERT_GE(summary.reason_kinds.size(), 2U);
  EXPECT_LE(summary.reason_kinds.size(), 6U) << "equal reasons with other numbers are one kind";
  for (std::size_t i = 0; i < summary.ids.size(); ++i)
    EXPECT_EQ(summary.reasons[i] == 0, static_cast<bool>(summary.is_done[i]));
}

TEST(Braces, StandForAllCombinations) {
  EXPECT_THAT(expanded_braces("a.{0,1}.{x,y}", 10), ElementsAre("a.0.x", "a.0.y", "a.1.x", "a.1.y"));
  EXPECT_THAT(expanded_braces("plain", 10), ElementsAre("plain"));
  EXPECT_THAT(expanded_braces("{a}", 10), ElementsAre("a"));
  EXPECT_THAT(expanded_braces("a{,b}c", 10), ElementsAre("ac", "abc"));
  EXPECT_THAT(expanded_braces("}{", 10), ElementsAre("}{"));
  EXPECT_THAT(expanded_braces("{0,1,2}{0,1,2}", 8), IsEmpty());
}

std::string fault_of_document(const std::string& text) {
  try {
    (void)with_expanded_parameters(parse_toml(text, "c.toml"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(Braces, MakeParametersWithTheirNames) {
  const Node document = with_expanded_parameters(
      parse_toml("[[parameter]]\npath = \"a.{0,1}.b\"\nalso = [\"c.{0,1}\"]\nname = \"{p,q}\"\nlow = 1\n"
                 "[[parameter]]\npath = \"d\"\n",
                 "c.toml"));
  const auto& list = *document.find("parameter")->as<Node::Array>();
  ASSERT_EQ(list.size(), 3);
  EXPECT_EQ(*list[1].find("path")->as<std::string>(), "a.1.b");
  EXPECT_EQ(*list[1].find("name")->as<std::string>(), "q");
  EXPECT_EQ(*list[1].find("also")->as<Node::Array>()->front().as<std::string>(), "c.1");
  EXPECT_EQ(*list[2].find("path")->as<std::string>(), "d");
  EXPECT_EQ(fault_of_document("[[parameter]]\npath = \"a.{0,1}\"\nname = \"x\"\n"),
            "c.toml:3:8: \"x\" expands to 1 texts, but `path` expands to 2: expected equal lists in braces");
  std::string many = "{0";
  for (int i = 1; i < 30; ++i) many += "," + std::to_string(i);
  many += "}";
  EXPECT_THAT(fault_of_document("[[parameter]]\npath = \"" + many + many + "\"\n"),
              HasSubstr("expected at most 500 parameters"));
}

TEST(Campaign, VariesNumbersAboutTheirValues) {
  const CampaignFolder folder(
      "experiment = \"bow.toml\"\nsamples = 20\n[[parameter]]\nkind = \"uniform\"\n"
      "path = \"arm.section.{0,1}.length\"\noffset = true\nlow = -0.01\nhigh = 0.01\n"
      "[[parameter]]\nkind = \"list\"\npath = \"task.0.duration\"\nvalues = [1, 2]\ndrawn = true\n"
      "[[measure]]\nkey = \"length\"\nscale = -1000\nabsolute = true\n");
  const Campaign campaign = folder.campaign();
  EXPECT_EQ(campaign.design().runs(), 20);
  std::map<double, int> durations;
  for (std::int64_t id = 0; id < 20; ++id) {
    const std::vector<Node> values = campaign.design().values(id);
    const Experiment experiment = campaign.experiment(id);
    EXPECT_EQ(experiment.arm.section[0].length, 0.3 + *values[0].as<double>());
    EXPECT_EQ(experiment.arm.section[1].length, 0.25 + *values[1].as<double>());
    ++durations[static_cast<double>(*values[2].as<std::int64_t>())];
    NoProgress progress;
    EXPECT_NEAR(*execute_run(campaign, id, progress)->measures[0].as<double>(),
                1000 * (experiment.arm.section[0].length + experiment.arm.section[1].length), 1e-9);
  }
  EXPECT_EQ(durations.size(), 2) << "both values are drawn";
  const CampaignFolder without(
      "experiment = \"bow.toml\"\n[[parameter]]\nkind = \"uniform\"\npath = \"clock.step\"\noffset = true\n"
      "low = 0\nhigh = 1\n");
  try {
    (void)without.campaign();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("campaign.toml:4:8: clock.step: expected a number in the experiment "
                                        "file, to which the offset is added"));
  }
}

TEST(Campaign, NoticesThatNamedFilesHaveChanged) {
  const CampaignFolder folder(
      "experiment = \"bow.toml\"\nset = [\"task=[{kind='keyframes', file='way.csv'}]\"]\n");
  const std::string way = "time,bend_x_1,bend_y_1,bend_x_2,bend_y_2\n0,0,0,0,0\n1,0.5,0,0,0.5\n";
  folder.write("way.csv", way);
  const Campaign first = folder.campaign();
  const Campaign restored = Campaign::from_record(first.record(), "a.db");
  EXPECT_NO_THROW(restored.check_named_files("a.db"));
  folder.write("way.csv", way + "2,0.5,0,0,0.5\n");
  EXPECT_NE(folder.campaign().identity(), first.identity());
  const auto fault = [&]() -> std::string {
    try {
      restored.check_named_files("a.db");
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(fault(), "a.db: the experiment names " + folder.path("way.csv") +
                         ", which has changed: expected the file of the campaign");
  std::filesystem::remove(folder.path("way.csv"));
  EXPECT_THAT(fault(), HasSubstr("which is missing"));
  folder.write("way.csv", way);
  EXPECT_EQ(fault(), "none");
}

}  // namespace
}  // namespace flexura
