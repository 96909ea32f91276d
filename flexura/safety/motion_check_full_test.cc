#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <string>

#include "tests/support/sampled_check.h"

namespace flexura {
namespace {

// 5 motions a case. studies/safety.sh asks for more by these variables.
std::size_t asked(const char* variable, std::size_t otherwise) {
  const char* value = std::getenv(variable);
  return value == nullptr ? otherwise : std::stoul(value);
}

TEST(MotionCheckFull, MissesNothingThatDenseSamplingFinds) {
  const std::size_t cases = asked("FLEXURA_SAFETY_CASES", 20);
  const SampledComparison found =
      compare_with_samples(static_cast<int>(cases), asked("FLEXURA_SAFETY_SAMPLES", 100'000));
  std::cout << "motions " << found.motions << "\nsamples " << found.samples << "\nspans " << found.spans
            << "\nabove " << found.above << "\nmissed " << found.missed << "\nrefuted " << found.refuted
            << '\n';
}

}  // namespace
}  // namespace flexura
