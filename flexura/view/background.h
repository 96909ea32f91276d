#pragma once

#include <cstdint>
#include <functional>

namespace flexura {

/// What is done beside a session's thread, each kind one thing after another.
enum class Lane : std::uint8_t { pictures, measures, checks, tasks };
inline constexpr std::size_t lane_count = 4;

/// Work away from a session's thread.
class Background {
 public:
  using After = std::function<void()>;  ///< Called on the session's thread; may be empty.
  using Job = std::function<After()>;   ///< What it throws, its After throws.

  virtual ~Background() = default;
  Background() = default;
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  virtual void run(Lane lane, Job job) = 0;
};

}  // namespace flexura
