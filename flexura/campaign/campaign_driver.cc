#include "flexura/campaign/campaign_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <vector>

#include "flexura/campaign/statistics.h"

namespace flexura {
namespace {

using Clock = std::chrono::steady_clock;

// Rows of so much time are written together, s: one transaction takes about 0.2 ms.
constexpr double between_writes = 0.1;

// A campaign in progress: which runs are missing, and when it ends.
class CampaignProgress {
 public:
  CampaignProgress(const Campaign& campaign, CampaignFile& file, Progress& progress)
      : campaign_(campaign), file_(file), progress_(progress), tracker_(campaign.config()) {
    file.for_each([this](const CampaignRow& row) { tracker_.add(row), ++runs_; });
    before_ = runs_;
    next_ = tracker_.prefix();
  }

  [[nodiscard]] std::optional<std::int64_t> next() {
    if (tracker_.stop() || is_out_of_time()) return std::nullopt;
    while (next_ < campaign_.design().runs() && tracker_.has(next_)) ++next_;
    return next_ < campaign_.design().runs() ? std::optional(next_++) : std::nullopt;
  }

  [[nodiscard]] bool done(std::span<const CampaignRow> rows) {
    for (const CampaignRow& row : rows) tracker_.add(row);
    waiting_.insert(waiting_.end(), rows.begin(), rows.end());
    if (elapsed() - written_ >= between_writes || tracker_.stop()) write();
    return !tracker_.stop();
  }

  // Writes the rows that wait.
  void write() {
    written_ = elapsed();
    if (waiting_.empty()) return;
    file_.add(waiting_);
    runs_ += static_cast<std::int64_t>(waiting_.size());
    waiting_.clear();
    const auto total = static_cast<double>(campaign_.design().runs());
    const double rate = static_cast<double>(runs_ - before_) / std::max(elapsed(), 1e-3);
    progress_.update(static_cast<double>(runs_) / total,
                     fmt::format("{} of {} runs, {:.3g} per s", runs_, campaign_.design().runs(), rate));
  }

  [[nodiscard]] CampaignEnd end() {
    write();
    CampaignEnd end{
        .before = before_, .runs = runs_, .is_complete = false, .is_cancelled = false, .reason = {}};
    if (tracker_.stop()) {
      end.runs = *tracker_.stop();
      complete(end, fmt::format("the required precision is reached after {} runs", end.runs));
    } else if (tracker_.prefix() >= campaign_.design().runs()) {
      complete(end, fmt::format("all {} runs are done", runs_));
    } else if (progress_.is_cancelled()) {
      end.is_cancelled = true, end.reason = "stopped";
    } else if (is_out_of_time()) {
      end.reason = fmt::format("the time limit of {:.6g} s is reached", *campaign_.config().stop.time);
    } else {
      end.reason = "the engine ended early";
    }
    return end;
  }

 private:
  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }
  [[nodiscard]] bool is_out_of_time() const {
    const std::optional<double>& time = campaign_.config().stop.time;
    return time && elapsed() >= *time;
  }
  void complete(CampaignEnd& end, const std::string& reason) {
    end.is_complete = true, end.reason = reason;
    file_.complete(end.runs, reason);
  }

  const Campaign& campaign_;
  CampaignFile& file_;
  Progress& progress_;
  StopTracker tracker_;
  std::vector<CampaignRow> waiting_;
  double written_ = 0;  // Time of the last write, s.
  std::int64_t before_ = 0, runs_ = 0, next_ = 0;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

CampaignEnd run_campaign(const Campaign& campaign, CampaignFile& file, CampaignEngine& engine,
                         Progress& progress) {
  if (const std::optional<std::int64_t> runs = file.completed_runs()) {
    engine.execute({.next = [] { return std::nullopt; },
                    .done = [](std::span<const CampaignRow>) { return false; },
                    .is_cancelled = [] { return true; }});
    return {.before = *runs,
            .runs = *runs,
            .is_complete = true,
            .is_cancelled = false,
            .reason = fmt::format("all {} runs were done before", *runs)};
  }
  CampaignProgress work(campaign, file, progress);
  engine.execute({.next = [&] { return work.next(); },
                  .done = [&](std::span<const CampaignRow> rows) { return work.done(rows); },
                  .is_cancelled = [&] { return progress.is_cancelled(); }});
  return work.end();
}

}  // namespace flexura
