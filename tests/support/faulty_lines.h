#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/support/simulated_line.h"

// What goes wrong on the lines of a rig, and what must hold all the same.
namespace flexura {

inline constexpr double fault_watchdog = 0.5;  ///< s
inline constexpr double fault_braking = 0.15;  ///< Of the simulated motors from full speed, s.

/// Checks that motors rest when they must.
class RestCheck {
 public:
  /// From a watchdog period and the time of braking after `since` on, the motors must rest, until they may
  /// move.
  void require(double since, const std::string& why) {
    if (!due_) due_ = since + fault_watchdog + fault_braking, why_ = why;
  }
  void allow_motion() { due_.reset(), rest_.clear(), has_failed_ = false; }
  void forget_place() { rest_.clear(); }
  void step(double now, const std::vector<double>& positions) {
    if (!due_ || now < *due_) return;
    ++checks_;
    if (rest_.empty()) rest_ = positions;
    if (rest_ == positions || has_failed_) return;
    has_failed_ = true;
    ADD_FAILURE() << "the arm moves at " << now << " s; it must rest since " << *due_ << " s: " << why_;
  }
  [[nodiscard]] long checks() const { return checks_; }

 private:
  std::optional<double> due_;
  std::string why_;
  std::vector<double> rest_;
  long checks_ = 0;
  bool has_failed_ = false;
};

/// Calls in progress. None may take too long.
class Calls {
 public:
  explicit Calls(SimulatedThreads& time) : time_(time) {}
  template <class Call>
  auto operator()(const std::string& name, double limit, Call&& call) {
    std::uint64_t number = 0;
    {
      const auto lock = time_.enter();
      number = next_++;
      running_[number] = {name, time_.now(), limit};
    }
    auto outcome = call();
    const auto lock = time_.enter();
    double& longest = longest_[name];
    longest = std::max(longest, time_.now() - running_[number].since);
    running_.erase(number);
    return outcome;
  }
  void step(double now) const {
    for (const auto& [number, call] : running_) {
      if (now < call.since + call.limit) continue;
      std::fprintf(stderr, "%s takes longer than %g s, since %g s\n", call.name.c_str(), call.limit,
                   call.since);
      std::abort();
    }
  }
  [[nodiscard]] const std::map<std::string, double>& longest() const { return longest_; }

 private:
  struct Call {
    std::string name;
    double since = 0, limit = 0;
  };
  SimulatedThreads& time_;
  std::map<std::uint64_t, Call> running_;
  std::map<std::string, double> longest_;
  std::uint64_t next_ = 0;
};

/// What goes wrong with a line, one fault after the other.
class Mishaps {
 public:
  Mishaps(SimulatedLine& line, std::uint64_t seed) : line_(line), random_(seed) {}
  /// `raise_alarm`, `restart`: of the line's device; may be empty.
  std::function<void(double)> raise_alarm, restart;
  void step(double now) {
    if (now < next_) return;
    std::uniform_real_distribution<double> share(0, 1);
    const bool was_off = is_off_;
    line_.faults = {}, line_.is_silent = line_.is_gone = line_.is_full = is_off_ = false;
    next_ = now + 2 + 4 * share(random_);
    const int kind = static_cast<int>(11 * share(random_));
    ++counts[static_cast<std::size_t>(kind)];
    if (was_off && share(random_) < 0.5 && restart) restart(now);
    switch (kind) {
      case 0:
        break;
      case 1:
        line_.faults.lose = 0.05;
        break;
      case 2:
        line_.faults.delay = 0.1, line_.faults.most_late = 0.1;
        break;
      case 3:
        line_.faults.repeat = 0.1;
        break;
      case 4:
        line_.faults.swap = 0.05;
        break;
      case 5:
        line_.faults.cut = 0.05;
        break;
      case 6:
        line_.faults = {
            .lose = 0.02, .repeat = 0.02, .cut = 0.02, .swap = 0.02, .delay = 0.02, .most_late = 0.1};
        break;
      case 7:
        line_.is_full = true, next_ = now + 0.2 + 1.5 * share(random_);
        break;
      case 8:
        line_.is_silent = is_off_ = true, next_ = now + 0.2 + 3 * share(random_);
        break;
      case 9:
        line_.is_gone = is_off_ = true, next_ = now + 0.2 + 3 * share(random_);
        break;
      default:
        if (raise_alarm) raise_alarm(now);
    }
  }
  /// Lets nothing else go wrong until a time.
  void hold(double until) { next_ = std::max(next_, until); }
  /// Whether nothing can pass the line now.
  [[nodiscard]] bool is_dead() const { return line_.is_silent || line_.is_gone || line_.is_full; }
  [[nodiscard]] bool is_clean() const {
    return !line_.is_silent && !line_.is_gone && !line_.is_full &&
           line_.faults.lose + line_.faults.cut == 0 &&
           line_.faults.delay + line_.faults.swap + line_.faults.repeat == 0;
  }
  std::array<int, 11> counts{};

 private:
  SimulatedLine& line_;
  std::mt19937_64 random_;
  double next_ = 5;  // All begins well.
  bool is_off_ = false;
};

}  // namespace flexura
