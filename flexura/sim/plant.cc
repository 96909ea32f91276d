#include "flexura/sim/plant.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

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
      motors_(setup.truth.drive.value(), *setup.truth.drive, counted(setup.start), setup.horizon),
      shapes_(setup.truth.arm, *setup.truth.drive, setup.truth.initial, counted(setup.start), setup.horizon) {
}

void DrivenPlant::command(double time, const Eigen::VectorXd& u, double duration) {
  shapes_.advance(time, motors_);
  motors_.command(time, span_of(u), duration);
}

void DrivenPlant::halt(double time) {
  shapes_.advance(time, motors_);
  motors_.halt(time);
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
