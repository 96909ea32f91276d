#pragma once

#include <vector>

#include "tests/support/servo_bench.h"

namespace flexura {

/// What a servo sees on its way, with the arm's true shape at the time.
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
