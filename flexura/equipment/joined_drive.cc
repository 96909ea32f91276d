#include "flexura/equipment/joined_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

namespace flexura {

JoinedDrive::JoinedDrive(std::vector<DrivePort*> parts, Calls calls)
    : parts_(std::move(parts)), calls_(calls) {
  if (parts_.empty()) throw std::invalid_argument("a joined drive needs at least one part");
  for (const DrivePort* part : parts_) {
    if (part->quantity() != parts_.front()->quantity())
      throw std::invalid_argument("the parts of a joined drive must have the same quantity");
    axes_ += part->axes();
  }
}

void JoinedDrive::for_each(const std::function<void(std::size_t)>& call) const {
  if (calls_ == Calls::one_by_one) {
    for (std::size_t i = 0; i < parts_.size(); ++i) call(i);
    return;
  }
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < parts_.size(); ++i) others.emplace_back(call, i);
  call(0);
  for (std::thread& other : others) other.join();
}

CommandOutcome JoinedDrive::command(std::span<const double> targets, double duration) {
  // A bad command is refused before any part moves.
  if (targets.size() != axes_)
    return PortFault{FaultKind::refused,
                     fmt::format("drive: a command has {} targets; expected {}", targets.size(), axes_)};
  if (!std::ranges::all_of(targets, [](double one) { return std::isfinite(one); }) ||
      !std::isfinite(duration) || duration < 0)
    return PortFault{FaultKind::refused,
                     "drive: targets and the duration must be finite, and the duration not negative"};
  std::vector<std::size_t> first(parts_.size(), 0);
  for (std::size_t i = 1; i < parts_.size(); ++i) first[i] = first[i - 1] + parts_[i - 1]->axes();
  std::vector<CommandOutcome> outcomes(parts_.size(), Accepted{});
  for_each([&](std::size_t i) {
    outcomes[i] = parts_[i]->command(targets.subspan(first[i], parts_[i]->axes()), duration);
  });
  const auto failed = std::ranges::find_if(outcomes, [](const CommandOutcome& one) { return !one; });
  if (failed == outcomes.end()) return Accepted{};
  (void)halt();
  return *failed;
}

CommandOutcome JoinedDrive::halt() {
  std::vector<CommandOutcome> outcomes(parts_.size(), Accepted{});
  for_each([&](std::size_t i) { outcomes[i] = parts_[i]->halt(); });
  const auto failed = std::ranges::find_if(outcomes, [](const CommandOutcome& one) { return !one; });
  return failed == outcomes.end() ? CommandOutcome(Accepted{}) : *failed;
}

Outcome<DriveReading> JoinedDrive::read() {
  std::vector<std::optional<Outcome<DriveReading>>> outcomes(parts_.size());
  for_each([&](std::size_t i) { outcomes[i] = parts_[i]->read(); });
  DriveReading joined;
  double earliest = 0, latest = 0;
  bool is_carried = true;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (!*outcomes[i]) return *outcomes[i]->fault();
    const DriveReading& one = outcomes[i]->value();
    earliest = i == 0 ? one.time : std::min(earliest, one.time);
    latest = i == 0 ? one.time : std::max(latest, one.time);
    joined.values.insert(joined.values.end(), one.values.begin(), one.values.end());
    joined.carried.insert(joined.carried.end(), one.carried.begin(), one.carried.end());
    is_carried = is_carried && one.carried.size() == one.values.size();
    joined.moving = joined.moving || one.moving;
  }
  if (!is_carried) joined.carried.clear();
  joined.time = 0.5 * (earliest + latest);
  return joined;
}

}  // namespace flexura
