#include "flexura/view/seeing_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "flexura/view/request.h"
#include "flexura/view/session.h"

namespace flexura {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(SeeingChoice, ReplacesRegionAndColorButKeepsTheBackground) {
  auto given = std::make_shared<ArmScene>();
  given->region = {{1, 1}, {2, 1}, {2, 2}};
  given->color = Eigen::Vector3d(1, 2, 3);
  given->background = Image<std::uint8_t>(4, 3);
  SeeingChoice choice;
  choice.region = {{10, 20}, {30, 40}};
  const auto scene = chosen_scene(given, choice);
  ASSERT_NE(scene, nullptr);
  ASSERT_EQ(scene->region.size(), 4) << "two corners are a rectangle";
  EXPECT_EQ(scene->region[1], Eigen::Vector2d(30, 20));
  EXPECT_FALSE(scene->color);
  EXPECT_EQ(scene->background.width(), 4);
  choice = {};
  choice.color = {200, 30, 40};
  EXPECT_EQ(*chosen_scene(nullptr, choice)->color, Eigen::Vector3d(200, 30, 40));
  EXPECT_EQ(chosen_scene(nullptr, {}), nullptr) << "nothing separates the arm";
  EXPECT_TRUE(chosen_scene(given, {})->region.empty());
}

TEST(SeeingChoice, TakesTheMedianColorAroundAPixel) {
  Image<std::uint8_t> picture(8, 6, 3);
  for (int v = 0; v < 6; ++v)
    for (int u = 0; u < 8; ++u)
      for (int c = 0; c < 3; ++c) picture.at(u, v, c) = static_cast<std::uint8_t>(40 * (c + 1));
  for (int c = 0; c < 3; ++c) picture.at(3, 3, c) = 255;  // A hot pixel.
  EXPECT_THAT(color_at(picture, 3, 3), ElementsAre(40, 80, 120));
  EXPECT_THAT(color_at(picture, 0, 5), ElementsAre(40, 80, 120)) << "at the picture's border";
  for (const auto& [u, v] : {std::pair{-1, 0}, {0, -1}, {8, 0}, {0, 6}})
    EXPECT_THROW((void)color_at(picture, u, v), std::out_of_range);
  EXPECT_THROW((void)color_at(Image<std::uint8_t>(8, 6), 3, 3), ViewRefusal) << "gray";
}

TEST(SeeingChoice, ReplacesWhatAnExperimentHas) {
  const Experiment given = parse_experiment(R"(
[arm]
kind = "planar"
[[arm.section]]
length = 1
[[camera]]
name = "a"
mount = { position = [0, 0.5, 2.2], look_at = [0, 0.5, 0] }
sensor = { pixels = "color" }
[[camera]]
name = "b"
mount = { position = [-2.2, 0.5, 0], look_at = [0, 0.5, 0] }
[[seeing]]
camera = "a"
region = [[1, 1], [90, 90]]
color = [1, 2, 3]
[[task]]
kind = "hold"
duration = 1
)",
                                            "file");
  std::vector<CameraSeeingChoice> choices(1);
  choices[0].camera = "b";
  choices[0].region = {{5, 5}, {60, 70}};
  Experiment changed = with_choices(given, choices);
  ASSERT_EQ(changed.seeing.size(), 2);
  EXPECT_EQ(changed.seeing[1].camera, "b");
  EXPECT_EQ(changed.seeing[1].region, choices[0].region);
  choices[0].camera = "a";
  changed = with_choices(given, choices);
  ASSERT_EQ(changed.seeing.size(), 1);
  EXPECT_EQ(changed.seeing[0].region, choices[0].region);
  EXPECT_FALSE(changed.seeing[0].color);
  choices[0].region.clear();
  EXPECT_TRUE(with_choices(given, choices).seeing.empty()) << "nothing is left";
  EXPECT_EQ(with_choices(given, {}).seeing.size(), 1);
  choices.push_back(choices[0]);
  EXPECT_THROW((void)with_choices(given, choices), ViewRefusal) << "twice";
  choices.resize(1);
  choices[0].camera = "b";
  choices[0].color = {1, 2, 3};
  EXPECT_THROW((void)with_choices(given, choices), ViewRefusal) << "gray";
  choices[0].camera = "c";
  EXPECT_THROW((void)with_choices(given, choices), ViewRefusal);
}

std::string error_of(const std::string& seeing) {
  const std::string request = R"({"id":1,"do":"measure","camera":"a","seeing":)" + seeing + "}";
  const std::string error = read_request(request).error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << "one line";
  return error;
}

TEST(SeeingChoice, IsReadFromARequest) {
  EXPECT_EQ(error_of("{}"), "");
  EXPECT_EQ(error_of(R"({"region":[[1,2],[30,40]],"color":[1,2,3],"base":[5,6.5]})"), "");
  const Request request = read_request(
      R"({"id":1,"do":"shape","seeing":[{"camera":"a","region":[[1,2],[30,40],[5,60]]},{"camera":"b"}]})");
  ASSERT_EQ(request.error, "");
  const auto& shape = std::get<ShapeRequest>(request.ask);
  ASSERT_EQ(shape.seeing.size(), 2);
  EXPECT_EQ(shape.seeing[0].region[2][1], 60);
  EXPECT_EQ(shape.seeing[1].camera, "b");
}

TEST(SeeingChoice, IsRefusedWithOneLineIfItIsNone) {
  EXPECT_THAT(error_of(R"({"region":[[1,2]]})"), HasSubstr("seeing.region: has one corner"));
  EXPECT_THAT(error_of(R"({"region":[[1,2],[1e6,3]]})"), HasSubstr("expected"));
  EXPECT_THAT(error_of(R"({"region":[[1,2],[null,3]]})"), HasSubstr("seeing.region[1]"));
  EXPECT_NE(error_of(R"({"region":[[1,2],[NaN,3]]})"), "");
  EXPECT_NE(error_of(R"({"region":[[1,2],[1e999,3]]})"), "");
  EXPECT_NE(error_of(R"({"region":[[1,2,3],[4,5,6]]})"), "");
  EXPECT_NE(error_of(R"({"region":"0,0,9,9"})"), "");
  EXPECT_THAT(error_of(R"({"color":[1,2,256]})"), HasSubstr("seeing.color"));
  EXPECT_NE(error_of(R"({"color":[1,2]})"), "");
  EXPECT_NE(error_of(R"({"base":[1]})"), "");
  EXPECT_THAT(error_of(R"({"background":"/etc/passwd"})"), HasSubstr("background: unknown key"));
  std::string corners = "[0,0]";
  for (int i = 0; i < 1000; ++i) corners += ",[1,1]";
  EXPECT_THAT(error_of(R"({"region":[)" + corners + "]}"), HasSubstr("1000"));
  EXPECT_THAT(read_request(R"({"id":1,"do":"shape","seeing":[{"region":[[1,2],[3,4]]}]})").error,
              HasSubstr("camera"));
  EXPECT_NE(read_request(R"({"id":1,"do":"color","camera":"a","u":-1,"v":2})").error, "");
  EXPECT_NE(read_request(R"({"id":1,"do":"color","camera":"a","u":1.5,"v":2})").error, "");
  EXPECT_NE(read_request(R"({"id":1,"do":"color","camera":"a"})").error, "");
}

}  // namespace
}  // namespace flexura
