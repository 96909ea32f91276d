#pragma once

#include <vector>

#include "tests/support/servo_bench.h"

namespace flexura {

/// Records the observations of a servo together with the true shape of the arm at the same time.
class SightKeeper : public ServoSessionWatcher {
 public:
  explicit SightKeeper(ServoBench& bench) : bench_(bench) {}
  void arm_sent(double, const ArmState&, double) override {}
  void seen(const ServoSight& sight) override {
    if (!sight.estimate.is_found) return;
    sights.push_back(sight);
    truth.push_back(bench_.rig().arm().truth(sight.time));
  }
  std::vector<ServoSight> sights;
  std::vector<ArmState> truth;

 private:
  ServoBench& bench_;
};

}  // namespace flexura
