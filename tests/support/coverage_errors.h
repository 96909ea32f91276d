#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace flexura {

/// What drawn pixels are off by.
struct CoverageErrors {
  double squares = 0, largest = 0;
  int count = 0;

  void add(double error) {
    squares += error * error;
    largest = std::max(largest, std::abs(error));
    ++count;
  }
  [[nodiscard]] double rms() const { return std::sqrt(squares / std::max(1, count)); }

  /// Prints them, and holds them to what was asked for, px.
  void expect_small(const char* name) const {
    std::printf("%s: %d border pixels: rms %.5f, largest %.5f px\n", name, count, rms(), largest);
    EXPECT_GT(count, 200);
    EXPECT_LT(rms(), 0.01) << name;
    EXPECT_LT(largest, 0.05) << name;
  }
};

/// Of both ways to draw.
struct BothCoverageErrors {
  CoverageErrors exact, quick;

  void expect_small() const {
    exact.expect_small("exact");
    quick.expect_small("quick");
  }
};

}  // namespace flexura
