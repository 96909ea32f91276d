#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "flexura/campaign/campaign.h"
#include "flexura/campaign/worker_pool.h"

namespace flexura {

/// Functions of the campaign that an engine calls.
struct EngineJob {
  /// Returns the number of the next run to start; std::nullopt: no further runs.
  std::function<std::optional<std::int64_t>()> next;
  /// Called several times a second with the runs that have finished since the last call, in any order; there
  /// may be none. Returns false to end at once, without the runs in progress.
  std::function<bool(std::span<const CampaignRow>)> done;
  /// Returns whether to end at once, without the runs in progress.
  std::function<bool()> is_cancelled;
};

/// Executes the runs of a campaign in parallel. The rows do not depend on the engine.
class CampaignEngine {
 public:
  CampaignEngine() = default;
  virtual ~CampaignEngine() = default;
  CampaignEngine(const CampaignEngine&) = delete;
  CampaignEngine& operator=(const CampaignEngine&) = delete;

  /// Returns the number of runs that are executed at the same time.
  [[nodiscard]] virtual std::size_t workers() const = 0;
  /// Executes runs until there are no further ones and all are done, or until the job ends early. Calls the
  /// functions of the job on the calling thread. Exceptions of runs and of the job's functions are rethrown.
  virtual void execute(const EngineJob& job) = 0;
};

/// Executes runs in the threads of this process.
class ThreadEngine : public CampaignEngine {
 public:
  /// `threads` >= 1.
  ThreadEngine(RunFunction run, std::size_t threads);
  [[nodiscard]] std::size_t workers() const override { return threads_; }
  void execute(const EngineJob& job) override;

 private:
  RunFunction run_;
  std::size_t threads_;
};

/// Number of runs that are assigned to a worker in advance, so that it never waits for its next run.
inline constexpr std::size_t runs_ahead = 2;

}  // namespace flexura
