#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/base/time_left.h"
#include "flexura/view/messenger.h"
#include "flexura/view/run_link.h"
#include "flexura/view/viewed_rig.h"

namespace flexura {

/// Reports a run of tasks to clients: its progress, events, observations of a calibration or servo, and its
/// end.
class RunReporter {
 public:
  RunReporter(ViewedRigPtr rig, Messenger& messenger) : rig_(std::move(rig)), messenger_(messenger) {}

  /// Returns the pictures of the last reported measurement, to which overlays belong.
  [[nodiscard]] const std::vector<RunLink::Measured>& measured() const { return measured_; }
  /// Resets the reporter for the next run.
  void begin();
  /// Makes the next report send the extras again, for a new client.
  void repeat() { are_extras_known_ = false; }
  /// Reports news to the clients. `clock`: present time, s. `now`: time of events in messages, s; if it is
  /// missing, messages have the events' own times.
  void report(RunLink& run, const RunLink::News& news, double clock, std::optional<double> now,
              const std::set<ClientId>& clients);

 private:
  void report_progress(const RunLink::News& news, double clock, const std::set<ClientId>& clients);
  void report_extras(const RunLink::News& news, double clock, std::optional<double> now,
                     const std::set<ClientId>& clients);
  void send(const Node& message, const std::set<ClientId>& clients);

  ViewedRigPtr rig_;
  Messenger& messenger_;
  double reported_fraction_ = -1;
  std::string reported_what_;
  TimeLeft time_left_;
  std::optional<double> began_;  // Time of the clock at the first report of the run, s.
  double reported_at_ = -1;      // Time of the clock at the last progress report, s.
  std::vector<RunLink::Measured> measured_;
  bool are_extras_known_ = true;
  std::uint64_t changes_ = 0;
  double drawn_at_ = -1;  // Time of the clock at the last extras, s.
};

}  // namespace flexura
