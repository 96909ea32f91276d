#include "flexura/sim/rod_plant.h"

namespace flexura {

void RodPlant::command(double time, const Eigen::VectorXd& u, double duration) {
  inputs_.command(time, u, duration);
  forget();
}

void RodPlant::halt(double time) {
  inputs_.halt(time);
  forget();
}

std::optional<ArmState> RodPlant::pull(double time, const std::vector<double>& displacements,
                                       double duration) {
  std::optional<ArmState> nearest = inputs_.pull(time, displacements, duration);
  forget();
  return nearest;
}

bool RodPlant::weigh(double time, bool on) {
  const bool has_weight = inputs_.weigh(time, on);
  forget();
  return has_weight;
}

}  // namespace flexura
