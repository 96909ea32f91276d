// Benchmarks of fitting the tube to two pictures of 640 x 480 px, in colour, in front of clutter
// (docs/estimation.md, "Model-based"): from a guess, and from about the last picture's shape.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flexura/estimate/tube_fit.h"
#include "tests/support/cluttered_arms.h"

namespace flexura {
namespace {

// Returns a few arms, made once and always the same.
const std::vector<ClutteredArm>& cluttered_arms() {
  static const std::vector<ClutteredArm> made = [] {
    std::vector<ClutteredArm> arms;
    for (std::uint64_t i = 0; i < 8; ++i) {
      TestRandom random(2000 + i);
      arms.push_back(cluttered_arm(random, {}));
    }
    return arms;
  }();
  return made;
}

// First argument: standard deviation of the start's bends, mrad. Second: whether the background is known.
// Counters: share of the fits that are trusted, and the median distance of their axes from the truth.
void fit_tube(benchmark::State& state) {
  if (clutter_files().empty()) {
    state.SkipWithError("the packages opencv-doc and visp-images-data are missing");
    return;
  }
  const double guess_std = 1e-3 * static_cast<double>(state.range(0));
  std::vector<double> errors;
  std::size_t i = 0, trusted = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const ClutteredArm& arm = cluttered_arms()[i % cluttered_arms().size()];
    TestRandom random(3000 + i++);
    const ShapePrior prior{.arm = arm.shape.bent.arm};
    std::array<ArmScene, 2> scenes;
    std::vector<TubePicture> pictures;
    for (std::size_t j = 0; j < 2; ++j) {
      scenes[j].background = arm.backgrounds[j];
      pictures.push_back(
          {&arm.shape.pictures[j], arm.shape.views[j], {}, state.range(1) != 0 ? &scenes[j] : nullptr});
    }
    const Shape guess = guessed_shape(random, arm.shape.bent, guess_std);
    const ShapePrediction start = rough_prediction(prior, guess, guess_std, std::vector<ViewPrior>(2));
    TubeFitter fitter(prior);
    state.ResumeTiming();
    const TubeFit fit = fitter.fit(pictures, start);
    state.PauseTiming();
    if (fit.estimate.is_trusted()) {
      ++trusted;
      for (std::size_t j = 0; j < 2; ++j) {
        const auto off = image_errors(fit.estimate.shape, arm.shape.views[j], arm.truth[j]);
        errors.insert(errors.end(), off.begin(), off.end());
      }
    }
    state.ResumeTiming();
  }
  state.counters["trusted"] = static_cast<double>(trusted) / static_cast<double>(state.iterations());
  if (errors.empty()) return;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::ranges::nth_element(errors, middle);
  state.counters["median_px"] = *middle;
}
BENCHMARK(fit_tube)
    ->ArgsProduct({{20, 100}, {0, 1}})
    ->ArgNames({"mrad", "background"})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flexura
