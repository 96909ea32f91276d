#include "flexura/rig/rehearsed_devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>

#include "flexura/base/degree.h"

namespace flexura {
namespace {

// Returns a controller whose axes have the limits of the drive's motors.
GrblDeviceConfig controller_of(const std::vector<Axis>& axes) {
  // Limits of axes for which the file has none, because a real controller always has limits: microsteps/s,
  // microsteps/s^2.
  constexpr double fastest = 5e4, quickest = 5e5, seconds = 60;
  constexpr int microsteps_a_mm = 100, rate_of_x = 110, acceleration_of_x = 120, steps_of_x = 100;
  GrblDeviceConfig config;
  config.axes = axes.size();
  constexpr std::size_t axes_of_grbl = 3;
  config.is_grblhal = axes.size() != axes_of_grbl;
  for (int i = 0; i < static_cast<int>(axes.size()); ++i) {
    const StepperMotor& motor = axes[static_cast<std::size_t>(i)].motor;
    const double microsteps_a_radian = motor.resolution() / (2 * std::numbers::pi);
    const double rate = std::min({motor.max_step_rate, motor.max_speed * microsteps_a_radian, fastest});
    const double acceleration = std::min(motor.max_acceleration * microsteps_a_radian, quickest);
    config.settings[steps_of_x + i] = microsteps_a_mm;
    config.settings[rate_of_x + i] = rate * seconds / microsteps_a_mm;
    config.settings[acceleration_of_x + i] = acceleration / microsteps_a_mm;
  }
  return config;
}

// Sets the counts of a turning axis: one per step that the axis can be commanded to.
void set_counts(const AxisConfig& axis, ViscaTurnConfig& turn) {
  constexpr double finest = 0.001 * degree;
  const double step = std::max(axis.resolution, finest);
  turn.counts_per_degree = degree / step;
  constexpr double rounding = 1e-6;
  turn.limits = {std::llround(std::ceil(axis.limits[0] / step - rounding)),
                 std::llround(std::floor(axis.limits[1] / step + rounding))};
  constexpr std::int64_t most = 0x7FFF;
  turn.digits = std::max(-turn.limits[0], turn.limits[1]) > most ? 5 : 4;
}

ViscaConfig visca_of(const Camera& camera, std::uint16_t port) {
  const std::array<AxisConfig, 3> axes = camera.head_axes();
  ViscaConfig config;
  config.bus.link = fmt::format("udp:127.0.0.1:{}", port);
  config.bus.framing = ViscaFraming::sony;
  set_counts(axes[0], config.pan), set_counts(axes[1], config.tilt);
  // A count is a step of the zoom's resolution, if there are not more than VISCA has. The zoom of a lens that
  // does not zoom has a range that is not used.
  auto [least, most] = axes[2].limits;
  if (const double step = axes[2].resolution; step > 0 && most > least) {
    constexpr double rounding = 1e-6;
    const double first = std::ceil(least / step - rounding), last = std::floor(most / step + rounding);
    const auto counts = static_cast<std::int64_t>(std::min(last - first, 1e9));
    if (counts > 0 && counts <= config.zoom.counts.back())
      least = first * step, most = last * step, config.zoom.counts = {0, counts};
  }
  // The simulated motors reach every count.
  config.pan.tolerance = config.tilt.tolerance = config.zoom.tolerance = 0;
  config.zoom.positions = std::vector<double>{least, most > least ? most : least + 1};
  return config;
}

// The motors of a camera's head. All axes stop together.
class HeadMotors : public ViscaMotors {
 public:
  HeadMotors(RehearsedWorld& world, std::size_t camera, ViscaConfig config)
      : world_(world), camera_(camera), config_(std::move(config)), to_(counts()) {}
  // The head moves at its own rates, whatever the command says.
  void go(Axis axis, double count, double /*speed*/, double /*now*/) override {
    place(to_, axis) = std::llround(count);
    world_.turn(camera_, visca_state(config_, to_));
  }
  void stop(Axis /*axis*/, double /*now*/) override {
    world_.halt(camera_);
    to_ = counts();
  }
  [[nodiscard]] double count(Axis axis, double /*now*/) override {
    ViscaCounts is = counts();
    return static_cast<double>(place(is, axis));
  }
  [[nodiscard]] bool is_moving(Axis /*axis*/, double /*now*/) override { return world_.head(camera_).moving; }

 private:
  [[nodiscard]] ViscaCounts counts() const { return visca_counts(config_, world_.head(camera_).state); }
  static std::int64_t& place(ViscaCounts& counts, Axis axis) {
    if (axis == pan) return counts.pan;
    return axis == tilt ? counts.tilt : counts.zoom;
  }

  RehearsedWorld& world_;
  std::size_t camera_;
  ViscaConfig config_;
  ViscaCounts to_;
};

ViscaHeadModel head_model(const ViscaConfig& config) {
  ViscaHeadModel model;
  model.digits = visca_digits(config);
  model.lowest = {config.pan.limits[0], config.tilt.limits[0], config.zoom.counts.front()};
  model.highest = {config.pan.limits[1], config.tilt.limits[1], config.zoom.counts.back()};
  return model;
}

std::unique_ptr<ViscaDevice> head_device(RehearsedWorld& world, std::size_t camera,
                                         const ViscaConfig& config) {
  auto device = std::make_unique<ViscaDevice>(ViscaFraming::sony);
  device->add(head_model(config), std::make_unique<HeadMotors>(world, camera, config));
  return device;
}

}  // namespace

RehearsedController::RehearsedController(const std::vector<Axis>& axes, SerialPair pair)
    : axes_(axes.size()),
      path_(pair.path),
      kept_(std::move(pair.kept)),
      device_(controller_of(axes)),
      server_(std::move(pair.device), device_) {}

std::vector<double> RehearsedController::positions() {
  const auto lock = server_.lock();
  return device_.positions(DeviceServer::now());
}

void RehearsedController::turn_back(double share) {
  const auto lock = server_.lock();
  const std::vector<double> turned = device_.positions(DeviceServer::now());
  for (std::size_t i = 0; i < turned.size(); ++i) device_.slip(i, -share * turned[i]);
}

RehearsedHead::RehearsedHead(RehearsedWorld& world, std::size_t camera, const Camera& model, UdpPlace place)
    : config_(visca_of(model, place.port)),
      device_(head_device(world, camera, config_)),
      server_(std::move(place.device), *device_) {}

}  // namespace flexura
