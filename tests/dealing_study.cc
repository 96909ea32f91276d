// Simulates how rank 0 of a campaign deals runs to many ranks: dealing_study [MESSAGE_US]. The dealing, the
// rows and the results file are the real ones; only the other ranks, their runs and the network are
// simulated. The virtual time goes on by the measured time of what rank 0 computes, by MESSAGE_US
// microseconds for each message that it sends or receives, and by jumps to the next message while it waits.
// See docs/studies/dealing.md.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <optional>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/campaign/campaign.h"
#include "flexura/campaign/campaign_driver.h"
#include "flexura/campaign/campaign_file.h"
#include "flexura/campaign/rank_dealer.h"
#include "flexura/campaign/row_text.h"
#include "tests/support/campaign_files.h"

namespace flexura {
namespace {

// Durations of runs vary by 20 % around their mean, so that ranks do not answer in step.
class SimulatedRanks : public RankLink {
 public:
  SimulatedRanks(const CampaignRow& row, std::size_t ranks, double run_time, double message_time)
      : row_(row), run_time_(run_time), message_time_(message_time), free_at_(ranks, 0.0) {}

  void deal(std::size_t rank, std::int64_t id) override {
    const double spread =
        0.8 + 0.4 * static_cast<double>((static_cast<std::uint64_t>(id) * 2654435761U) % 1000) / 1000;
    double& free = free_at_.at(rank - 1);
    now_ += message_time_;
    free = std::max(free, time()) + spread * run_time_;
    coming_.push({free, {rank, id}});
  }
  void end(std::size_t /*rank*/) override {}
  [[nodiscard]] std::optional<RankMessage> arrived() override {
    if (coming_.empty() || coming_.top().first > time()) return std::nullopt;
    const auto [rank, id] = coming_.top().second;
    coming_.pop();
    // The other rank makes the text.
    const auto start = Clock::now();
    row_.id = id;
    std::string text = row_text(row_);
    paused_ += Clock::now() - start;
    now_ += message_time_;
    return RankMessage{RankMessage::Kind::row, rank, std::move(text)};
  }

  // Waits for the next message.
  void wait() {
    if (coming_.empty()) return;
    const double idle = std::max(0.0, coming_.top().first - time());
    now_ += idle, idle_ += idle;
  }
  // Returns the virtual time, s.
  [[nodiscard]] double time() const {
    return now_ + std::chrono::duration<double>(Clock::now() - start_ - paused_).count();
  }
  [[nodiscard]] double idle() const { return idle_; }

 private:
  using Clock = std::chrono::steady_clock;
  using Coming = std::pair<double, std::pair<std::size_t, std::int64_t>>;  // Time, rank and run.
  CampaignRow row_;
  double run_time_, message_time_;
  std::vector<double> free_at_;
  std::priority_queue<Coming, std::vector<Coming>, std::greater<>> coming_;
  Clock::time_point start_ = Clock::now();
  Clock::duration paused_{};
  double now_ = 0, idle_ = 0;  // Without the measured time, s.
};

class SimulatedEngine : public CampaignEngine {
 public:
  SimulatedEngine(SimulatedRanks& ranks, std::size_t count) : ranks_(ranks), count_(count) {}
  [[nodiscard]] std::size_t workers() const override { return count_; }
  void execute(const EngineJob& job) override {
    RankDealer dealer(ranks_, count_, 1);
    while (true) {
      const std::vector<CampaignRow> rows = dealer.turn(job);
      if (!job.done(rows) || (rows.empty() && dealer.pending() == 0)) return;
      if (rows.empty()) ranks_.wait();
    }
  }

 private:
  SimulatedRanks& ranks_;
  std::size_t count_;
};

struct Usage {
  double busy = 0;        // Share of the time in which rank 0 works.
  double efficiency = 0;  // Share of the time in which the other ranks execute runs.
  double rate = 0;        // Rows per second.
};

Usage simulated(const CampaignFolder& folder, const CampaignRow& row, std::size_t ranks, double run_time,
                double message_time, std::int64_t runs) {
  const Campaign campaign =
      folder.campaign({fmt::format("samples={}", (runs + 3) / 4), fmt::format("stop.runs={}", runs)});
  const std::string path = folder.path("simulated.db");
  SimulatedRanks link(row, ranks, run_time, message_time);
  {
    CampaignFile file(path, campaign);
    SimulatedEngine engine(link, ranks);
    NoProgress progress;
    if (!run_campaign(campaign, file, engine, progress).is_complete) std::abort();
  }
  const double time = link.time();
  for (const char* end : {"", "-wal", "-shm"}) std::filesystem::remove(path + end);
  return {1 - link.idle() / time, static_cast<double>(runs) * run_time / (static_cast<double>(ranks) * time),
          static_cast<double>(runs) / time};
}

}  // namespace
}  // namespace flexura

int main(int count, char** arguments) {
  using namespace flexura;
  const double message_time = 1e-6 * (count > 1 ? std::atof(arguments[1]) : 5);
  const CampaignFolder folder;
  const Campaign campaign = folder.campaign();
  NoProgress progress;
  const std::optional<CampaignRow> row = execute_run(campaign, 0, progress);
  std::puts(
      "| duration of a run | ranks | rank 0 works, % of the time | other ranks execute runs, % of the time | "
      "rows "
      "per second |\n| ---: | ---: | ---: | ---: | ---: |");
  for (const double run_time : {0.01, 0.1, 1.0, 10.0}) {
    for (const std::size_t ranks : {10, 30, 100, 300, 1000, 3000, 10000}) {
      // Enough runs that the start and the end count little.
      const auto runs = std::clamp<std::int64_t>(static_cast<std::int64_t>(ranks) * 30, 10000, 60000);
      const Usage usage = simulated(folder, *row, ranks, run_time, message_time, runs);
      fmt::print("| {} s | {} | {:.1f} | {:.1f} | {:.0f} |\n", run_time, ranks, 100 * usage.busy,
                 100 * usage.efficiency, usage.rate);
      std::fflush(stdout);
    }
  }
  return 0;
}
