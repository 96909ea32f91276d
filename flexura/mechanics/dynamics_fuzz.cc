// Interprets any bytes as a rod in motion: sections, tendons, loads, obstacles, payloads and steps, including
// numbers that are not finite. Each step converges or reports why not, and no result is NaN.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_contact.h"
#include "flexura/mechanics/rod_drag.h"
#include "flexura/mechanics/surroundings.h"

namespace {

using namespace flexura;

// Numbers from the input; 0 after its end.
class Numbers {
 public:
  explicit Numbers(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  int integer(int low, int high) { return low + static_cast<int>(byte()) % (high - low + 1); }
  double uniform(double low, double high) {
    const int first = byte(), second = byte();
    return low + (high - low) * (256 * first + second) / 65535.0;
  }
  // Logarithmically distributed between powers of ten.
  double power(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  // Mostly the usual value; sometimes an invalid one.
  double odd(double usual) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    switch (byte()) {
      case 250:
        return std::numeric_limits<double>::quiet_NaN();
      case 251:
        return infinity;
      case 252:
        return -usual;
      case 253:
        return 0;
      case 254:
        return 1e12 * usual;
      case 255:
        return 1e300;
      default:
        return usual;
    }
  }
  Eigen::Vector3d vector(double most) {
    const double x = uniform(-most, most), y = uniform(-most, most), z = uniform(-most, most);
    return {odd(x), odd(y), odd(z)};
  }
  std::array<double, 3> triple(double most) {
    const Eigen::Vector3d v = vector(most);
    return {v.x(), v.y(), v.z()};
  }

 private:
  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t first = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return first;
  }
  std::span<const std::uint8_t> bytes_;
};

Rod rod_of(Numbers& numbers) {
  Rod rod;
  const int sections = numbers.integer(1, 2);
  for (int i = 0; i < sections; ++i) {
    RodSection section{.length = numbers.odd(numbers.uniform(0.02, 0.4))};
    const double radius = numbers.uniform(0.5e-3, 2e-2);
    section.radius = {radius, numbers.odd(radius * numbers.uniform(0.3, 1))};
    section.youngs_modulus = numbers.odd(numbers.power(4, 11));
    section.shear_modulus = section.youngs_modulus / 3;
    section.density = numbers.odd(numbers.uniform(100, 9000));
    section.damping_time = numbers.odd(numbers.uniform(0, 0.05));
    section.modes = {.shear = numbers.integer(0, 1),
                     .stretch = numbers.integer(0, 1),
                     .bend = numbers.integer(1, 3),
                     .twist = numbers.integer(0, 1)};
    if (numbers.integer(0, 3) == 0) section.rest_curvature = {numbers.vector(10)};
    if (numbers.integer(0, 3) == 0) section.disks = numbers.integer(0, 3);
    if (numbers.integer(0, 3) == 0)
      section.masses = {{.at = numbers.odd(numbers.uniform(0, 1)), .mass = numbers.odd(0.01)}};
    rod.sections.push_back(section);
  }
  const int tendons = numbers.integer(0, 3);
  for (int i = 0; i < tendons; ++i)
    rod.tendons.push_back({.section = static_cast<std::size_t>(numbers.integer(0, sections - 1)),
                           .radius = numbers.odd(numbers.uniform(0, 0.02)),
                           .angle = numbers.uniform(-4, 4),
                           .compliance = numbers.odd(numbers.uniform(0, 1e-3)),
                           .friction = numbers.integer(0, 2) == 0 ? numbers.odd(numbers.uniform(0, 1)) : 0});
  return rod;
}

ObstacleConfig obstacle_of(Numbers& numbers) {
  const std::array<double, 3> place = numbers.triple(0.3);
  const double size = numbers.odd(numbers.uniform(0.001, 0.2));
  switch (numbers.integer(0, 3)) {
    case 0:
      return PlaneConfig{.point = place, .normal = numbers.triple(1)};
    case 1:
      return SphereConfig{.center = place, .radius = size};
    case 2:
      return CapsuleConfig{.from = place, .to = numbers.triple(0.3), .radius = size};
    default:
      return BoxConfig{.center = place, .half_sizes = {size, 0.05, numbers.odd(0.1)}};
  }
}

void require(bool holds) {
  if (!holds) std::abort();
}

void require_finite(const RodState& state) {
  require(std::isfinite(state.time) && state.q.allFinite() && state.momentum.allFinite());
  require(state.rate.allFinite() && state.force.allFinite());
  for (const double tension : state.tensions) require(std::isfinite(tension) && tension >= 0);
  for (const double held : state.friction) require(std::isfinite(held));
}

void look(RodDynamics& dynamics, const RodContact& contact, const RodState& state, const RodLoads& loads) {
  const RodEnergy energy = dynamics.energy(state, loads);
  require(!std::isnan(energy.kinetic) && !std::isnan(energy.strain));
  require(!std::isnan(dynamics.step_error(state)));
  require(!dynamics.tip(state).position.hasNaN());
  for (const ContactForce& each : contact.find(dynamics.point_motions(state))) {
    require(!each.force.hasNaN() && !each.normal.hasNaN() && !each.slip.hasNaN());
    require(each.depth > 0 && !(each.normal_force < 0));
  }
}

void run_scene(Numbers& numbers) {
  const Rod rod = rod_of(numbers);
  const RodDynamicsConfig config{.spectral_radius = numbers.odd(numbers.uniform(0, 1)), .most_pieces = 4};
  const std::vector<RodPlace> places = contact_places(rod, numbers.uniform(0.03, 0.2));
  RodDynamics dynamics(rod, config, places);
  RodContactConfig touches{.law = {.stiffness = numbers.odd(numbers.power(2, 7)),
                                   .damping = numbers.odd(numbers.uniform(0, 10)),
                                   .friction = numbers.odd(numbers.uniform(0, 1)),
                                   .slip_speed = numbers.odd(numbers.power(-4, -1)),
                                   .transition = numbers.odd(numbers.power(-6, -3))},
                           .itself = numbers.integer(0, 1) == 0,
                           .itself_apart = numbers.uniform(2, 8)};
  // Contact points at nodes, and between them.
  if (numbers.integer(0, 1) == 0) touches.places = contact_places(rod, numbers.uniform(0.01, 0.1));
  const int obstacles = numbers.integer(0, 2);
  for (int i = 0; i < obstacles; ++i) touches.obstacles.push_back(obstacle_of(numbers));
  const RodContact contact(dynamics.chain(), touches);
  const RodDrag drag(dynamics.chain(),
                     {.density = numbers.odd(numbers.uniform(0, 1000)), .flow = numbers.vector(1)});
  std::vector<const RodSurroundings*> parts = {&contact};
  if (numbers.integer(0, 1) == 0) parts.push_back(&drag);
  const Surroundings all(parts);
  dynamics.set_surroundings(&all);

  RodLoads loads{.gravity = numbers.vector(10)};
  if (numbers.integer(0, 2) == 0)
    loads.ends = {{.section = static_cast<std::size_t>(numbers.integer(0, 2)),
                   .force = numbers.vector(2),
                   .moment = numbers.vector(0.05),
                   .following = numbers.integer(0, 1) == 0}};
  TendonInput input;
  const int kind = numbers.integer(0, 2);
  for (std::size_t i = 0; i < rod.tendons.size() && kind > 0; ++i)
    (kind == 1 ? input.tensions : input.displacements)
        .push_back(numbers.odd(kind == 1 ? numbers.uniform(0, 10) : numbers.uniform(-0.01, 0.03)));
  const std::vector<TendonBreak> breaks = {{.tendon = 0, .time = 0.01}};

  RodState state = dynamics.rest();
  const int steps = numbers.integer(1, 4);
  for (int i = 0; i < steps; ++i) {
    const double h = numbers.odd(numbers.power(-6, 1));
    const TendonInput now = rod.tendons.empty() ? input : after_breaks(input, breaks, state.time);
    const double before = state.time;
    if (numbers.integer(0, 3) == 0) {
      std::vector<double> factors, rates;
      for (std::size_t s = 0; s < rod.sections.size(); ++s) {
        factors.push_back(numbers.odd(numbers.uniform(0.5, 2)));
        rates.push_back(numbers.odd(numbers.uniform(-2, 2)));
      }
      dynamics.stretch_rest(factors, rates);
    }
    const RodStep step = dynamics.step(state, now, loads, h);
    require(words(step.end)[0] != 0);
    require(!std::isnan(step.friction_work) && !std::isnan(step.friction_loss));
    require(step.converged() || state.time == before);
    require_finite(state);
    look(dynamics, contact, state, loads);
    if (numbers.integer(0, 5) == 0) {
      const RodPayload load{.place = places.empty() ? RodPlace{} : places.front(),
                            .mass = numbers.odd(0.01),
                            .offset = numbers.vector(0.02)};
      state = dynamics.pick_up(state, load, now, loads);
      if (numbers.integer(0, 1) == 0) state = dynamics.drop(state, load.place, now, loads);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Numbers numbers({data, size});
  try {
    run_scene(numbers);
  } catch (const std::invalid_argument& error) {
    if (error.what()[0] == 0) std::abort();
  }
  return 0;
}
