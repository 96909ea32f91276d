// Other figures beside the arm: base and arm choose, and contradictions are told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "flexura/picture/image_file.h"
#include "tests/support/estimate_bench.h"

namespace flexura {
namespace {

class EstimateFigures : public EstimateBench {};

TEST_F(EstimateFigures, BesideTheArmAreNotMeasured) {
  // A dark plate, larger than the arm.
  for (std::string& name : arguments_.images) {
    Image<std::uint8_t> picture = picture_of(name);
    for (int v = 40; v < 440; ++v)
      for (int u = 20; u < 110; ++u)
        for (int c = 0; c < picture.channels(); ++c) picture.at(u, v, c) = 12;
    replace_file(name, png(picture));
  }
  arguments_.arm = (folder_.path() / "arm.toml").string();
  const Node found = answer(exit_done);
  EXPECT_TRUE(*found.find("trusted")->as<bool>()) << write_json(found);
  EXPECT_LT(error(found), 5e-4);
  // Only the plate is left.
  arguments_.scene.regions = {"5,5,140,470"};
  const Node wrong = answer(exit_missed);
  EXPECT_FALSE(*wrong.find("trusted")->as<bool>());
}

TEST_F(EstimateFigures, AreSearchedInARegion) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  arguments_.scene.regions = {"100,2,600,477", "60,2,620,477"};
  const Node found = answer(exit_done);
  EXPECT_LT(error(found), 5e-4) << write_json(found);
  arguments_.scene.regions = {"0,0,5,5"};
  const Node none = answer(exit_missed);
  EXPECT_THAT(write_json(none), testing::HasSubstr("the region has fewer than 8 rows or columns"));
}

}  // namespace
}  // namespace flexura
