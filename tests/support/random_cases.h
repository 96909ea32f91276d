#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>

namespace flexura {

/// Random numbers for tests, identical on every platform (the distributions of <random> are not).
class TestRandom {
 public:
  explicit TestRandom(std::uint64_t seed) : engine_(seed) {}

  /// Returns a number in [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  /// Returns an integer in [low, high], both included.
  int integer(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  /// Returns a vector with each component in [low, high).
  template <int n>
  Eigen::Vector<double, n> vector(double low, double high) {
    Eigen::Vector<double, n> result;
    for (double& component : result) component = uniform(low, high);
    return result;
  }

 private:
  std::mt19937_64 engine_;
};

/// Returns a normally distributed number (Box-Muller: G. Box, M. Muller).
inline double normal_number(TestRandom& random) {
  const double radius = std::sqrt(-2 * std::log(1 - random.uniform(0, 1)));
  return radius * std::cos(2 * std::numbers::pi * random.uniform(0, 1));
}

/// Returns the seed of a test's case: FNV-1a of the test's full name, plus the case number.
inline std::uint64_t case_seed(int index) {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : std::string(test->test_suite_name()) + "." + test->name()) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  }
  return hash + static_cast<std::uint64_t>(index);
}

// Sanitized builds run about thirty times slower, and the first cases find memory errors and races as well as
// later ones. The thread sanitizer needs even fewer cases.
#if defined(__SANITIZE_THREAD__)
inline constexpr int one_case_of = 12;
#elif defined(__SANITIZE_ADDRESS__)
inline constexpr int one_case_of = 4;
#else
inline constexpr int one_case_of = 1;
#endif

/// Calls body(TestRandom&) for `count` cases and stops at the first failing one, whose seed is shown. A
/// sanitized build runs one of `one_case_of` cases. FLEXURA_CASES=N in the environment multiplies the number
/// by N.
template <typename Body>
void for_random_cases(int count, Body&& body) {
  if (const char* times = std::getenv("FLEXURA_CASES")) count *= std::max(1, std::atoi(times));
  for (int index = 0; index < count && !testing::Test::HasFailure(); index += one_case_of) {
    const std::uint64_t seed = case_seed(index);
    SCOPED_TRACE("random case " + std::to_string(index) + ", seed " + std::to_string(seed));
    TestRandom random(seed);
    body(random);
  }
}

}  // namespace flexura
