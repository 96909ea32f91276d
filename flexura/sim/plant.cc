#include "flexura/sim/plant.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "flexura/port/driven_arm.h"
#include "flexura/sim/arm_setup.h"

namespace flexura {
namespace {

std::vector<std::int64_t> counted(const Eigen::VectorXd& u) {
  std::vector<std::int64_t> positions;
  for (const double position : u) positions.push_back(std::llround(position));
  return positions;
}

std::span<const double> span_of(const Eigen::VectorXd& u) {
  return {u.data(), static_cast<std::size_t>(u.size())};
}

}  // namespace

DrivenPlant::DrivenPlant(const PlantSetup& setup)
    : ArcPlant(setup.truth.arm),
      arm_(setup.truth.arm),
      drive_(setup.truth.drive.value()),
      motors_(drive_, drive_, counted(setup.start), setup.horizon),
      zero_(displacements_at_zero(arm_, drive_, setup.truth.initial, counted(setup.start))) {}

void DrivenPlant::command(double time, const Eigen::VectorXd& u, double duration) {
  motors_.command(time, span_of(u), duration);
}

ArmState DrivenPlant::state(double time) const {
  return shape_carried(arm_, drive_, zero_, motors_.carried(time));
}

void BendPlant::command(double time, const Eigen::VectorXd& u, double duration) {
  bends_.command(time, commanded_state(u), duration);
}

std::unique_ptr<Plant> arc_plant(const PlantSetup& setup) {
  if (setup.truth.drive) return std::make_unique<DrivenPlant>(setup);
  return std::make_unique<BendPlant>(setup);
}

Eigen::VectorXd plant_command(const ArmState& state) {
  Eigen::VectorXd u(static_cast<Eigen::Index>(3 * state.bends.size()));
  for (std::size_t i = 0; i < state.bends.size(); ++i)
    u.segment<3>(static_cast<Eigen::Index>(3 * i)) << state.bends[i], state.stretches[i];
  return u;
}

ArmState commanded_state(const Eigen::VectorXd& u) {
  ArmState state;
  for (Eigen::Index i = 0; i + 2 < u.size(); i += 3) {
    state.bends.emplace_back(u[i], u[i + 1]);
    state.stretches.push_back(u[i + 2]);
  }
  return state;
}

}  // namespace flexura
