#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexura/port/clock_port.h"
#include "flexura/port/outcome.h"

namespace flexura {

/// The link to a simulated device: the device's name, the rig's clock, and the outages of the link. During an
/// outage, a motion that was commanded before continues.
class SimulatedLink {
 public:
  SimulatedLink(std::string name, const ClockPort& clock) : name_(std::move(name)), clock_(&clock) {}

  [[nodiscard]] double now() const { return clock_->now(); }
  /// Interrupts the link during [from, to), s.
  void lose(double from, double to) { outages_.emplace_back(from, to); }
  /// Returns the fault at the current time, if there is one.
  [[nodiscard]] std::optional<PortFault> fault() const {
    for (const auto& [from, to] : outages_) {
      if (now() >= from && now() < to)
        return PortFault{FaultKind::link_lost, fmt::format("{} does not answer at {:.6g} s", name_, now())};
    }
    return std::nullopt;
  }
  [[nodiscard]] PortFault refusal(const std::string& why) const {
    return {FaultKind::refused, fmt::format("{}: {}", name_, why)};
  }

 private:
  std::string name_;
  const ClockPort* clock_;
  std::vector<std::pair<double, double>> outages_;
};

}  // namespace flexura
