#include "flexura/camera/measured_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "flexura/base/table.h"

namespace flexura {
namespace {

Node numbers(std::initializer_list<double> values) {
  Node::Array entries;
  for (const double value : values) entries.push_back({value, {}});
  return {std::move(entries), {}};
}

Node camera_with(Node rotation) {
  return {Node::Table{{"fx", {}, {812.0, {}}},
                      {"cx", {}, {320.0, {}}},
                      {"cy", {}, {240.0, {}}},
                      {"position", {}, numbers({1, 2, 3})},
                      {"rotation", {}, std::move(rotation)}},
          {}};
}

TEST(MeasuredCamera, TakesRowsOrAQuaternionForItsRotation) {
  const Node rows{Node::Array{numbers({0, -1, 0}), numbers({1, 0, 0}), numbers({0, 0, 1})}, {}};
  const auto by_rows = read_as<MeasuredCamera>(camera_with(rows));
  const auto by_quaternion = read_as<MeasuredCamera>(camera_with(numbers({0.70710678, 0, 0, 0.70710678})));
  EXPECT_LT((by_rows.pose().rotation - by_quaternion.pose().rotation).norm(), 1e-7);
  EXPECT_LT((by_rows.pose() * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm(), 1e-12);
  EXPECT_EQ(by_rows.lens().intrinsics().fy, 812);
}

TEST(MeasuredCamera, RefusesWhatIsNoRotation) {
  const auto what = [](Node rotation) {
    try {
      (void)read_as<MeasuredCamera>(camera_with(std::move(rotation)));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_THAT(what(numbers({1, 1, 0, 0})), testing::HasSubstr("not a rotation (error"));
  EXPECT_THAT(what({Node::Array{numbers({1, 0, 0}), numbers({0, 1, 0}), numbers({0, 0, -1})}, {}}),
              testing::HasSubstr("not a rotation (error"));
  EXPECT_THAT(what(numbers({1, 0})), testing::HasSubstr("three rows"));
  EXPECT_THAT(what(numbers({0, 1, 0})), testing::HasSubstr("or a quaternion"));
}

TEST(MeasuredCamera, RefusesDistortionsOfNoLens) {
  Node camera = camera_with(numbers({1, 0, 0, 0}));
  camera.as<Node::Table>()->push_back({"distortion", {}, numbers({-0.1, 0.02, 0.001, -1e308, 0})});
  try {
    (void)read_as<MeasuredCamera>(camera);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("expected a number from -1"));
  }
}

}  // namespace
}  // namespace flexura
