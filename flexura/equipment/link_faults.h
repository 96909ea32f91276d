#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace flexura {

/// Probabilities of the faults of a link. Each fault is drawn independently for each message in either
/// direction.
struct LinkFaults {
  double lose = 0;       ///< Probability that a message is lost.
  double repeat = 0;     ///< Probability that a message arrives twice.
  double cut = 0;        ///< Probability that the end of a message is lost.
  double damage = 0;     ///< Probability that one byte of a message is changed.
  double swap = 0;       ///< Probability that a message arrives after the next message.
  double delay = 0;      ///< Probability that a message is delayed.
  double most_late = 0;  ///< Longest delay, s.
};

/// Transmits messages in one direction, with random faults. Equal seeds cause equal faults.
class FaultyCarrier {
 public:
  explicit FaultyCarrier(std::uint64_t seed) : random_(seed) {}

  /// Accepts a message that is sent at time `now`, s.
  void put(std::string message, const LinkFaults& faults, double now);
  /// Removes and returns the messages that have arrived by time `now`, s, in order.
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
