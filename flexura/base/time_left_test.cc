#include "flexura/base/time_left.h"

#include <gtest/gtest.h>

namespace flexura {
namespace {

TEST(TimeLeft, IsInProportionToWhatIsDone) {
  TimeLeft left;
  EXPECT_EQ(left.at(0.01, 5), std::nullopt) << "too little is done";
  EXPECT_EQ(left.at(0.5, 0.5), std::nullopt) << "too early";
  EXPECT_DOUBLE_EQ(left.at(0.5, 10).value(), 10);
  EXPECT_DOUBLE_EQ(left.at(0.75, 15).value(), 5);
  EXPECT_EQ(left.at(0.0, 20), std::nullopt) << "the next part of the job";
  EXPECT_DOUBLE_EQ(left.at(0.1, 22).value(), 18);
}

}  // namespace
}  // namespace flexura
