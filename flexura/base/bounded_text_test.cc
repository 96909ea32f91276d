#include "flexura/base/bounded_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace flexura {
namespace {

TEST(BoundedText, OfMeasurementsIsTheNumber) {
  EXPECT_EQ(bounded_text(0.1234, 1), "0.12");
  EXPECT_EQ(bounded_text(12.34, 100, 3), "12.3");
  EXPECT_EQ(bounded_text(1, 1), "1");
}

TEST(BoundedText, OfAFailedFitIsItsBound) {
  EXPECT_EQ(bounded_text(33856, 360), "more than 360");
  for (const double value :
       {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(bounded_text(value, 90), "more than 90");
}

}  // namespace
}  // namespace flexura
