#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace flexura {

/// Error statistics of the coverage of border pixels.
struct CoverageErrors {
  double squares = 0, largest = 0;
  int count = 0;

  void add(double error) {
    squares += error * error;
    largest = std::max(largest, std::abs(error));
    ++count;
  }
  [[nodiscard]] double rms() const { return std::sqrt(squares / std::max(1, count)); }

  /// Prints the statistics and checks them against the required accuracy, px.
  void expect_small(const char* name) const {
    std::printf("%s: %d border pixels: rms %.5f, largest %.5f px\n", name, count, rms(), largest);
    EXPECT_GT(count, 200);
    EXPECT_LT(rms(), 0.01) << name;
    EXPECT_LT(largest, 0.05) << name;
  }
};

/// Error statistics of the reference path and the fast path.
struct BothCoverageErrors {
  CoverageErrors exact, quick;

  void expect_small() const {
    exact.expect_small("exact");
    quick.expect_small("quick");
  }
};

}  // namespace flexura
