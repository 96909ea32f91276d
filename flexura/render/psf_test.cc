#include "flexura/render/psf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

namespace flexura {
namespace {

TEST(Psf, HasUnitSumAndTheVarianceAskedFor) {
  for (const double deviation : {0.01, 0.1, 0.3, 0.5, 0.7, 1.0, 2.5, 20.0}) {
    const std::vector<float> weights = psf_weights(deviation);
    double sum = weights[0], variance = 0;
    for (std::size_t i = 1; i < weights.size(); ++i) {
      const auto distance = static_cast<double>(i);
      sum += 2.0 * weights[i];
      variance += 2.0 * weights[i] * distance * distance;
      EXPECT_LT(weights[i], weights[i - 1]) << deviation;
    }
    EXPECT_NEAR(sum, 1, 1e-6) << deviation;
    EXPECT_NEAR(variance, deviation * deviation, 1e-6 * (1 + deviation * deviation)) << deviation;
  }
}

TEST(Psf, ReachesThreeAndAHalfDeviations) {
  EXPECT_EQ(psf_weights(0).size(), 1u);
  EXPECT_EQ(psf_weights(0.2).size(), 2u);
  EXPECT_EQ(psf_weights(2).size(), 8u);
}

}  // namespace
}  // namespace flexura
