#include "flexura/view/live_rig.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "flexura/kinematics/motors.h"
#include "flexura/kinematics/tendons.h"
#include "flexura/model/arm_difference.h"
#include "flexura/sim/arm_setup.h"
#include "flexura/sim/plant.h"
#include "flexura/sim/rig_config.h"
#include "flexura/sim/true_plant.h"

namespace flexura {
namespace {

// Interval at which a picture of a rod has computed backbones, s: motion in between is nearly straight.
constexpr double rod_interval = 0.0049;

// The rig's own cameras are never asked for frames: pictures are rendered from value_shot elsewhere.
Picture no_picture(const Shot& /*shot*/) {
  throw std::logic_error("the live rig itself does not render pictures");
}

ShapeConfig shape_of(const ArmState& state) {
  ShapeConfig shape;
  shape.bends.emplace();
  for (const auto& bend : state.bends) shape.bends->push_back({bend.x(), bend.y()});
  shape.stretches = state.stretches;
  return shape;
}

// But for what a client's numbers are rounded to.
bool are_alike(const ArmState& a, const ArmState& b) {
  constexpr double rounding = 1e-6;  // In rad, and as a fraction of a length.
  const ArmDifference way = minus(a, b);
  return std::ranges::all_of(way.bends, [](const auto& bend) { return bend.norm() <= rounding; }) &&
         std::ranges::all_of(way.stretches, [](double stretch) { return std::abs(stretch) <= rounding; });
}

std::vector<ActuatorSample> actuator_samples(const std::vector<double>& pulled,
                                             const std::vector<double>& tensions,
                                             const std::vector<double>& lost) {
  std::vector<ActuatorSample> samples;
  samples.reserve(pulled.size());
  for (std::size_t i = 0; i < pulled.size(); ++i)
    samples.push_back({pulled[i], i < tensions.size() ? tensions[i] : 0, i < lost.size() ? lost[i] : 0});
  return samples;
}

// Kinetic energy below which the arm is at rest, as a fraction of the work of the largest push force along
// the arm's length.
constexpr double still = 1e-9;

int obstacle_of(const ViewedRig& rig, const std::string& name) {
  const auto found = std::ranges::find(rig.obstacles, name, &Obstacle::name);
  return found == rig.obstacles.end() ? -1 : static_cast<int>(found - rig.obstacles.begin());
}

}  // namespace

std::vector<ContactSample> contact_samples(const ViewedRig& rig,
                                           const std::vector<ContactMessage>& contacts) {
  const auto slip_of = [](const std::optional<bool>& sticks) {
    if (!sticks) return ContactSample::Slip::unknown;
    return *sticks ? ContactSample::Slip::sticks : ContactSample::Slip::slides;
  };
  std::vector<ContactSample> samples;
  samples.reserve(contacts.size());
  for (const ContactMessage& contact : contacts) {
    const Eigen::Vector3d force(contact.force.x, contact.force.y, contact.force.z);
    samples.push_back({.obstacle = obstacle_of(rig, contact.with),
                       .s = contact.s,
                       .point = {contact.point.x, contact.point.y, contact.point.z},
                       .force = force,
                       .normal_force = contact.normal_force.value_or(force.norm()),
                       .slip = slip_of(contact.sticks)});
  }
  return samples;
}

LiveRig::LiveRig(ViewedRigPtr rig, double now) : rig_(std::move(rig)) { restart(now); }

void LiveRig::restart(double now) {
  simulated_ = std::make_unique<SimulatedRig>(rig_->experiment.model_rig(), rig_->experiment.true_rig(),
                                              no_picture, static_cast<std::uint64_t>(rig_->experiment.seed));
  start_ = now;
  behind_ = 0;
}

void LiveRig::take_over(std::unique_ptr<SimulatedRig> rig, double now) {
  simulated_ = std::move(rig);
  start_ = now - simulated_->clock().now();
  behind_ = 0;
}

void LiveRig::restart(double now, const ArmState& state) {
  RigConfig model = rig_->experiment.model_rig(), truth = rig_->experiment.true_rig();
  // Keeps the initial difference between true and modelled state.
  const ArmDifference off = minus(ArmSetup(truth).initial, ArmSetup(model).initial);
  model.arm.initial = shape_of(state);
  truth.arm.initial = shape_of(plus(state, off));
  take_over(std::make_unique<SimulatedRig>(model, truth, no_picture,
                                           static_cast<std::uint64_t>(rig_->experiment.seed)),
            now);
}

void LiveRig::skip_to(double next) {
  // An arm that swings is shown in short steps, even if these take long to compute.
  const double most = rig_->has_inertia ? 0.05 : 0.1;  // s
  constexpr double newest = 0.2;                       // Weight of the newest value in pace_.
  if (!rig_->is_rod) return;
  const double passed = next - now();
  behind_ = passed > most ? behind_ + 1 : 0;
  pace_ = behind_ > 0 ? pace_ + newest * (most / passed - pace_) : 1;
  start_ += std::max(0.0, passed - most);
}

// A single pause of the whole program does not count as slow.
std::optional<double> LiveRig::pace() const {
  constexpr int few = 5;
  return behind_ >= few ? std::optional(pace_) : std::nullopt;
}

// The simulated rig's links are never interrupted: a fault here is a program error.
ArmState LiveRig::nominal() { return simulated_->arm().read().value().state; }
bool LiveRig::is_arm_moving() { return simulated_->arm().read().value().moving; }

// The equilibrium of a rod may depend on its path.
Backbone LiveRig::at_rest(const ArmState& state) {
  if (!rig_->is_rod) return rig_->truth.backbone(state);
  if (are_alike(state, truth(now()))) return backbone(now());
  ArmSetup setup(rig_->experiment.true_rig());
  setup.initial = state;
  if (setup.rod && !simulated_->arm().plant().is_weighed(rig_time(now()))) setup.rod->loads = {};
  // The initial motor counts do not matter.
  const Eigen::VectorXd start =
      setup.drive ? Eigen::VectorXd::Zero(static_cast<Eigen::Index>(setup.drive->axes.size()))
                  : plant_command(state);
  return true_plant({setup, start, 0})->backbone(0);
}

std::shared_ptr<const Backbone> LiveRig::rod_at_rest(const ArmState& state) {
  if (!rig_->is_rod) return nullptr;
  try {
    return std::make_shared<const Backbone>(at_rest(state));
  } catch (const std::runtime_error&) {
    return nullptr;
  }
}

ArmState nearest_arcs(const ViewedRig& rig, const TendonPull& pull) {
  if (rig.drive) return fit_state(rig.model.driven(), *rig.drive, {pull.displacements}).state;
  const ArmSetup setup(rig.experiment.true_rig());
  if (!setup.rod) throw std::logic_error("the arm has no tendons that can be pulled individually");
  return nearest_arcs(setup.rod->rod, setup.arm, pull.displacements);
}

void LiveRig::weigh(bool on) {
  Plant& plant = simulated_->arm().plant();
  const double time = rig_time(now());
  const bool was = plant.is_weighed(time);
  plant.weigh(time, on);
  try {
    (void)plant.backbone(time);
  } catch (const std::runtime_error&) {
    plant.weigh(time, was);
    throw;
  }
}

void LiveRig::push(const std::optional<PlantPush>& push) {
  Plant& plant = simulated_->arm().plant();
  const double time = rig_time(now());
  const std::optional<PlantPush> was = plant.pushed(time);
  plant.push(time, push);
  try {
    (void)plant.backbone(time);
  } catch (const std::runtime_error&) {
    plant.push(time, was);
    throw;
  }
}

bool LiveRig::is_yielding() {
  if (is_pushed()) return true;
  const auto energy = simulated_->arm().plant().energy(rig_time(now()));
  return energy && rig_->push && energy->kinetic > still * rig_->push->most * rig_->push->length;
}

// Returns whether the arm's inputs are equal at two times, so that the arm lies the same.
bool LiveRig::lie_alike(double time, double other) {
  const Plant& plant = simulated_->arm().plant();
  const double at = rig_time(time), then = rig_time(other);
  // An arm with inertia may swing without input changes.
  if (rig_->has_inertia) return false;
  return truth(time) == truth(other) && plant.pushed(at) == plant.pushed(then) &&
         plant.is_weighed(at) == plant.is_weighed(then) && plant.pulled(at) == plant.pulled(then);
}

StateMessage LiveRig::state() {
  StateMessage message;
  message.time = now();
  const ArmReading reading = simulated_->arm().read().value();
  message.is_moving = reading.moving;
  message.arm = truth(message.time);
  message.samples = arm_samples(backbone(message.time));
  for (std::size_t i = 0; i < rig_->cameras.size(); ++i) {
    const CameraStance stance = simulated_->camera(i).stance(rig_time(message.time));
    message.cameras.push_back(camera_sample(*rig_, i, stance));
  }
  const Plant& plant = simulated_->arm().plant();
  const double time = rig_time(message.time);
  message.is_weightless = !plant.is_weighed(time);
  message.is_moving = message.is_moving || is_yielding();
  message.energy = plant.energy(time);
  if (const auto pushes = plant.push_force(time)) {
    const PlantPush push = plant.pushed(time).value();
    message.push = PushSample{push.s_rest, push.stiffness > 0 ? push.to : pushes->point, pushes->force};
  }
  for (const PlantContact& contact : plant.contacts(time))
    message.contacts.push_back(
        {.obstacle = obstacle_of(*rig_, contact.with),
         .s = contact.s_rest,
         .point = contact.point,
         .force = contact.force,
         .normal_force = contact.normal_force,
         .slip = contact.sticks ? ContactSample::Slip::sticks : ContactSample::Slip::slides});
  message.pace = pace();
  message.actuators = actuator_samples(plant.pulled(time), plant.tensions(time), plant.lost_steps(time));
  if (rig_->drive) {
    const std::vector<double> positions(reading.positions.begin(), reading.positions.end());
    message.displacements = displacements_at(*rig_->drive, positions).pulled;
  }
  return message;
}

std::int64_t LiveRig::newest_frame(std::size_t camera) {
  const SensorConfig& sensor = rig_->sensors.at(camera);
  const FrameTimes first = frame_times(sensor, 0);
  return static_cast<std::int64_t>(std::floor((now() - first.end) * sensor.frame_rate + 1e-9));
}

ValueShot LiveRig::shot(std::size_t camera, std::int64_t frame) {
  const double start = frame_times(rig_->sensors.at(camera), frame).start;
  SimulatedView& view = simulated_->camera(camera);
  std::vector<Instant> instants;
  const std::vector<double> times = times_of_instants(rig_->sensors[camera], start);
  for (const double time : times) {
    // Computing the backbone of a rod takes a while.
    if (rig_->is_rod && time != times.back() && !instants.empty() &&
        time - instants.back().time < rod_interval)
      continue;
    Instant instant{time, truth(time), view.stance(rig_time(time))};
    // If its inputs are unchanged, so is the rod.
    if (rig_->is_rod && !instants.empty() && lie_alike(instants.back().time, time)) {
      instant.shape = instants.back().shape;
    } else if (rig_->is_rod) {
      instant.shape = std::make_shared<const Backbone>(backbone(time));
    }
    instants.push_back(std::move(instant));
  }
  return value_shot(rig_, camera, frame, start, std::move(instants));
}

StateMessage still_state(const ViewedRig& rig, double time, const ArmState& state,
                         const std::vector<CameraStance>& stances, const TrueArm* truth) {
  StateMessage message;
  message.time = time;
  message.arm = state;
  message.samples = arm_samples(truth != nullptr ? truth->backbone : rig.model.backbone(state));
  if (truth != nullptr)
    message.actuators = actuator_samples(truth->pulled, truth->tensions, truth->lost_steps);
  if (truth != nullptr && truth->energy)
    message.energy = RodEnergy{truth->energy->kinetic, truth->energy->strain, truth->energy->gravity};
  if (truth != nullptr) message.contacts = contact_samples(rig, truth->contacts);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    message.cameras.push_back(camera_sample(rig, i, stances.at(i)));
  if (rig.drive) message.displacements = tendon_displacements(rig.model.driven(), *rig.drive, state).pulled;
  return message;
}

}  // namespace flexura
