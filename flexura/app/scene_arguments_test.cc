// Regions, backgrounds, colours and masks on the command line.
#include "flexura/app/scene_arguments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "flexura/app/commands.h"
#include "flexura/app/measure.h"
#include "flexura/base/source.h"
#include "flexura/picture/image_file.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "tests/support/drawn_scenes.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using testing::HasSubstr;

// A red arm on an arc of radius 80 px before clutter, the clutter alone, and a mask.
class SceneArgumentsTest : public testing::Test {
 protected:
  SceneArgumentsTest() {
    const DrawnTexture texture(5, 30);
    DrawnScene empty(320, 240, 3);
    empty.ground([&](int u, int v, int c) { return 40 + 150 * texture(u + 20 * c, v); });
    empty.bar(10, 10, 60, 230, 20).bar(250, 10, 310, 100, 240);
    DrawnScene full = empty, mask(320, 240);
    full.arc(200, 120, 80, 12, [](int, int, int c) { return c == 0 ? 200.0 : 20.0; });
    mask.ground([](int, int, int) { return 0; }).arc(200, 120, 80, 12, 255);
    write_new_file(path("arm.png"), png(full.photograph(1, 1)));
    write_new_file(path("empty.png"), png(empty.photograph(1, 2)));
    write_new_file(path("mask.png"), png(mask.photograph(0, 3)));
    arguments.images = {path("arm.png")};
  }
  [[nodiscard]] std::string path(const char* name) const { return (folder.path() / name).string(); }

  Node answer(int status) {
    std::ostringstream out;
    EXPECT_EQ(measure_command(arguments, out), status) << out.str();
    return parse_json(out.str(), "answer");
  }
  std::string refusal() {
    std::ostringstream out;
    try {
      measure_command(arguments, out);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error: " + out.str();
  }

  TemporaryFolder folder;
  MeasureArguments arguments;
};

TEST_F(SceneArgumentsTest, FindAnArmBeforeClutter) {
  const auto expect_arc = [&](double within) {
    const Node found = answer(exit_done);
    ASSERT_FALSE(found.find("circle")->empty()) << write_json(found);
    EXPECT_NEAR(*found.find("circle")->find("radius")->as<double>(), 80, within);
    EXPECT_TRUE(*found.find("trusted")->as<bool>());
  };
  arguments.scene.backgrounds = {path("empty.png")};
  expect_arc(0.1);
  arguments.scene = {.color = "200,20,20"};
  expect_arc(0.2);
  arguments.scene = {.masks = {path("mask.png")}};
  expect_arc(0.2);
  // All at once, for two pictures, with a gamma.
  arguments.gamma = 2.2;
  arguments.scene = {.regions = {"100,20,230,225"},
                     .backgrounds = {path("empty.png")},
                     .color = "200,20,20",
                     .masks = {path("mask.png"), path("mask.png")}};
  arguments.images = {path("arm.png"), path("arm.png")};
  std::ostringstream out;
  EXPECT_EQ(measure_command(arguments, out), exit_done) << out.str();
}

TEST_F(SceneArgumentsTest, AreRefusedWithTheReason) {
  const auto refused = [&](const SceneArguments& scene) {
    arguments.scene = scene;
    return refusal();
  };
  for (const char* region : {"1,2,3", "1,2,3,4,5", "a,b,c,d", "1,2,,4", "1,2,3,nan", "0,0,1e9,4", ""})
    EXPECT_THAT(refused({.regions = {region}}),
                HasSubstr("--region: \"" + std::string(region) + "\": expected two corners"))
        << region;
  for (const char* color : {"1,2", "1,2,300", "-1,2,3", "red"})
    EXPECT_THAT(refused({.color = color}), HasSubstr("expected red, green and blue from 0 to 255")) << color;
  EXPECT_THAT(refused({.masks = {path("mask.png"), path("mask.png")}}),
              HasSubstr("--mask: given 2 times for 1 picture: expected once, or once per picture"));
  EXPECT_THAT(refused({.backgrounds = {path("none.png")}}), HasSubstr("none.png"));
  arguments.what = "circle";
  EXPECT_THAT(refused({.color = "1,2,3"}), HasSubstr("--color: has no effect with --what circle"));
  arguments.what = "arm";
  // A background of another size: the arm is not found, for this reason.
  write_new_file(path("small.png"), png(Image<std::uint8_t>(100, 80, 3, 7)));
  arguments.scene = {.backgrounds = {path("small.png")}};
  const Node found = answer(exit_missed);
  EXPECT_THAT(*found.find("reason")->as<std::string>(),
              HasSubstr("the picture of the background has 100 x 80 px"));
}

}  // namespace
}  // namespace flexura
