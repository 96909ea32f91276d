#pragma once

#include <vector>

#include "tests/support/servo_bench.h"

namespace flexura {

/// What a servo sees on its way, with the arm's true shape at the time.
class ObservationKeeper : public ServoSessionWatcher {
 public:
  explicit ObservationKeeper(ServoBench& bench) : bench_(bench) {}
  void arm_sent(double, const ArmState&, double) override {}
  void seen(const ServoObservation& observed) override {
    if (!observed.estimate.is_found) return;
    observations.push_back(observed);
    truth.push_back(bench_.rig().arm().truth(observed.time));
  }
  std::vector<ServoObservation> observations;
  std::vector<ArmState> truth;

 private:
  ServoBench& bench_;
};

}  // namespace flexura
