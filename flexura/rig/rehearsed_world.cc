#include "flexura/rig/rehearsed_world.h"

#include <exception>
#include <limits>
#include <optional>
#include <utility>

#include "flexura/equipment/wall_clock.h"
#include "flexura/port/driven_arm.h"
#include "flexura/sim/arm_setup.h"

namespace flexura {
namespace {

// The motor follows what its controller does, which has the limits.
void free_motor(StepperMotor& motor) {
  constexpr double none = std::numeric_limits<double>::infinity();
  motor.max_speed = motor.max_acceleration = motor.max_step_rate = motor.max_position = none;
}

Setup with_free_motors(Setup setup) {
  DriveConfig drive = setup.true_rig().drive.value();
  free_motor(drive.motor);
  for (TendonConfig& tendon : drive.tendon)
    if (tendon.motor) free_motor(*tendon.motor);
  if (!setup.truth) setup.truth.emplace();
  setup.truth->drive = std::move(drive);
  setup.equipment.reset();
  return setup;
}

}  // namespace

RehearsedWorld::RehearsedWorld(const Setup& setup, Positions positions)
    : setup_(with_free_motors(setup)),
      positions_(std::move(positions)),
      start_(steady_seconds()),
      filming_(setup_),
      truth_(filming_.truth()),
      ports_(filming_.ports()) {
  const ArmSetup arm(setup_.model_rig());
  for (const std::int64_t position : nominal_positions(arm.arm, arm.drive.value(), arm.initial))
    first_.push_back(static_cast<double>(position));
  for (const CameraConfig& camera : setup_.true_rig().cameras) sensors_.push_back(camera.sensor);
}

double RehearsedWorld::now() const { return steady_seconds() - start_; }

void RehearsedWorld::advance() {
  const std::scoped_lock lock(mutex_);
  advance_locked();
}

void RehearsedWorld::advance_locked() {
  const double time = now();
  if (!(time > passed_) || !failure_.empty()) return;
  const std::vector<double> turned = positions_();
  Eigen::VectorXd u(static_cast<Eigen::Index>(first_.size()));
  for (std::size_t i = 0; i < first_.size(); ++i) u[static_cast<Eigen::Index>(i)] = first_[i] + turned.at(i);
  try {
    filming_.simulation().arm().plant().command(passed_, u, time - passed_);
    filming_.simulation().clock().wait_until(time);
    passed_ = time;
  } catch (const std::exception& error) {
    failure_ = error.what();
  }
}

std::string RehearsedWorld::failure() const {
  const std::scoped_lock lock(mutex_);
  return failure_;
}

void RehearsedWorld::turn(std::size_t camera, const HeadState& to) {
  const std::scoped_lock lock(mutex_);
  advance_locked();
  (void)ports_.cameras.at(camera).head->command(to);
}

void RehearsedWorld::halt(std::size_t camera) {
  const std::scoped_lock lock(mutex_);
  advance_locked();
  (void)ports_.cameras.at(camera).head->halt();
}

HeadReading RehearsedWorld::head(std::size_t camera) {
  const std::scoped_lock lock(mutex_);
  advance_locked();
  return ports_.cameras.at(camera).head->read().value();
}

bool RehearsedWorld::is_lost(std::size_t camera, std::int64_t frame) {
  return filming_.simulation().camera(camera).camera().is_lost(frame);
}

Picture RehearsedWorld::picture(std::size_t camera, std::int64_t frame) {
  Shot shot;
  {
    const std::scoped_lock lock(mutex_);
    advance_locked();
    shot = filming_.shot(camera, frame_times(sensors_.at(camera), frame).start);
  }
  // The world goes on while a picture is rendered.
  shot.view = [this, view = std::move(shot.view)](double time) {
    const std::scoped_lock lock(mutex_);
    return view(time);
  };
  shot.backbone = [this, backbone = std::move(shot.backbone)](double time) {
    const std::scoped_lock lock(mutex_);
    return backbone(time);
  };
  return filming_.take(shot);
}

Backbone RehearsedWorld::backbone() {
  const std::scoped_lock lock(mutex_);
  advance_locked();
  return truth_->backbone(passed_);
}

RigStance RehearsedWorld::stance(std::size_t camera) {
  const std::scoped_lock lock(mutex_);
  advance_locked();
  return truth_->stance(camera);
}

}  // namespace flexura
