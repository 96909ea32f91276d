#pragma once

#include <vector>

#include "tests/support/servo_bench.h"

namespace flexura {

/// Records the observations of a servo together with the true shape of the arm at the same time.
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
