#include "tests/support/campaign_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST_F(CampaignProgram, RunsExportsReportsAndReplays) {
  const Ended plan = run("campaign campaign.toml --dry-run");
  EXPECT_EQ(plan.status, 0);
  EXPECT_THAT(plan.out, StartsWith("runs: 60\ntime: about "));
  const Ended first = run("campaign campaign.toml --workers 2");
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(first.out, "results: results/campaign.db\ncomplete: all 60 runs are done\n");
  EXPECT_THAT(run("campaign campaign.toml").out, HasSubstr("all 60 runs were done before"));
  EXPECT_EQ(run("export results/campaign.db --to csv").out, "table: results/campaign.csv\n");
  const std::string table = read_text_file(path("results/campaign.csv"), 1 << 20);
  EXPECT_THAT(table,
              StartsWith("id,seed,status,error,seconds,arm.section.0.length_mm,task.0.to.bends_deg.1.1,"
                         "height,outcome,of_summary\n0,"));
  EXPECT_EQ(std::ranges::count(table, '\n'), 61);
  EXPECT_EQ(run("export results/campaign.db --to csv").status, 2);
  EXPECT_EQ(run("export results/campaign.db --to mp4").status, 2);
  EXPECT_EQ(run("report results/campaign.db").out, "report: results/campaign.html\n");
  EXPECT_THAT(read_text_file(path("results/campaign.html"), 1 << 24),
              HasSubstr("flexura run --from results/campaign.db --row "));
  // A replay has the measures of its row.
  CampaignResults results(path("results/campaign.db"));
  std::vector<CampaignRow> rows;
  results.for_each([&](const CampaignRow& one) { rows.push_back(one); });
  int replayed = 0;
  for (const CampaignRow& one : rows) {
    if (one.id % 9 != 0) continue;
    const Ended replay = run("run --json --from results/campaign.db --row " + std::to_string(one.id));
    if (one.status == "error") {
      EXPECT_EQ(replay.status, 2);
      continue;
    }
    const Node summary = parse_json(replay.out, "summary");
    EXPECT_EQ(*find_path(summary, "tip.position.1")->as<double>(), *one.measures[0].as<double>());
    EXPECT_EQ(*find_path(summary, "outcome")->as<std::string>(), one.status);
    EXPECT_TRUE(
        std::filesystem::exists(path("results/campaign-row-" + std::to_string(one.id) + "/log.mcap")));
    ++replayed;
  }
  EXPECT_GE(replayed, 4);
  EXPECT_THAT(run("run --from results/campaign.db --row 60").err,
              HasSubstr("--row: 60: the campaign has 60 runs"));
  EXPECT_EQ(run("run --from bow.toml --row 1").status, 2);
  EXPECT_EQ(run("run").status, 2);
  EXPECT_EQ(run("report bow.toml").status, 2);
}

TEST_F(CampaignProgram, HasTheSameRowsIfItIsSafeFromPowerLoss) {
  EXPECT_EQ(run("campaign campaign.toml --out usual.db").status, 0);
  const Ended safe = run("campaign campaign.toml --out safe.db --safe-from-power-loss");
  EXPECT_EQ(safe.status, 0) << safe.err;
  EXPECT_THAT(safe.out, HasSubstr("complete: all 60 runs are done"));
  EXPECT_EQ(rows_text(path("safe.db")), rows_text(path("usual.db")));
}

TEST_F(CampaignProgram, IsReportedAndExportedWhileItRuns) {
  // Far more runs than finish before it is stopped.
  const pid_t child = start("campaign campaign.toml --set samples=1000000 --out a.db", path("out"));
  std::int64_t rows = 0;
  while (rows < 40 && ::kill(child, 0) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    try {
      rows = CampaignResults(path("a.db")).counts().runs;
    } catch (const InputError&) {
      // The file is not there yet.
    }
  }
  ASSERT_GE(rows, 40);
  for (const char* command : {"report a.db", "export a.db --to csv --out a.csv"})
    EXPECT_EQ(wait(start(command, path("other_out"), path("other_err"))).status, 0) << command;
  const std::string page = read_text_file(path("a.html"), 1 << 26);
  EXPECT_THAT(page, HasSubstr("The campaign is not complete."));
  EXPECT_THAT(page, HasSubstr("of 4000000"));
  EXPECT_GT(std::ranges::count(read_text_file(path("a.csv"), 1 << 28), '\n'), rows);
  ::kill(child, SIGINT);
  EXPECT_EQ(wait(child).status, 130);
}

TEST_F(CampaignProgram, PausesWhenItsTimeIsOver) {
  const Ended paused = run("campaign campaign.toml --set samples=100000 --set stop.time=0.2");
  EXPECT_EQ(paused.status, 1);
  EXPECT_THAT(paused.out, HasSubstr("not complete: the time limit of 0.2 s is reached"));
}

TEST_F(CampaignProgram, StopsOnASignalAndGoesOn) {
  const pid_t child = start("campaign campaign.toml --set samples=2000 --out a.db", path("out"));
  std::this_thread::sleep_for(std::chrono::milliseconds(150));
  ::kill(child, SIGINT);
  const Ended ended = wait(child);
  EXPECT_TRUE(ended.status == 130 || ended.status == 0) << ended.status;
  EXPECT_EQ(run("campaign campaign.toml --set samples=2000 --out a.db").status, 0);
  EXPECT_EQ(std::ranges::count(rows_text(path("a.db")), '\n'), 8000);
}

TEST_F(CampaignProgram, RanksOfMpiComputeTheSameRows) {
  if (!has_mpi()) GTEST_SKIP() << "skipped: needs MPI";
  const std::string campaign = "campaign campaign.toml --set samples=300 --out ";
  ASSERT_EQ(run(campaign + "threads.db --workers 2").status, 0);
  const Ended two = run_ranks(2, campaign + "two.db");
  EXPECT_EQ(two.status, 0) << two.err;
  EXPECT_EQ(rows_text(path("two.db")), rows_text(path("threads.db")));
  EXPECT_EQ(run_ranks(3, campaign + "three.db --workers 2").status, 0);
  EXPECT_EQ(rows_text(path("three.db")), rows_text(path("threads.db")));
  EXPECT_EQ(run_ranks(2, campaign + "two.db").status, 0);
  // Bad input ends all ranks.
  const Ended refused = run_ranks(2, campaign + "two.db --set seed=9");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("the results of another campaign"));
  EXPECT_EQ(run_ranks(2, "campaign gone.toml").status, 2);
}

TEST_F(CampaignProgram, LosesNoRunWhenItIsKilled) { check_kills(20); }

}  // namespace
}  // namespace flexura
