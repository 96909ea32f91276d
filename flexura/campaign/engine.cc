#include "flexura/campaign/engine.h"

#include <utility>
#include <vector>

namespace flexura {

ThreadEngine::ThreadEngine(RunFunction run, std::size_t threads) : run_(std::move(run)), threads_(threads) {}

void ThreadEngine::execute(const EngineJob& job) {
  constexpr std::chrono::milliseconds patience{100};
  WorkerPool pool(run_, threads_);
  while (!job.is_cancelled()) {
    while (pool.pending() < runs_ahead * threads_) {
      const std::optional<std::int64_t> id = job.next();
      if (!id) break;
      pool.add(*id);
    }
    if (pool.pending() == 0) return;
    if (!job.done(pool.take(patience))) return;
  }
}

}  // namespace flexura
