#include "flexura/kinematics/simd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "flexura/kinematics/simd_kernels.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

struct Curves {
  std::vector<double> sines, cosines;
};

Curves curves_of(const std::vector<double>& angles, SimdPath path) {
  Curves curves{std::vector<double>(angles.size()), std::vector<double>(angles.size())};
  sines_and_cosines(angles, curves.sines, curves.cosines, path);
  return curves;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.empty() || std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0;
}

// The error in units in the last place of the value. The reference has 64 bits, on x86-64 at least.
double error_in_ulp(double value, long double expected) {
  const double magnitude = std::max(std::abs(static_cast<double>(expected)), 1e-300);
  const double ulp = std::nextafter(magnitude, 2.0 * magnitude) - magnitude;
  return static_cast<double>(std::abs(static_cast<long double>(value) - expected) /
                             static_cast<long double>(ulp));
}

// Multiples of pi/4 and their neighbours, up to the end of the range, are the worst that a reduction of the
// argument can meet.
std::vector<double> edges() {
  std::vector<double> angles = {0.0, 5e-324, 1e-310, 1e-300, 1e-30, 1e-12, 1e-8, 1e6, -1e6};
  for (int n = -1270000; n <= 1270000; n += n > -3000 && n < 3000 ? 1 : 97) {
    const double multiple = n * (std::numbers::pi / 4);
    angles.push_back(multiple);
    angles.push_back(std::nextafter(multiple, 1e9));
    angles.push_back(std::nextafter(multiple, -1e9));
  }
  return angles;
}

std::vector<double> random_angles(TestRandom& random, int count) {
  std::vector<double> angles;
  for (int i = 0; i < count; ++i) {
    const double size = std::pow(10.0, random.uniform(-12.0, 6.0));
    angles.push_back(random.integer(0, 1) == 1 ? size : -size);
    angles.push_back(random.uniform(-10.0, 10.0));
  }
  return angles;
}

void expect_exact(const std::vector<double>& angles) {
  const Curves curves = curves_of(angles, best_simd_path());
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double limit = std::abs(angles[i]) <= 10.0 ? 1.5 : 2.5;
    const auto angle = static_cast<long double>(angles[i]);
    ASSERT_LE(error_in_ulp(curves.sines[i], std::sin(angle)), limit) << angles[i];
    ASSERT_LE(error_in_ulp(curves.cosines[i], std::cos(angle)), limit) << angles[i];
  }
}

TEST(Simd, SinesAndCosinesAreWithinTwoAndAHalfUnitsInTheLastPlaceAtTheEdges) { expect_exact(edges()); }

TEST(Simd, SinesAndCosinesAreWithinTwoAndAHalfUnitsInTheLastPlaceAtRandom) {
  for_random_cases(20, [](TestRandom& random) { expect_exact(random_angles(random, 10000)); });
}

TEST(Simd, SinesAndCosinesAreTheSameBitsOnEveryPathForEveryTail) {
  for_random_cases(20, [](TestRandom& random) {
    for (int pairs = 0; pairs <= 18; ++pairs) {
      std::vector<double> angles = random_angles(random, pairs);
      if (random.integer(0, 1) == 1) angles.push_back(1e7);
      const Curves expected = curves_of(angles, SimdPath::baseline);
      for (const SimdPath path : available_simd_paths()) {
        const Curves curves = curves_of(angles, path);
        EXPECT_TRUE(same_bits(curves.sines, expected.sines)) << name_of(path);
        EXPECT_TRUE(same_bits(curves.cosines, expected.cosines)) << name_of(path);
      }
    }
  });
}

TEST(Simd, FarAnglesAreTheLibrarysAndLeaveTheirNeighboursAlone) {
  const std::vector<double> near = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
  const Curves expected = curves_of(near, SimdPath::baseline);
  for (const SimdPath path : available_simd_paths()) {
    for (const double far : {1.0000001e6, -3e9, 1e22, std::numeric_limits<double>::max()}) {
      std::vector<double> angles = near;
      angles[5] = far;
      const Curves curves = curves_of(angles, path);
      EXPECT_EQ(curves.sines[5], std::sin(far));
      EXPECT_EQ(curves.cosines[5], std::cos(far));
      EXPECT_EQ(curves.sines[4], expected.sines[4]);
      EXPECT_EQ(curves.cosines[6], expected.cosines[6]);
    }
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      const Curves curves = curves_of({bad, 0.2, 0.3, bad, 0.5, 0.6, 0.7, -bad}, path);
      for (const std::size_t i : {0u, 3u, 7u}) {
        EXPECT_TRUE(std::isnan(curves.sines[i]));
        EXPECT_TRUE(std::isnan(curves.cosines[i]));
      }
      EXPECT_EQ(curves.sines[4], expected.sines[4]);
    }
  }
}

TEST(Simd, EveryPathIsAsWideAsItsName) {
  EXPECT_EQ(kernels_of(SimdPath::baseline).many.lanes, 4u);
  EXPECT_EQ(available_simd_paths().front(), SimdPath::baseline);
  for (const SimdPath path : available_simd_paths()) {
    EXPECT_EQ(kernels_of(path).one.lanes, 1u);
    if (path == SimdPath::avx2) {
      EXPECT_EQ(kernels_of(path).many.lanes, 8u);
    } else if (path == SimdPath::avx512) {
      EXPECT_EQ(kernels_of(path).many.lanes, 16u);
    }
  }
}

TEST(Simd, RefusesSpansOfOtherSizesAndPathsThatAreNotThere) {
  const std::vector<double> angles(4);
  std::vector<double> four(4), three(3);
  EXPECT_THROW(sines_and_cosines(angles, three, four), std::invalid_argument);
  EXPECT_THROW(sines_and_cosines(angles, four, three), std::invalid_argument);
  const std::vector<SimdPath> paths = available_simd_paths();
  for (const SimdPath path : {SimdPath::avx2, SimdPath::avx512}) {
    const bool is_there = std::ranges::find(paths, path) != paths.end();
    if (!is_there) {
      EXPECT_THROW(sines_and_cosines(angles, four, four, path), std::invalid_argument);
    }
  }
}

}  // namespace
}  // namespace flexura
