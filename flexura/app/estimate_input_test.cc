// Tests the input that `flexura estimate` rejects before it looks at any picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "flexura/app/estimate.h"
#include "flexura/base/source.h"
#include "flexura/store/text_file.h"
#include "tests/support/camera_files.h"
#include "tests/support/experiment_files.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

class EstimateInput : public testing::Test {
 protected:
  void SetUp() override {
    arguments_.cameras = (folder_.path() / "cameras.toml").string();
    arguments_.images = {"front.png", "side.png"};
    write_new_file(arguments_.cameras, two_measured_cameras);
  }
  // Returns the error for a file of cameras, without its folder.
  std::string refusal(const std::string& from, const std::string& to) {
    replace_file(arguments_.cameras, replaced(two_measured_cameras, from, to));
    std::ostringstream out;
    try {
      estimate_command(arguments_, out);
    } catch (const InputError& error) {
      const std::string what = error.what();
      return what.substr(what.find("cameras.toml"));
    }
    return out.str();
  }

  TemporaryFolder folder_;
  EstimateArguments arguments_;
};

TEST_F(EstimateInput, SaysWhereAFileOfCamerasIsWrong) {
  const std::string side = "position = [-1.9, 0.45, 0.0]";
  EXPECT_EQ(refusal(side, "position = [0, 0.45, 1.9]"),
            "cameras.toml:13:12: camera[1].position: equals that of camera[0]: expected cameras at "
            "different positions");
  EXPECT_EQ(refusal(side, "position_mm = [1e200, 0, 0]"),
            "cameras.toml:13:15: camera[1].position: expected within 1e+06 m");
  EXPECT_EQ(refusal(side, ""),
            "cameras.toml:8:1: camera[1].position: missing: expected the pose of each camera");
  EXPECT_EQ(refusal("\"side\"", "\"front\""),
            "cameras.toml:9:1: camera[1].name: is also the name of camera[0]: expected another name");
  EXPECT_EQ(refusal("cx = 319.5", "cx = 1e308"),
            "cameras.toml:4:6: camera[0].cx = 1e+308: expected a number from -10000000 to 10000000");
  arguments_.images.emplace_back("third.png");
  EXPECT_EQ(refusal("", ""),
            "cameras.toml:1:1: camera: 2 cameras for 3 pictures: expected one camera per picture");
}

TEST_F(EstimateInput, RefusesWhatItCannotUse) {
  std::ostringstream out;
  EstimateArguments bad = arguments_;
  bad.images.pop_back();
  EXPECT_THROW(estimate_command(bad, out), InputError);
  bad = arguments_;
  bad.images.push_back(bad.images.front());
  EXPECT_THROW(estimate_command(bad, out), InputError);
  bad = arguments_;
  bad.length = -1;
  EXPECT_THROW(estimate_command(bad, out), InputError);
  bad = arguments_;
  bad.base = {0, NAN, 0};
  EXPECT_THROW(estimate_command(bad, out), InputError);
  bad.base = {1e300, 0, 0};
  EXPECT_THROW(estimate_command(bad, out), InputError);
  bad = arguments_;
  bad.length = 1e300;
  EXPECT_THROW(estimate_command(bad, out), InputError);
  bad = arguments_;
  bad.cameras = (folder_.path() / "far.toml").string();
  write_new_file(bad.cameras,
                 replaced(two_measured_cameras, "position = [", "position = [1e200, 0, 0]\n# ["));
  EXPECT_THROW(estimate_command(bad, out), InputError);
  for (const char* marker : {"x", "", "12%%", "0.3", "130%", "-1%", "nan%"}) {
    bad = arguments_;
    bad.markers = {marker};
    EXPECT_THROW(estimate_command(bad, out), InputError) << marker;
  }
  bad = arguments_;
  bad.length = 1;
  for (const auto& [place, share] : {std::pair("0.25", "25%"), {"0.33", "33%"}, {"0.29", "29%"}}) {
    bad.markers = {place, share};
    EXPECT_THROW(estimate_command(bad, out), InputError) << place;
  }
  bad = arguments_;
  bad.images[0] = (folder_.path() / "cameras.toml").string();
  EXPECT_THROW(estimate_command(bad, out), InputError);
  EXPECT_EQ(out.str(), "");
}

}  // namespace
}  // namespace flexura
