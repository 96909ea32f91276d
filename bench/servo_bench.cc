// One control step: the features of two cameras' images and their derivatives, damped least squares on them;
// beside ViSP's vpServo on the same points.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/control/feature_images.h"
#include "flexura/control/image_law.h"
#include "flexura/servo/servo_features.h"
#include "tests/support/servo_views.h"
#include "tests/support/visp_peer.h"

namespace flexura {
namespace {

constexpr double step_time = 1.0 / 30;

const ArmState& goal() {
  static const ArmState state = {{{0.8, 0.3}, {-0.7, 0.9}, {1.0, -0.6}}, {1, 1, 1}};
  return state;
}

// The arm on its way there, over and over.
const std::vector<ArmState>& way() {
  constexpr int count = 64;
  static const std::vector<ArmState> states = [] {
    std::vector<ArmState> made;
    for (int i = 0; i < count; ++i) {
      ArmState& state = made.emplace_back(goal());
      for (Eigen::Vector2d& bend : state.bends) bend *= (i + 0.5) / count;
    }
    return made;
  }();
  return states;
}

// Argument: places along the arm; each is seen twice.
void points_step(benchmark::State& state) {
  const Arm arm = servo_arm();
  const std::array<View, 2> views = servo_views();
  FeatureImages images(arm, FeatureSet::of_points(static_cast<int>(state.range(0))));
  const ImageLaw law(arm, {});
  ImageLaw::Work work;
  ImageStep step;
  Eigen::VectorXd seen, desired, error;
  Eigen::MatrixXd by_state, J;
  if (!images.values(goal(), views, desired)) state.SkipWithError("the goal is not seen");
  std::size_t i = 0;
  for (auto _ : state) {
    const ArmState& here = way()[i++ % way().size()];
    if (!images.derive(here, views, seen, by_state)) state.SkipWithError("the arm is not seen");
    law.by_variables(by_state, J);
    feature_error(images.set(), seen, desired, error);
    law.step(here, error, J, step_time, work, step);
    benchmark::DoNotOptimize(step);
  }
  state.counters["image_points"] = static_cast<double>(2 * state.range(0));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(points_step)->Arg(12)->Arg(25)->Arg(50);

// Its first half: the features and their derivatives.
void points_features(benchmark::State& state) {
  const std::array<View, 2> views = servo_views();
  FeatureImages images(servo_arm(), FeatureSet::of_points(static_cast<int>(state.range(0))));
  Eigen::VectorXd seen;
  Eigen::MatrixXd by_state;
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(images.derive(way()[i++ % way().size()], views, seen, by_state));
    benchmark::ClobberMemory();
  }
}
BENCHMARK(points_features)->Arg(12)->Arg(25)->Arg(50);

// The same with what a servo looks at besides: what is wanted as the cameras would see it, and all of it
// through the interface that its laws share.
void as_used(benchmark::State& state) {
  const auto kind = static_cast<ServoLawKind>(state.range(0));
  const Arm arm = servo_arm();
  const std::array<View, 2> views = servo_views();
  const auto features = servo_features(kind, arm, 12);
  const ImageLaw law(arm, {});
  ImageLaw::Work work;
  ImageStep step;
  Eigen::MatrixXd J;
  std::size_t i = 0;
  Eigen::VectorXd seen, desired;
  FeatureError error;
  if (!features->predict(way()[20], views, seen)) {
    state.SkipWithError("not seen");
    return;
  }
  for (auto _ : state) {
    const ArmState& here = way()[i++ % way().size()];
    if (!features->predict(goal(), views, desired) || !features->error(seen, desired, here, views, error)) {
      state.SkipWithError("not seen");
      return;
    }
    law.by_variables(error.by_state, J);
    law.step(here, error.error, J, step_time, work, step);
    benchmark::DoNotOptimize(step);
  }
  state.SetLabel(names_of(&kind)[static_cast<std::size_t>(kind)]);
}
BENCHMARK(as_used)->DenseRange(0, 5);

// ViSP's of as many points: the images of `places` along the arm in both cameras, as one free camera's.
std::vector<VispPoint> visp_points(const ArmState& state, int places) {
  FeatureImages images(servo_arm(), FeatureSet::of_points(places));
  const std::array<View, 2> views = servo_views();
  Eigen::VectorXd values;
  (void)images.values(state, views, values);
  std::vector<VispPoint> points;
  for (const View& view : views) {
    for (Eigen::Index i = 0; i < images.points().count(); ++i) {
      const Eigen::Vector3d p_CP = view.X_WC.inverse() * images.points().place(i);
      points.push_back({p_CP.x() / p_CP.z(), p_CP.y() / p_CP.z(), p_CP.z()});
    }
  }
  return points;
}

void visp_step(benchmark::State& state) {
  const int places = static_cast<int>(state.range(0));
  VispServo servo(visp_points(goal(), places), 0.5);
  std::vector<std::vector<VispPoint>> seen;
  for (const ArmState& here : way()) seen.push_back(visp_points(here, places));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(servo.velocity(seen[i++ % seen.size()]));
  state.counters["image_points"] = static_cast<double>(2 * places);
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(visp_step)->Arg(12)->Arg(25)->Arg(50);

}  // namespace
}  // namespace flexura
