#pragma once

#include <cstdint>
#include <functional>

namespace flexura {

/// Lanes of work outside a session's thread. Jobs of one lane run one after another.
enum class Lane : std::uint8_t { pictures, measures, checks, tasks };
inline constexpr std::size_t lane_count = 4;

/// Runs work away from a session's thread.
class Background {
 public:
  using After = std::function<void()>;  ///< Called on the session's thread; may be empty.
  using Job = std::function<After()>;   ///< An exception of the job is rethrown by its After.

  virtual ~Background() = default;
  Background() = default;
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  virtual void run(Lane lane, Job job) = 0;
};

}  // namespace flexura
