#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/view/messenger.h"
#include "flexura/view/run_link.h"
#include "flexura/view/viewed_rig.h"

namespace flexura {

/// Tells clients how a run of tasks goes: how far it is, what happens, what a calibration or a servo sees,
/// how it ends.
class RunTeller {
 public:
  RunTeller(ViewedRigPtr rig, Messenger& messenger) : rig_(std::move(rig)), messenger_(messenger) {}

  /// The pictures in which that was measured which was told last: what is drawn belongs to them.
  [[nodiscard]] const std::vector<RunLink::Measured>& measured() const { return measured_; }
  /// Another run begins: nothing was told of it.
  void begin();
  /// Somebody has come who knows nothing yet.
  void repeat() { are_extras_known_ = false; }
  /// Tells the clients what is new at `clock` s. Events bear the time `now`, s, or where there is none their
  /// own.
  void tell(RunLink& run, const RunLink::News& news, double clock, std::optional<double> now,
            const std::set<ClientId>& clients);

 private:
  void tell_progress(const RunLink::News& news, double clock, const std::set<ClientId>& clients);
  void tell_extras(const RunLink::News& news, double clock, std::optional<double> now,
                   const std::set<ClientId>& clients);
  void send(const Node& message, const std::set<ClientId>& clients);

  ViewedRigPtr rig_;
  Messenger& messenger_;
  double told_fraction_ = -1;
  std::string told_what_;
  double told_at_ = -1;  // s, of the clock
  std::vector<RunLink::Measured> measured_;
  bool are_extras_known_ = true;
  std::uint64_t changes_ = 0;
  double drawn_at_ = -1;  // s, of the clock
};

}  // namespace flexura
