#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "flexura/app/commands.h"
#include "flexura/app/measure.h"
#include "flexura/base/source.h"
#include "flexura/picture/image_file.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "tests/support/drawn_arms.h"
#include "tests/support/random_cases.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

// Runs `flexura measure` on a picture with given threshold arguments.
class MeasureBy : public testing::Test {
 protected:
  Node measured_by(const Image<std::uint8_t>& picture, const ThresholdArguments& threshold,
                   int expected_status = exit_done) {
    MeasureArguments arguments;
    arguments.images = {(folder_.path() / fmt::format("{}.png", ++count_)).string()};
    arguments.threshold = threshold;
    write_new_file(arguments.images.front(), png(picture));
    std::ostringstream out;
    EXPECT_EQ(measure_command(arguments, out), expected_status) << out.str();
    return parse_json(out.str(), "answer");
  }
  // Returns the axis' largest distance from v = middle(u), px, and the length in u that it covers, px.
  template <typename Middle>
  static std::pair<double, double> off_and_reach(const Node& answer, const Middle& middle) {
    if (answer.find("axis") == nullptr) return {1e9, 0};
    double most = 0, left = 1e9, right = -1e9;
    for (const Node& point : *answer.find("axis")->as<Node::Array>()) {
      const auto& place = *point.as<Node::Array>();
      const double u = *place[0].as<double>();
      most = std::max(most, std::abs(*place[1].as<double>() - middle(u)));
      left = std::min(left, u), right = std::max(right, u);
    }
    return {most, right - left};
  }
  static std::string word(const Node& answer, const char* key) {
    const Node* node = answer.find(key);
    return node == nullptr ? "" : *node->as<std::string>();
  }

 private:
  const TemporaryFolder folder_;
  int count_ = 0;
};

TEST_F(MeasureBy, EachThresholdFindsTheSameAxisAndNamesItself) {
  for_random_cases(4, [&](TestRandom& random) {
    const double bend = random.uniform(10, 30), thickness = random.uniform(9, 16);
    const auto wave = [&](double u) { return 120 + bend * std::sin(u * std::numbers::pi / 320); };
    const Image<std::uint8_t> picture = gray_arm(wave, thickness, random);
    const double level = random.uniform(90, 160);
    for (const ThresholdArguments& how :
         {ThresholdArguments{}, ThresholdArguments{.method = "two_mode"},
          ThresholdArguments{.method = "by_block"}, ThresholdArguments{.method = "fixed", .level = level},
          ThresholdArguments{.level = level}}) {
      SCOPED_TRACE(how.method.value_or(""));
      const Node answer = measured_by(picture, how);
      EXPECT_EQ(word(answer, "method"), how.level ? "fixed" : how.method.value_or("otsu"));
      EXPECT_EQ(word(answer, "figure"), "dark");
      const double reported = *answer.find("threshold")->as<double>();
      // Between the arm's value 30 and the background's 220, with their noise.
      EXPECT_GT(reported, 33);
      EXPECT_LT(reported, 217);
      EXPECT_EQ(reported == level, how.level.has_value());
      const auto [most, reach] = off_and_reach(answer, wave);
      EXPECT_LT(most, 0.3);
      EXPECT_GT(reach, 265);
    }
  });
}

// The screen gets so much brighter from left to right that its dark side is darker than the arm's bright end.
TEST_F(MeasureBy, OnlyBlocksFollowAnUnevenScreen) {
  const auto line = [](double u) { return 110 + 0.05 * u; };
  Image<std::uint8_t> picture(320, 240);
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u) {
      const double dark = u > 20 && u < 300 ? share(std::abs(v - line(u)) - 7) : 0;
      picture.at(u, v) = static_cast<std::uint8_t>(std::lround((1 - 0.6 * dark) * (70 + 0.4 * u)));
    }
  const Node by_block = measured_by(picture, {.method = "by_block"});
  const auto [most, reach] = off_and_reach(by_block, line);
  EXPECT_LT(most, 0.3);
  // All but the dim end, where the contrast is a third of that at the bright end.
  EXPECT_GT(reach, 220);
  MeasureConfig config;
  config.finder.threshold.method = ThresholdMethod::two_mode;
  const std::string file = png(picture);
  const Measurement found = measure_picture({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()},
                                            "uneven.png", config);
  EXPECT_TRUE(!found.is_found || off_and_reach(found.answer, line).second < 200);
  // Otsu's method gives way to the blocks, or removes the screen's dark side, which is wider than the arm.
  const Node otsu = measured_by(picture, {});
  const auto [otsu_most, otsu_reach] = off_and_reach(otsu, line);
  EXPECT_LT(otsu_most, 0.3);
  EXPECT_GT(otsu_reach, 190);
}

TEST_F(MeasureBy, AFixedLevelAndTheFigureAreHeeded) {
  TestRandom random(3);
  const auto line = [](double u) { return 80 + 0.1 * u; };
  Image<std::uint8_t> picture = gray_arm(line, 12, random);
  const Node dark = measured_by(picture, {.level = 200});
  EXPECT_EQ(*dark.find("threshold")->as<double>(), 200);
  // Levels below the arm's value or above the background's separate nothing.
  for (const auto& [level, why] :
       {std::pair(5.0, "the fixed level 5 is darker than nearly all of the picture: "),
        std::pair(250.0, "the fixed level 250 is brighter than nearly all of the picture: ")}) {
    const Node none = measured_by(picture, {.level = level}, exit_missed);
    EXPECT_FALSE(*none.find("found")->as<bool>());
    const std::string reason = word(none, "reason"),
                      brightnesses = "the two classes have the mean brightnesses 34 and 220, ";
    EXPECT_EQ(reason.substr(0, reason.rfind(", ") + 2), why + brightnesses);
  }
  EXPECT_EQ(word(measured_by(picture, {.figure = "dark"}), "figure"), "dark");
  EXPECT_NE(word(measured_by(picture, {.figure = "bright"}, exit_missed), "reason"), "");
  for (std::uint8_t& value : picture.values()) value = static_cast<std::uint8_t>(255 - value);
  const Node bright = measured_by(picture, {});
  EXPECT_EQ(word(bright, "figure"), "bright");
  EXPECT_LT(off_and_reach(bright, line).first, 0.3);
}

TEST_F(MeasureBy, RefusesThresholdsThatSayNothing) {
  TestRandom random(4);
  const Image<std::uint8_t> picture = gray_arm([](double) { return 100.0; }, 12, random);
  for (const ThresholdArguments& how :
       {ThresholdArguments{.method = "otsi"}, ThresholdArguments{.method = "fixed"},
        ThresholdArguments{.method = "otsu", .level = 100},
        ThresholdArguments{.method = "two_mode", .level = 100},
        ThresholdArguments{.method = "by_block", .level = 100}, ThresholdArguments{.level = 256},
        ThresholdArguments{.level = -1}, ThresholdArguments{.level = NAN},
        ThresholdArguments{.figure = "gray"}}) {
    SCOPED_TRACE(how.method.value_or("") + how.figure);
    EXPECT_THROW((void)measured_by(picture, how), InputError);
  }
}

}  // namespace
}  // namespace flexura
