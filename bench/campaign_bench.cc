// What a campaign costs besides its runs: runs of 10 ms of a processor, written into a file of SQLite.
#include <benchmark/benchmark.h>
#include <gtest/gtest.h>

#include <ctime>
#include <filesystem>
#include <string>

#include "tests/support/campaign_files.h"

namespace flexura {
namespace {

double processor_time(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// A run that takes `seconds` of a processor.
CampaignRow busy_run(const Campaign& campaign, std::int64_t id, double seconds) {
  const double end = processor_time(CLOCK_THREAD_CPUTIME_ID) + seconds;
  while (processor_time(CLOCK_THREAD_CPUTIME_ID) < end) {
  }
  return {.id = id,
          .seed = campaign.design().seed(id),
          .parameters = campaign.design().values(id),
          .status = "done",
          .error = {},
          .measures = {{0.5, {}}, text_node("done"), {id, {}}},
          .seconds = seconds};
}

// The counters are per run: time of a processor besides the runs, as a share of the runs, and wall time.
void campaign_overhead(benchmark::State& state) {
  constexpr double seconds = 0.01;
  const CampaignFolder folder;
  const Campaign campaign = folder.campaign({"samples=125"});
  const auto threads = static_cast<std::size_t>(state.range(0));
  const auto runs = static_cast<double>(campaign.design().runs());
  double used = 0;
  for (auto _ : state) {
    std::filesystem::remove(folder.path("a.db"));
    CampaignFile file(folder.path("a.db"), campaign);
    ThreadEngine engine(
        [&](std::int64_t id, Progress&) { return std::optional(busy_run(campaign, id, seconds)); }, threads);
    NoProgress progress;
    const double start = processor_time(CLOCK_PROCESS_CPUTIME_ID);
    (void)run_campaign(campaign, file, engine, progress);
    used += processor_time(CLOCK_PROCESS_CPUTIME_ID) - start;
  }
  const double all = runs * static_cast<double>(state.iterations());
  state.counters["overhead_percent"] = 100 * (used / all - seconds) / seconds;
  state.counters["runs"] = benchmark::Counter(all, benchmark::Counter::kIsRate);
}
BENCHMARK(campaign_overhead)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime()->MinTime(5);

// Runs without work: the largest rate of rows.
void campaign_rows(benchmark::State& state) {
  const CampaignFolder folder;
  const Campaign campaign = folder.campaign({"samples=" + std::to_string(state.range(0) / 4)});
  for (auto _ : state) {
    std::filesystem::remove(folder.path("a.db"));
    CampaignFile file(folder.path("a.db"), campaign);
    ThreadEngine engine([&](std::int64_t id, Progress&) { return std::optional(busy_run(campaign, id, 0)); },
                        2);
    NoProgress progress;
    (void)run_campaign(campaign, file, engine, progress);
  }
  state.counters["rows"] = benchmark::Counter(
      static_cast<double>(campaign.design().runs() * state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(campaign_rows)->Arg(10000)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace flexura
