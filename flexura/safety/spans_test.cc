#include "flexura/safety/spans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

const SpanSearch fine{.time = 1e-7, .value = 1e-7};

TEST(Spans, FindWhatRisesAboveALimitFromStartToEnd) {
  const auto sine = with_rate([](double t) { return std::sin(t); }, [](double, double) { return 1.0; });
  const std::vector<Span> spans = spans_above(0.5, sine, {0, 10}, fine).spans;
  ASSERT_EQ(spans.size(), 2u);
  using std::numbers::pi;
  EXPECT_NEAR(spans[0].start, pi / 6, 1e-7);
  EXPECT_NEAR(spans[0].end, 5 * pi / 6, 1e-7);
  EXPECT_NEAR(spans[1].start, 2 * pi + pi / 6, 1e-7);
  EXPECT_NEAR(spans[1].end, 2 * pi + 5 * pi / 6, 1e-7);
}

TEST(Spans, FindANeedleThatNoGridWouldHit) {
  for_random_cases(100, [](TestRandom& random) {
    const double at = random.uniform(0, 10);
    constexpr double width = 1e-5;
    const auto needle = with_rate([at](double t) { return 1 - std::abs(t - at) / width; },
                                  [](double, double) { return 1 / width; });
    const std::vector<Span> spans = spans_above(0, needle, {0, 10}, {1e-7, 1e-7, 4'000'000}).spans;
    ASSERT_EQ(spans.size(), 1u);
    EXPECT_NEAR(spans[0].start, std::max(0.0, at - width), 1e-7);
    EXPECT_NEAR(spans[0].end, std::min(10.0, at + width), 1e-7);
  });
}

TEST(SpanText, TellsStartAndEndApart) {
  EXPECT_EQ(span_text({0, 2.5}), "0 s to 2.5 s");
  EXPECT_EQ(span_text({1, 1 + 3e-9}), "1 s to 1.000000003 s");
  EXPECT_EQ(span_text({0.123456789, 0.1234567891}), "0.123456789 s to 0.1234567891 s");
  EXPECT_EQ(span_text({86400, 86400.04}), "86400 s to 86400.04 s");
  EXPECT_EQ(span_text({1, std::nextafter(1, 2)}), "1 s to 1.0000000000000002 s");
  EXPECT_EQ(span_text({1, 1}), "at 1 s");
  EXPECT_EQ(span_text({0.5, 0.5}, 3), "at 3.5 s");
}

TEST(Spans, WhatTouchesTheLimitIsNotAboveIt) {
  const auto sine = with_rate([](double t) { return std::sin(t); }, [](double, double) { return 1.0; });
  EXPECT_TRUE(spans_above(1.0, sine, {0, 10}, {1e-3, 1e-3}).spans.empty());
  const auto even = with_rate([](double) { return 2.0; }, [](double, double) { return 0.0; });
  EXPECT_TRUE(spans_above(2.0, even, {0, 10}, fine).spans.empty());
}

TEST(Spans, AnInstantIsJudgedByItsValue) {
  const auto even = with_rate([](double) { return 2.0; }, [](double, double) { return 1e9; });
  EXPECT_TRUE(spans_above(2.0, even, {3, 3}, fine).spans.empty());
  EXPECT_EQ(spans_above(1.9, even, {3, 3}, fine).spans.size(), 1u);
}

TEST(Spans, WhatIsFarAboveTheLimitIsFoundHoweverShort) {
  const auto needle = with_rate([](double t) { return t < 3 || t > 3 + 2e-9 ? 0.0 : 1.0; },
                                [](double a, double b) { return a <= 3 + 2e-9 && b >= 3 ? 1e12 : 0.0; });
  const std::vector<Span> spans = spans_above(0.5, needle, {0, 10}, fine).spans;
  ASSERT_EQ(spans.size(), 1u);
  EXPECT_NEAR(spans[0].start, 3, fine.time);
  EXPECT_NEAR(spans[0].end, 3 + 2e-9, fine.time);
}

TEST(Spans, AreSampledEvenlyWhereThereAreTooManyToLookInto) {
  std::size_t asked = 0;
  const WatchedQuantity near{[](double t) { return t > 5 && t < 5.1 ? 2.0 : 0.0; },
                             [&asked](double, double) {
                               ++asked;
                               return QuantityBounds{0, 3};
                             }};
  const FoundSpans found = spans_above(1, near, {0, 8}, {1e-7, 1e-7, 1000});
  EXPECT_EQ(asked, 511u) << "1 + 2 + ... + 256; 512 more are too many";
  ASSERT_TRUE(found.undecided);
  EXPECT_EQ(found.undecided->start, 0);
  EXPECT_EQ(found.undecided->end, 8);
  EXPECT_EQ(found.sampled_every, 8. / 512 / 2);
  ASSERT_EQ(found.spans.size(), 1u);
  EXPECT_NEAR(found.spans[0].start, 5, 0.02);
  EXPECT_NEAR(found.spans[0].end, 5.1, 0.02);
}

// Quantities that are above 0 for a moment around their number; the last one is never decided.
class Moments : public WatchedQuantities {
 public:
  [[nodiscard]] std::size_t count() const override { return 4; }
  void find_values(double time, std::span<const std::size_t> which, std::span<double> values) const override {
    for (std::size_t k = 0; k < which.size(); ++k) values[k] = value(which[k], time);
  }
  void find_bounds(const Span& span, std::span<const std::size_t> which,
                   std::span<QuantityBounds> bounds) const override {
    const double half = (span.end - span.start) / 2;
    for (std::size_t k = 0; k < which.size(); ++k) {
      const double middle = value(which[k], span.start + half);
      const double around = which[k] < 3 ? half : 10;
      bounds[k] = {middle - around, middle + around};
    }
  }

 private:
  static double value(std::size_t i, double time) {
    return i < 3 ? 0.01 - std::abs(time - 1 - static_cast<double>(i)) : -1;
  }
};

TEST(Spans, AreFoundForEachOfSeveralQuantities) {
  SpanSearch search{1e-7, 1e-7, 1000};
  const std::vector<FoundSpans> found = spans_above(0, Moments{}, {0, 5}, search);
  ASSERT_EQ(found.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(found[i].spans.size(), 1u);
    EXPECT_NEAR(found[i].spans[0].start, 1 + static_cast<double>(i) - 0.01, 1e-6);
    EXPECT_NEAR(found[i].spans[0].end, 1 + static_cast<double>(i) + 0.01, 1e-6);
    EXPECT_FALSE(found[i].undecided);
  }
  EXPECT_TRUE(found[3].spans.empty());
  ASSERT_TRUE(found[3].undecided);
  EXPECT_EQ(found[3].undecided->end, 5);
  // One quantity's intervals must not reduce those of the others.
  search.most_together = 1000;
  const std::vector<FoundSpans> shared = spans_above(0, Moments{}, {0, 5}, search);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(shared[i].undecided);
  EXPECT_TRUE(shared[3].undecided);
}

TEST(Spans, EndWhenAsked) {
  std::vector<double> reported;
  const SpanSearch search{1e-7, 1e-7, 100'000, 100'000, [&](double decided) {
                            reported.push_back(decided);
                            return reported.size() < 3;
                          }};
  (void)spans_above(0, Moments{}, {0, 5}, search);
  ASSERT_EQ(reported.size(), 3u);
  EXPECT_TRUE(std::ranges::is_sorted(reported));
  EXPECT_GT(reported[0], 0.7) << "three of the four are decided soon";
}

}  // namespace
}  // namespace flexura
