#include "flexura/math/arrays.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace flexura {
namespace {

using ::testing::HasSubstr;

TEST(Quaternion, OfAFileHasALengthOfOneOrSo) {
  EXPECT_EQ(quaternion_problem({0.5, -0.5, 0.5, 0.5}), "");
  EXPECT_EQ(quaternion_problem({0.7071, 0, 0.7071, 0}), "");
  EXPECT_THAT(quaternion_problem({1, 0, 0, 1}), HasSubstr("has the norm 1.41421: expected a unit"));
  EXPECT_NE(quaternion_problem({0, 0, 0, 0}), "");
  EXPECT_NE(quaternion_problem({std::numeric_limits<double>::quiet_NaN(), 0, 0, 1}), "");
}

TEST(Quaternion, TurnsAsItsAxisAndAngleSay) {
  const double half = 0.25;  // A rotation by 0.5 about y.
  const Eigen::Vector3d turned =
      rotation_of({2 * std::cos(half), 0, 2 * std::sin(half), 0}) * Eigen::Vector3d::UnitZ();
  EXPECT_LE((turned - Eigen::Vector3d(std::sin(0.5), 0, std::cos(0.5))).norm(), 1e-15);
}

}  // namespace
}  // namespace flexura
