#pragma once

#include <cstdint>
#include <functional>

namespace flexura {

/// Queues for work outside a session's thread. Jobs in one lane run one after another.
enum class Lane : std::uint8_t { pictures, measures, checks, tasks, campaign };
inline constexpr std::size_t lane_count = 5;

/// Runs jobs outside a session's thread.
class Background {
 public:
  /// Function that is called on the session's thread after a job; may be empty.
  using After = std::function<void()>;
  using Job = std::function<After()>;  ///< Work of a job. If the job throws an exception, `After` rethrows
                                       ///< the exception.

  virtual ~Background() = default;
  Background() = default;
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  virtual void run(Lane lane, Job job) = 0;
};

}  // namespace flexura
