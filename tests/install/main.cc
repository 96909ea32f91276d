// A separate project that uses an installed Flexura: prints the tip position of the paper's arm.
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <vector>

#include "flexura/kinematics/planar.h"
#include "flexura/kinematics/spatial.h"

int main() {
  using std::numbers::pi;
  const std::vector<double> lengths = {2, 3, 1, 2, 4, 2, 1, 1};
  const std::vector<double> cord_angles = {.55 * pi,  .65 * pi, .8 * pi, pi,
                                           1.15 * pi, .9 * pi,  .8 * pi, .65 * pi};

  const auto archings = flexura::archings_from_cord_angles(cord_angles, pi / 2);
  flexura::Arm arm;
  flexura::ArmState state = flexura::ArmState::straight(lengths.size());
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    arm.sections.push_back({.length = lengths[i]});
    state.bends[i] = flexura::bend_from_arching(archings[i]);
  }
  const auto tip = flexura::tip_pose(arm, state).position;
  std::printf("E = (%.3f, %.3f)\n", tip.x(), tip.y());
}
