#include "flexura/campaign/campaign.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "flexura/campaign/campaign_driver.h"
#include "flexura/campaign/statistics.h"
#include "flexura/experiment/run.h"
#include "tests/support/campaign_files.h"
#include "tests/support/full_disk.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

std::string fault_of_campaign(const std::string& text, const std::vector<std::string>& sets = {}) {
  const CampaignFolder folder(text);
  try {
    (void)folder.campaign(sets);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Campaign, ErrorsHaveTheirPlaces) {
  const std::string start = "experiment = \"bow.toml\"\n";
  const auto parameter = [&](const std::string& lines) { return start + "[[parameter]]\n" + lines; };
  EXPECT_THAT(fault_of_campaign("experiment = \"gone.toml\"\n"),
              HasSubstr("campaign.toml:1:14: experiment = \"gone.toml\": expected an experiment file"));
  EXPECT_THAT(fault_of_campaign(parameter("kind = \"uniform\"\npath = \"arm.sektion\"\nlow = 1\nhigh = 2\n")),
              HasSubstr("campaign.toml:4:8: arm.sektion: unknown key; did you mean \"section\"?"));
  EXPECT_THAT(fault_of_campaign(parameter("kind = \"uniform\"\npath = \"clock.step\"\nlow = 2\nhigh = 1\n")),
              HasSubstr("campaign.toml:6:1: parameter[0].high: 1: expected at least `low`, 2"));
  EXPECT_THAT(fault_of_campaign(parameter("kind = \"normal\"\npath = \"clock.step\"\nmean = 1\nsigma = 0\n")),
              HasSubstr("campaign.toml:6:9: parameter[0].sigma = 0: expected a number above 0"));
  EXPECT_THAT(fault_of_campaign(parameter("kind = \"list\"\npath = \"seed\"\nvalues = [1]\n")),
              HasSubstr("campaign.toml:4:1: parameter[0].path: each run has a seed"));
  EXPECT_THAT(fault_of_campaign(parameter("kind = \"choice\"\npath = \"arm.kind\"\nchoices = [\"[1\"]\n")),
              HasSubstr("campaign.toml:5:12: parameter[0].choices[0]: "));
  EXPECT_THAT(fault_of_campaign(start + "[[measure]]\nkey = \"ID\"\n"),
              HasSubstr("measure[0]: the name \"ID\" is already used"));
  EXPECT_THAT(fault_of_campaign(start + "[[measure]]\nkey = \"tip\"\n[[stop.precision]]\nmeasure = \"top\"\n"
                                        "half_width = 1\n"),
              HasSubstr("campaign.toml:5:1: stop.precision[0].measure: no measure has the name \"top\"; did "
                        "you mean \"tip\"?"));
  EXPECT_THAT(fault_of_campaign(start, {"samples=3"}),
              HasSubstr("samples: 3: no parameter has a distribution"));
  EXPECT_THAT(fault_of_campaign(start, {"set=[\"tusk=1\"]"}), HasSubstr("tusk: unknown key"));
  EXPECT_THAT(fault_of_campaign(start, {"repeats=0"}),
              HasSubstr("--set repeats=0:1:9: repeats = 0: expected"));
}

TEST(Campaign, RunsDependOnSeedAndNumberAlone) {
  const CampaignFolder folder;
  const Campaign all = folder.campaign(), first = folder.campaign({"stop.runs=10"}),
                 other = folder.campaign({"seed=8"});
  EXPECT_EQ(all.design().runs(), 60);
  EXPECT_EQ(first.design().runs(), 10);
  int equal = 0;
  for (std::int64_t id = 0; id < 10; ++id) {
    EXPECT_EQ(all.design().seed(id), first.design().seed(id));
    EXPECT_EQ(*all.design().values(id)[0].as<double>(), *first.design().values(id)[0].as<double>());
    if (*all.design().values(id)[0].as<double>() == *other.design().values(id)[0].as<double>()) ++equal;
    EXPECT_NE(all.design().seed(id), other.design().seed(id));
    EXPECT_EQ(all.experiment(id).seed, all.design().seed(id));
  }
  EXPECT_EQ(equal, 0);
  // Repeats, then combinations, then samples.
  const auto value = [&](std::int64_t id, std::size_t i) {
    return measured_number(all.design().values(id)[i]).value();
  };
  EXPECT_EQ(value(0, 1), 90);
  EXPECT_EQ(value(1, 1), 90);
  EXPECT_EQ(value(2, 1), 130);
  EXPECT_EQ(value(0, 0), value(3, 0));
  EXPECT_NE(value(0, 0), value(4, 0));
}

TEST(Campaign, RowsAreEqualForAnyNumberOfWorkers) {
  const CampaignFolder folder;
  const Campaign campaign = folder.campaign();
  const std::string rows = rows_of(campaign, folder.path("1.db"), 1);
  EXPECT_EQ(std::ranges::count(rows, '\n'), 60);
  for (const char* status : {"\"done\"", "\"unsafe\"", "\"error\""}) EXPECT_THAT(rows, HasSubstr(status));
  EXPECT_THAT(rows, HasSubstr("arm.section[0].length_mm = -"));
  EXPECT_EQ(rows, rows_of(campaign, folder.path("2.db"), 2));
  EXPECT_EQ(rows, rows_of(campaign, folder.path("4.db"), 4));
}

// The run's own summary has the same values, with files and without.
TEST(Campaign, MeasuresAreThoseOfARecordedRun) {
  const CampaignFolder folder;
  const Campaign campaign = folder.campaign();
  NoProgress progress;
  const auto row = execute_run(campaign, 8, progress);
  ASSERT_TRUE(row);
  EXPECT_EQ(row->status, "done");
  const auto results = folder.path("results");
  std::filesystem::create_directory(results);
  const RunResult run = run_experiment(campaign.experiment(8), results, progress);
  EXPECT_EQ(*row->measures[0].as<double>(), *find_path(run.summary, "tip.position.1")->as<double>());
  EXPECT_EQ(*row->measures[2].as<std::int64_t>(), row->seed);
}

TEST(Campaign, IsRestoredFromItsRecord) {
  const CampaignFolder folder;
  const Campaign campaign = folder.campaign();
  const Campaign restored = Campaign::from_record(campaign.record(), "record");
  EXPECT_EQ(restored.record(), campaign.record());
  for (const std::int64_t id : {0, 5, 30}) {
    EXPECT_EQ(restored.design().seed(id), campaign.design().seed(id));
    NoProgress progress;
    EXPECT_EQ(execute_run(restored, id, progress)->error, execute_run(campaign, id, progress)->error);
  }
  EXPECT_THROW((void)Campaign::from_record("{}", "record"), InputError);
}

TEST(CampaignFile, IsRefusedToOthers) {
  const CampaignFolder folder;
  const Campaign campaign = folder.campaign(), other = folder.campaign({"samples=16"});
  const std::string path = folder.path("a.db");
  const auto fault = [&](const Campaign& one, const std::string& file) -> std::string {
    try {
      const CampaignFile opened(file, one);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  {
    const CampaignFile open(path, campaign);
    EXPECT_EQ(fault(campaign, path), path + ": another campaign writes this file: expected another --out");
  }
  EXPECT_EQ(fault(campaign, path), "none");
  EXPECT_THAT(fault(other, path), HasSubstr("a.db: the results of another campaign"));
  folder.write("bow.toml", std::string(bow_text) + "# Only a comment.\n");
  EXPECT_EQ(fault(folder.campaign(), path), "none");
  folder.write("bow.toml", "title = \"new\"\n" + std::string(bow_text));
  EXPECT_THAT(fault(folder.campaign(), path), HasSubstr("or its experiment has changed"));
  EXPECT_THAT(fault(campaign, folder.path("bow.toml")), HasSubstr("not the results of a campaign"));
  EXPECT_THROW(CampaignResults(folder.path("bow.toml")), InputError);
  EXPECT_THROW(CampaignResults(folder.path("gone.db")), InputError);
  folder.write("empty.db", "");
  EXPECT_THROW(CampaignResults(folder.path("empty.db")), InputError);
}

// Executes a campaign whose runs are made up; the engine stops it after some rows.
class InterruptedEngine : public CampaignEngine {
 public:
  InterruptedEngine(RunFunction run, std::size_t rows, TestRandom& random)
      : run_(std::move(run)), rows_(rows), random_(random) {}
  [[nodiscard]] std::size_t workers() const override { return 1; }
  // Finishes the dealt runs in a random order.
  void execute(const EngineJob& job) override {
    std::vector<std::int64_t> dealt;
    while (rows_ > 0) {
      while (dealt.size() < 10) {
        const auto id = job.next();
        if (!id) break;
        dealt.push_back(*id);
      }
      if (dealt.empty()) return;
      const auto chosen = dealt.begin() + random_.integer(0, static_cast<int>(dealt.size()) - 1);
      NoProgress progress;
      const std::vector<CampaignRow> rows{*run_(*chosen, progress)};
      dealt.erase(chosen);
      --rows_;
      if (!job.done(rows)) return;
    }
    job.done({});
  }

 private:
  RunFunction run_;
  std::size_t rows_;
  TestRandom& random_;
};

// Returns a made-up row whose height is a function of its number.
CampaignRow made_up(const Campaign& campaign, std::int64_t id) {
  TestRandom random(static_cast<std::uint64_t>(id));
  const double height = 0.2 + 0.1 * normal_number(random);
  return {.id = id,
          .seed = campaign.design().seed(id),
          .parameters = campaign.design().values(id),
          .status = "done",
          .error = {},
          .measures = {{height, {}}, text_node("done"), {id, {}}},
          .seconds = 0.1};
}

TEST(Campaign, GoesOnAfterInterruptionsAndStopsAtTheSameRun) {
  const CampaignFolder folder(std::string(bow_campaign_text) +
                              "[[stop.precision]]\nmeasure = \"height\"\nhalf_width = 0.03\n"
                              "[[stop.precision]]\nmeasure = \"height\"\nof = \"rate\"\nhalf_width = 0.1\n");
  const Campaign campaign = folder.campaign({"samples=200"});
  const auto run = [&](std::int64_t id, Progress&) { return std::optional(made_up(campaign, id)); };
  // The rule, evaluated anew for each number of runs.
  std::int64_t expected = 0;
  double sum = 0, squares = 0;
  std::int64_t successes = 0;
  while (true) {
    const double height = *made_up(campaign, expected++).measures[0].as<double>();
    sum += height, squares += height * height, successes += height >= 0.2 ? 1 : 0;
    const auto n = static_cast<double>(expected);
    const double half = 1.96 * std::sqrt((squares - sum * sum / n) / (n - 1) / n);
    const ConfidenceInterval rate = wilson_interval(successes, expected);
    if (expected >= 30 && half <= 0.03 && rate.high - rate.low <= 0.2) break;
  }
  ASSERT_GT(expected, 40);
  std::string undisturbed;
  int number = 0;
  for_random_cases(12, [&](TestRandom& random) {
    const std::string path = folder.path(std::to_string(number++) + ".db");
    CampaignEnd end;
    int calls = 0;
    while (!end.is_complete && ++calls < 1000) {
      CampaignFile file(path, campaign);
      InterruptedEngine engine(run, static_cast<std::size_t>(random.integer(1, 40)), random);
      NoProgress progress;
      end = run_campaign(campaign, file, engine, progress);
    }
    EXPECT_EQ(end.runs, expected);
    const std::string rows = rows_text(path);
    EXPECT_EQ(std::ranges::count(rows, '\n'), expected);
    if (undisturbed.empty()) undisturbed = rows;
    EXPECT_EQ(rows, undisturbed);
  });
}

TEST(Campaign, GoesOnAfterAFullDisk) {
  const CampaignFolder folder;
  const Campaign campaign = folder.campaign({"samples=300"});
  const auto run = [&](std::int64_t id, Progress&) { return std::optional(made_up(campaign, id)); };
  const std::string path = folder.path("a.db");
  NoProgress progress;
  int failures = 0;
  bool is_complete = false;
  TestRandom random(1);
  for (rlim_t size = 8 << 10; !is_complete; size += 4 << 10) {
    ASSERT_LT(size, 4 << 20);
    try {
      const FullDisk full(size);
      CampaignFile file(path, campaign);
      InterruptedEngine engine(run, 37, random);
      is_complete = run_campaign(campaign, file, engine, progress).is_complete;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("a.db: "));
      ++failures;
    }
  }
  EXPECT_GT(failures, 3);
  EXPECT_EQ(std::ranges::count(rows_text(path), '\n'), 1200);
}

TEST(Wilson, HasThePublishedIntervals) {
  // R. Newcombe, Statistics in Medicine 17 (1998), table I, method 3.
  const auto check = [](std::int64_t successes, std::int64_t count, double low, double high) {
    const ConfidenceInterval interval = wilson_interval(successes, count);
    EXPECT_NEAR(interval.low, low, 5e-5);
    EXPECT_NEAR(interval.high, high, 5e-5);
  };
  check(81, 263, 0.2553, 0.3662);
  check(15, 148, 0.0624, 0.1605);
  check(0, 20, 0, 0.1611);
  check(1, 29, 0.0061, 0.1718);
}

TEST(FindPath, FindsNumbersOfLists) {
  const Node root = parse_json(R"({"a":[{"b":1},{"b":[2,3]}],"c":true})", "test");
  EXPECT_EQ(*find_path(root, "a.1.b.0")->as<std::int64_t>(), 2);
  EXPECT_EQ(*find_path(root, "a[1].b[1]")->as<std::int64_t>(), 3);
  EXPECT_TRUE(*find_path(root, "c")->as<bool>());
  for (const char* path : {"", "a.2", "a.-1", "a.x", "c.d", "a..b", "a.1.b.0.0"})
    EXPECT_EQ(find_path(root, path), nullptr) << path;
}

}  // namespace
}  // namespace flexura
