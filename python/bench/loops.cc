// The computations of calls.py in C++: prints the least CPU time of each, us, as lines NAME TIME.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <ctime>
#include <fstream>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/experiment/experiment.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/mechanics/arm_rod.h"
#include "flexura/mechanics/dynamics.h"
#include "flexura/rig/photographer.h"

namespace flexura {
namespace {

// Prints the least CPU time of an item, us, of several runs over `items` items.
template <class Run>
void print_time(const char* name, int items, const Run& run) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 7; ++i) {
    const std::clock_t start = std::clock();
    run();
    best = std::min(best, 1e6 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  fmt::print("{} {:.4f}\n", name, best / items);
}

// Numbers that calls.py uses, too: tensions of 64 arms with nine tendons, N, and 200 positions, m.
struct Given {
  std::array<std::array<double, 9>, 64> tensions;
  std::array<std::array<double, 3>, 200> positions;
};

std::optional<Given> read_numbers(const char* file) {
  std::ifstream in(file);
  Given given{};
  for (auto& row : given.tensions)
    for (double& value : row) in >> value;
  for (auto& row : given.positions)
    for (double& value : row) in >> value;
  return in ? std::optional(given) : std::nullopt;
}

// From an array of numbers to an array of numbers, as NumPy has them: bend_x, bend_y and stretch of each
// section; matrices in rows.
void time_arrays(const Arm& arm, const std::vector<ArmState>& states) {
  constexpr std::size_t sections = 3, numbers = 3 * sections;
  std::vector<double> given;
  for (const ArmState& state : states)
    for (std::size_t i = 0; i < sections; ++i)
      given.insert(given.end(), {state.bends[i].x(), state.bends[i].y(), state.stretches[i]});
  ArmState state = ArmState::straight(sections);
  const auto read = [&](std::size_t at) {
    const double* from = given.data() + numbers * at;
    for (std::size_t i = 0; i < sections; ++i, from += 3)
      state.bends[i] = {from[0], from[1]}, state.stretches[i] = from[2];
  };
  const auto count = static_cast<int>(states.size());
  std::vector<double> tips(16 * states.size());
  print_time("tip", count, [&] {
    for (std::size_t i = 0; i < states.size(); ++i) {
      read(i);
      const Pose pose = tip_pose(arm, state);
      double* to = tips.data() + 16 * i;
      for (Eigen::Index row = 0; row < 3; ++row, to += 4) {
        for (Eigen::Index column = 0; column < 3; ++column) to[column] = pose.rotation(row, column);
        to[3] = pose.position[row];
      }
      to[0] = to[1] = to[2] = 0, to[3] = 1;
    }
  });
  std::vector<double> jacobians(6 * numbers * states.size());
  BackboneJacobian backbone;
  Jacobian J(6, numbers);
  print_time("jacobian", count, [&] {
    for (std::size_t i = 0; i < states.size(); ++i) {
      read(i);
      backbone.set(arm, state);
      backbone.tip(J);
      Eigen::Map<Eigen::Matrix<double, 6, numbers, Eigen::RowMajor>>(jacobians.data() + 6 * numbers * i) = J;
    }
  });
}

void time_kinematics(const Given& given) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections = {{.length = 0.3}, {.length = 0.25}, {.length = 0.2}};
  constexpr int count = 10000;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> bend(-1, 1);
  std::vector<ArmState> states(count, ArmState::straight(3));
  for (ArmState& state : states)
    for (auto& of : state.bends) of = {bend(random), bend(random)};
  std::vector<Pose> tips(count);
  print_time("tip_own", count, [&] {
    for (std::size_t i = 0; i < count; ++i) tips[i] = tip_pose(arm, states[i]);
  });
  std::vector<Jacobian> jacobians(count, Jacobian(6, 9));
  BackboneJacobian backbone;
  print_time("jacobian_own", count, [&] {
    for (std::size_t i = 0; i < count; ++i) {
      backbone.set(arm, states[i]);
      backbone.tip(jacobians[i]);
    }
  });
  time_arrays(arm, states);
  const ArmModel model(arm);
  double sum = 0;  // Keeps the results alive.
  print_time("inverse", static_cast<int>(given.positions.size()), [&] {
    for (const auto& position : given.positions)
      sum += solve_inverse(model, TipTarget{.position = {position[0], position[1], position[2]}}, {})
                 .position_error;
  });
  if (!(sum < 1)) fmt::print(stderr, "the inverse kinematics failed\n");
}

void time_steps(const ArmConfig& arm, const Given& given) {
  const Rod rod = rod_of(arm);
  const RodLoads loads = loads_of(arm);
  RodDynamics dynamics(rod);
  constexpr int count = 64;
  std::vector<TendonInput> inputs(count);
  for (std::size_t i = 0; i < count; ++i)
    inputs[i].tensions.assign(given.tensions[i].begin(), given.tensions[i].end());
  std::vector<RodState> states(count, dynamics.rest());
  const auto run = [&] {
    for (int k = 0; k < 20; ++k)
      for (std::size_t i = 0; i < count; ++i) dynamics.step(states[i], inputs[i], loads, 0.01);
  };
  for (int i = 0; i < 10; ++i) run();
  print_time("step", 20 * count, run);
}

void time_pictures(const Experiment& experiment) {
  Photographer photographer(experiment);
  const Camera camera(experiment.cameras().front());
  const View view = camera.view(camera.initial_stance());
  const Backbone backbone =
      experiment.arm_model().backbone({.bends = {{0.7, 0}, {0, 0.87}}, .stretches = {1, 1}});
  const Shot shot{.camera = 0,
                  .frame = 0,
                  .seed = 1,
                  .sensor = &camera.config().sensor,
                  .view = [&](double) { return view; },
                  .backbone = [&](double) { return backbone; }};
  Picture picture;
  print_time("picture", 10, [&] {
    for (int i = 0; i < 10; ++i) picture = photographer.take(shot);
  });
}

}  // namespace
}  // namespace flexura

int main(int count, char** arguments) {
  if (count != 4) {
    fmt::print(stderr, "usage: python_loops ELASTIC_ARM.toml EXPERIMENT_WITH_CAMERA.toml NUMBERS.txt\n");
    return 2;
  }
  const auto given = flexura::read_numbers(arguments[3]);
  if (!given) {
    fmt::print(stderr, "{}: expected 64 x 9 tensions and 200 x 3 positions\n", arguments[3]);
    return 2;
  }
  flexura::time_kinematics(*given);
  flexura::time_steps(flexura::load_experiment(arguments[1]).arm, *given);
  flexura::time_pictures(flexura::load_experiment(arguments[2]));
}
