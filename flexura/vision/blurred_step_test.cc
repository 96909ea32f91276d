#include "flexura/vision/blurred_step.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/vision/curve_smoother.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

std::array<float, BlurredStep::taps> samples(double at, double blur, double low, double slope,
                                             double contrast) {
  std::array<float, BlurredStep::taps> values{};
  for (int i = 0; i < BlurredStep::taps; ++i) {
    const double x = i - BlurredStep::before - at, z = x / blur;
    const double step = 0.5 * (1 + std::erf(z / std::numbers::sqrt2));
    const double bell = std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
    values[static_cast<std::size_t>(i)] =
        static_cast<float>(low + slope * (x * (1 - step) - blur * bell) + contrast * step);
  }
  return values;
}

TEST(BlurredStep, FindsItsOwnStepWhateverTheBrightnesses) {
  for_random_cases(100, [](TestRandom& random) {
    const double blur = random.uniform(0.6, 1.6), phase = random.uniform(-0.5, 0.5);
    const double contrast = random.uniform(20, 200) * (random.integer(0, 1) == 0 ? 1 : -1);
    const BlurredStep step(blur, phase, 6);
    const double off = random.uniform(-0.1, 0.1);
    const StepFit fit =
        step.fit(samples(phase + off, blur, random.uniform(0, 50), random.uniform(-2, 2), contrast));
    EXPECT_NEAR(fit.offset, off, 0.004);
    EXPECT_NEAR(fit.contrast, contrast, 0.02 * std::abs(contrast));
  });
}

TEST(BlurredStep, SigmaIsTheScatterThatNoiseCauses) {
  TestRandom random(3);
  const BlurredStep step(0.76, 0.2, 5);
  double squares = 0;
  constexpr int count = 4000;
  for (int i = 0; i < count; ++i) {
    auto values = samples(0.2, 0.76, 20, 0.5, 100);
    for (float& value : values)
      for (int k = 0; k < 12; ++k) value += static_cast<float>(random.uniform(-1, 1));  // Of variance 4.
    const double offset = step.fit(values).offset;
    squares += offset * offset;
  }
  EXPECT_NEAR(std::sqrt(squares / count), step.sigma() * 2 / 100, 0.05 * step.sigma() * 2 / 100);
}

TEST(CurveSmoother, LeavesAParabolaAndBridgesWhatIsMissing) {
  std::vector<CurveSmoother::Values> values;
  std::vector<double> weights, strengths(60, 200.0);
  for (int i = 0; i < 60; ++i) {
    values.emplace_back(0.01 * i * i, 3.0 - i, 7.0);
    weights.push_back(i > 20 && i < 35 ? 0 : 1);
  }
  const auto before = values;
  for (std::size_t i = 21; i < 35; ++i) values[i].setConstant(1000);
  CurveSmoother smoother;
  smoother.smooth(values, weights, strengths);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_LT((values[i] - before[i]).norm(), 1e-3) << i;
}

}  // namespace
}  // namespace flexura
