#include "flexura/equipment/link_faults.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace flexura {

void FaultyCarrier::put(std::string message, const LinkFaults& faults, double now) {
  if (happens(faults.lose)) return;
  if (!message.empty() && happens(faults.cut)) message.resize(index(message.size()));
  if (!message.empty() && happens(faults.damage))
    message[index(message.size())] = static_cast<char>(index(256));
  const double at = now + (happens(faults.delay) ? faults.most_late * share_(random_) : 0);
  if (happens(faults.repeat)) add(at, message, false);
  add(at, std::move(message), happens(faults.swap));
}

std::vector<std::string> FaultyCarrier::take(double now) {
  std::vector<std::string> arrived;
  const auto late =
      std::ranges::stable_partition(messages_, [&](const Message& one) { return one.at <= now; });
  std::ranges::transform(messages_.begin(), late.begin(), std::back_inserter(arrived),
                         [](Message& one) { return std::move(one.bytes); });
  messages_.erase(messages_.begin(), late.begin());
  return arrived;
}

std::size_t FaultyCarrier::index(std::size_t size) {
  return std::min(static_cast<std::size_t>(share_(random_) * static_cast<double>(size)), size - 1);
}

void FaultyCarrier::add(double at, std::string bytes, bool is_held) {
  if (is_held && !held_) {
    held_ = Message{at, std::move(bytes)};
    return;
  }
  messages_.push_back({at, std::move(bytes)});
  if (held_) messages_.push_back(*std::exchange(held_, std::nullopt));
}

}  // namespace flexura
