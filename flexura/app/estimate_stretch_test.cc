// Tests `flexura estimate` for arms whose lengths are not known from their files.
#include <gtest/gtest.h>

#include <string>

#include "flexura/app/commands.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/store/text_file.h"
#include "tests/support/estimate_bench.h"
#include "tests/support/experiment_files.h"

namespace flexura {
namespace {

class EstimateStretch : public EstimateBench {};

// The arm is a tenth shorter than its unstretched sections.
TEST_F(EstimateStretch, OfAnArmThatStretchesFindsTheLengthUnlessItIsSaid) {
  std::string text = replaced(photographed_arm, "-0.8]] }", "-0.8]], stretches = [0.9, 0.9, 0.9] }");
  for (std::size_t at = 0; (at = text.find("radius =", at)) != std::string::npos; at += 40)
    text.insert(at, "stretch_limits = [0.8, 1.2]\n");
  write_new_file(folder_.path() / "stretched.toml", text);
  arguments_.images = {photographed("stretched", "front"), photographed("stretched", "side")};
  arguments_.arm = (folder_.path() / "stretched.toml").string();
  const Node found = answer(exit_done);
  EXPECT_NEAR(*found.find("length")->as<double>(), 0.9, 1e-3);
  EXPECT_LT(error(found, "stretched"), 1e-3);
  EXPECT_EQ(found.find("bends")->as<Node::Array>()->size(), 3U);
  // Metres refer to the unstretched arm, whose length is known.
  arguments_.markers = {"0.5"};
  EXPECT_NEAR(*answer(exit_done).find("length")->as<double>(), 0.9, 1e-3);
  arguments_.markers.clear();
  // A length equal to that of the unstretched sections is wrong.
  arguments_.length = 1;
  EXPECT_FALSE(*answer(exit_missed).find("found")->as<bool>());
  arguments_.length = 0.9;
  const Node held = answer(exit_done);
  EXPECT_NEAR(*held.find("length")->as<double>(), 0.9, 1e-12);
  EXPECT_LT(error(held, "stretched"), 5e-4);
  arguments_.length = 1.3;
  EXPECT_THROW((void)answer(exit_done), InputError);
  // For an arm that does not stretch, the file gives the length.
  arguments_.arm = (folder_.path() / "arm.toml").string(), arguments_.length = 1;
  EXPECT_THROW((void)answer(exit_done), InputError);
}

}  // namespace
}  // namespace flexura
