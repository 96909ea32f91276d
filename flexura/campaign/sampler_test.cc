#include "flexura/campaign/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "flexura/campaign/parameter.h"
#include "flexura/campaign/sobol.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr double full = 4294967296.0;

// Returns the square of the centred L2 discrepancy (F. Hickernell, Mathematics of Computation 67, 1998).
double centred_discrepancy(const std::vector<std::vector<double>>& points) {
  const auto n = static_cast<double>(points.size()), d = static_cast<double>(points.front().size());
  double single = 0, pairs = 0;
  for (const auto& x : points) {
    double product = 1;
    for (const double u : x) product *= 1 + 0.5 * std::abs(u - 0.5) - 0.5 * (u - 0.5) * (u - 0.5);
    single += product;
    for (const auto& y : points) {
      double both = 1;
      for (std::size_t k = 0; k < x.size(); ++k)
        both *= 1 + 0.5 * std::abs(x[k] - 0.5) + 0.5 * std::abs(y[k] - 0.5) - 0.5 * std::abs(x[k] - y[k]);
      pairs += both;
    }
  }
  return std::pow(13.0 / 12, d) - 2 / n * single + pairs / (n * n);
}

std::vector<std::vector<double>> points_of(const Sampler& sampler, std::size_t dimensions) {
  std::vector<std::vector<double>> points(sampler.count, std::vector<double>(dimensions));
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = 0; k < dimensions; ++k) points[i][k] = sampler.at(k, i);
  return points;
}

// The published points are in the order of the Gray code.
TEST(Sobol, HasThePublishedPoints) {
  const auto gray = [](std::size_t dimension, std::uint32_t i) {
    return sobol(dimension, i ^ (i >> 1)) / full;
  };
  // S. Joe, F. Kuo, program sobol.cc, dimensions 1 to 4.
  constexpr std::array<std::array<double, 4>, 8> published{{{0, 0, 0, 0},
                                                            {0.5, 0.5, 0.5, 0.5},
                                                            {0.75, 0.25, 0.25, 0.25},
                                                            {0.25, 0.75, 0.75, 0.75},
                                                            {0.375, 0.375, 0.625, 0.875},
                                                            {0.875, 0.875, 0.125, 0.375},
                                                            {0.625, 0.125, 0.875, 0.625},
                                                            {0.125, 0.625, 0.375, 0.125}}};
  for (std::uint32_t i = 0; i < published.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(gray(k, i), published[i][k]) << i << " " << k;
}

TEST(Sobol, HasOnePointInEachIntervalOfEachDimension) {
  for (std::size_t k = 0; k < most_sobol_dimensions; ++k) {
    for (unsigned bits = 0; bits <= 10; ++bits) {
      std::set<std::uint32_t> intervals;
      for (std::uint32_t i = 0; i < (1U << bits); ++i)
        intervals.insert(bits == 0 ? 0 : sobol(k, i) >> (32 - bits));
      ASSERT_EQ(intervals.size(), 1U << bits) << k;
    }
  }
  EXPECT_THROW((void)sobol(most_sobol_dimensions, 0), std::out_of_range);
}

// The first two dimensions form a (0, m, 2)-net: one point in each elementary rectangle.
TEST(Sobol, HasOnePointInEachElementaryRectangleOfTwoDimensions) {
  constexpr unsigned m = 8;
  for (unsigned a = 0; a <= m; ++a) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> cells;
    for (std::uint32_t i = 0; i < (1U << m); ++i)
      cells.insert({a == 0 ? 0 : sobol(0, i) >> (32 - a), a == m ? 0 : sobol(1, i) >> (32 - (m - a))});
    EXPECT_EQ(cells.size(), 1U << m) << a;
  }
}

TEST(Sampler, LatinHypercubeHasOneSampleInEachInterval) {
  for_random_cases(50, [](TestRandom& random) {
    const auto count = static_cast<std::uint64_t>(random.integer(1, 700));
    const Sampler sampler{Sampling::latin_hypercube, static_cast<std::uint64_t>(random.integer(0, 1000000)),
                          count};
    for (std::size_t k = 0; k < 4; ++k) {
      std::set<std::uint64_t> intervals;
      for (std::uint64_t i = 0; i < count; ++i) {
        const double u = sampler.at(k, i);
        EXPECT_GT(u, 0);
        EXPECT_LT(u, 1);
        intervals.insert(static_cast<std::uint64_t>(u * static_cast<double>(count)));
      }
      EXPECT_EQ(intervals.size(), count);
      EXPECT_EQ(*intervals.rbegin(), count - 1);
    }
  });
}

TEST(Sampler, PermutationsAreBijectiveAndDiffer) {
  for_random_cases(100, [](TestRandom& random) {
    const auto count = static_cast<std::uint64_t>(random.integer(1, 3000));
    const auto key = static_cast<std::uint64_t>(random.integer(0, 1 << 30));
    std::set<std::uint64_t> images;
    std::uint64_t equal = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t image = permuted(i, count, key);
      EXPECT_LT(image, count);
      images.insert(image);
      if (image == permuted(i, count, key + 1)) ++equal;
    }
    EXPECT_EQ(images.size(), count);
    EXPECT_TRUE(count <= 100 || equal < count / 2) << equal;
  });
}

// Of 4 x 256 points: random points have about 5 times the discrepancy of Sobol points.
TEST(Sampler, SobolPointsAreMoreEvenThanRandomOnes) {
  for_random_cases(12, [](TestRandom& random) {
    const auto seed = static_cast<std::uint64_t>(random.integer(0, 1000000));
    const auto off = [&](Sampling sampling) {
      return centred_discrepancy(points_of({sampling, seed, 256}, 4));
    };
    EXPECT_LT(off(Sampling::sobol), 0.2 * off(Sampling::random));
    EXPECT_LT(off(Sampling::latin_hypercube), off(Sampling::random));
  });
}

TEST(Sampler, SeedsAndDimensionsAreIndependent) {
  for (const Sampling sampling : {Sampling::random, Sampling::latin_hypercube, Sampling::sobol}) {
    constexpr std::uint64_t count = 4096;
    const Sampler a{sampling, 1, count}, b{sampling, 2, count};
    double ab = 0, dimensions = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      ab += (a.at(0, i) - 0.5) * (b.at(1, i) - 0.5);
      dimensions += (a.at(0, i) - 0.5) * (a.at(1, i) - 0.5);
    }
    // The standard deviation of the correlation of independent numbers is 1 / 64.
    EXPECT_LT(std::abs(12 * ab / count), 0.1);
    EXPECT_LT(std::abs(12 * dimensions / count), 0.1);
  }
}

TEST(NormalQuantile, InvertsTheDistribution) {
  EXPECT_NEAR(normal_quantile(0.5), 0, 1e-16);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14);
  EXPECT_NEAR(normal_quantile(1e-300), -37.0471, 1e-3);
  for_random_cases(2000, [](TestRandom& random) {
    const double p = std::pow(10, random.uniform(-300, std::log10(0.5)));
    const double x = normal_quantile(p);
    // The error of x by that of p: x changes by dp / density.
    EXPECT_NEAR(0.5 * std::erfc(-x / std::numbers::sqrt2) / p, 1, 1e-13 * (1 + x * x));
    const double other = p > 1e-10 ? normal_quantile(1 - p) : -x;
    EXPECT_NEAR(other, -x, 1e-5);
  });
}

// Mean and variance of a parameter's distribution by the midpoint rule over its quantiles.
std::pair<double, double> moments_of(const ParameterConfig& parameter) {
  constexpr int count = 100000;
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const double value = *quantile(parameter, (i + 0.5) / count).as<double>();
    sum += value, squares += value * value;
  }
  const double mean = sum / count;
  return {mean, squares / count - mean * mean};
}

TEST(Parameter, DistributionsHaveTheirMoments) {
  for_random_cases(5, [](TestRandom& random) {
    const double low = random.uniform(0.1, 3), high = low + random.uniform(0.1, 5);
    const auto [mean, variance] = moments_of(UniformParameter{{}, low, high});
    EXPECT_NEAR(mean, (low + high) / 2, 1e-6);
    EXPECT_NEAR(variance, std::pow(high - low, 2) / 12, 1e-6);
    const auto [log_mean, log_variance] = moments_of(LogUniformParameter{{}, low, high});
    const double ratio = std::log(high / low), expected = (high - low) / ratio;
    EXPECT_NEAR(log_mean, expected, 1e-6);
    EXPECT_NEAR(log_variance, (high * high - low * low) / (2 * ratio) - expected * expected, 1e-6);
    const double sigma = random.uniform(0.1, 2);
    const auto [normal_mean, normal_variance] = moments_of(NormalParameter{{}, low, sigma, {}, {}});
    EXPECT_NEAR(normal_mean, low, 1e-9);
    EXPECT_NEAR(normal_variance, sigma * sigma, 2e-4 * sigma * sigma);
    // Cut off at the mean: half a normal distribution.
    const auto [half_mean, half_variance] = moments_of(NormalParameter{{}, low, sigma, low, {}});
    EXPECT_NEAR(half_mean, low + sigma * std::sqrt(2 / std::numbers::pi), 1e-4 * sigma);
    EXPECT_NEAR(half_variance, sigma * sigma * (1 - 2 / std::numbers::pi), 1e-3 * sigma * sigma);
  });
}

TEST(Parameter, IntegersAreEquallyFrequent) {
  const IntegerParameter dice{{}, 1, 6};
  std::array<int, 7> counts{};
  for (int i = 0; i < 6000; ++i)
    ++counts.at(
        static_cast<std::size_t>(*quantile(ParameterConfig(dice), (i + 0.5) / 6000).as<std::int64_t>()));
  for (std::size_t i = 1; i <= 6; ++i) EXPECT_EQ(counts[i], 1000);
}

TEST(Parameter, GridsIncludeBothEnds) {
  const ParameterConfig even = GridParameter{{}, 0, 1, 5, false},
                        decades = GridParameter{{}, 0.01, 100, 5, true};
  EXPECT_EQ(*grid_value(even, 1).as<double>(), 0.25);
  EXPECT_EQ(*grid_value(even, 4).as<std::int64_t>(), 1);
  EXPECT_EQ(*grid_value(decades, 0).as<double>(), 0.01);
  EXPECT_NEAR(*grid_value(decades, 1).as<double>(), 0.1, 1e-15);
  EXPECT_EQ(*grid_value(decades, 4).as<std::int64_t>(), 100);
}

}  // namespace
}  // namespace flexura
