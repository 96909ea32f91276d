#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace flexura {

/// Faults of a link. Each is drawn for each message of either direction on its own.
struct LinkFaults {
  double lose = 0;       ///< Probability that a message is lost.
  double repeat = 0;     ///< Probability that it arrives twice.
  double cut = 0;        ///< Probability that its end is lost.
  double damage = 0;     ///< Probability that one of its bytes is changed.
  double swap = 0;       ///< Probability that it arrives after the next one.
  double delay = 0;      ///< Probability that it arrives late.
  double most_late = 0;  ///< Longest delay, s.
};

/// Carries messages one way, with faults. The same seed gives the same faults.
class FaultyCarrier {
 public:
  explicit FaultyCarrier(std::uint64_t seed) : random_(seed) {}

  /// Takes a message that is sent at time `now`, s.
  void put(std::string message, const LinkFaults& faults, double now);
  /// Returns the messages that have arrived by time `now`, s, in order, and forgets them.
  std::vector<std::string> take(double now);

 private:
  struct Message {
    double at;
    std::string bytes;
  };
  bool happens(double probability) { return share_(random_) < probability; }
  std::size_t index(std::size_t size);
  void add(double at, std::string bytes, bool is_held);

  std::mt19937_64 random_;
  std::uniform_real_distribution<double> share_{0, 1};
  std::vector<Message> messages_;
  std::optional<Message> held_;  // Arrives after the next one.
};

}  // namespace flexura
