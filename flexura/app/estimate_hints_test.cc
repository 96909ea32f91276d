// Tests `flexura estimate` with pictures of an unexpected exposure, gamma, size or orientation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <string>

#include "flexura/app/commands.h"
#include "flexura/app/measure.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/picture/image_file.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "tests/support/estimate_bench.h"
#include "tests/support/experiment_files.h"

namespace flexura {
namespace {

using testing::HasSubstr;
using testing::Not;

class EstimateHints : public EstimateBench {
 protected:
  // Takes the same pictures by cameras with a gamma.
  void photograph_with_gamma() {
    std::string text = photographed_arm;
    for (std::size_t at = 0; (at = text.find("psf =", at)) != std::string::npos; at += 30)
      text.insert(at, "gamma = 2.2, ");
    write_new_file(folder_.path() / "gamma.toml", text);
    arguments_.images = {photographed("gamma", "front"), photographed("gamma", "side")};
  }
  void give_gamma() {
    std::string text = two_measured_cameras;
    for (std::size_t at = 0; (at = text.find("cx =", at)) != std::string::npos; at += 30)
      text.insert(at, "gamma = 2.2\n");
    arguments_.cameras = (folder_.path() / "with_gamma.toml").string();
    write_new_file(arguments_.cameras, text);
  }
};

TEST_F(EstimateHints, UndoAGammaThatIsSaid) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  const double without = error(answer(exit_done));
  photograph_with_gamma();
  const double omitted = error(answer(exit_done));
  give_gamma();
  const Node found = answer(exit_done);
  EXPECT_EQ(*found.find("trusted")->as<bool>(), true);
  EXPECT_LT(error(found), std::max(1.5 * without, 1e-4));
  EXPECT_LT(error(found), 0.8 * omitted);
}

TEST_F(EstimateHints, MeasureUndoesItToo) {
  photograph_with_gamma();
  const auto answer_of = [&](MeasureArguments arguments) {
    std::ostringstream out;
    arguments.images = {arguments_.images.front()};
    EXPECT_EQ(measure_command(arguments, out), exit_done);
    return out.str();
  };
  MeasureArguments plain, by_option, by_file, by_both;
  by_option.gamma = by_both.gamma = 2.2;
  give_gamma();
  write_new_file(folder_.path() / "one.toml",
                 read_text_file(arguments_.cameras, 1 << 16)
                     .substr(0, read_text_file(arguments_.cameras, 1 << 16).rfind("[[camera]]")));
  by_file.camera = by_both.camera = (folder_.path() / "one.toml").string();
  EXPECT_NE(answer_of(plain), answer_of(by_option));
  EXPECT_EQ(answer_of(by_file), answer_of(by_both));
  EXPECT_EQ(*parse_json(answer_of(by_option), "x").find("bits")->as<std::int64_t>(), 8);
  MeasureArguments by_other;
  by_other.camera = (folder_.path() / "other.toml").string();
  write_new_file(by_other.camera,
                 replaced(read_text_file(by_file.camera, 1 << 16), "cx = 319.5", "cx = 639.5"));
  EXPECT_THAT(answer_of(by_other), HasSubstr("of another size"));
  EXPECT_THAT(answer_of(by_file), Not(HasSubstr("of another size")));
  by_option.gamma = 0;
  std::ostringstream out;
  by_option.images = {arguments_.images.front()};
  EXPECT_THROW(measure_command(by_option, out), InputError);
}

TEST_F(EstimateHints, RefusesPicturesOfAnotherSizeThanTheCamerasAreSaidToBeOf) {
  std::ostringstream out;
  const auto with_size = [&](const char* size) {
    write_new_file(
        folder_.path() / (std::string(size) + ".toml"),
        replaced(two_measured_cameras, "fx = 800.0\ncx", std::string("size = ") + size + "\nfx = 800.0\ncx"));
    EstimateArguments arguments = arguments_;
    arguments.cameras = (folder_.path() / (std::string(size) + ".toml")).string();
    return arguments;
  };
  EXPECT_EQ(estimate_command(with_size("[640, 480]"), out), exit_done);
  try {
    (void)estimate_command(with_size("[1280, 960]"), out);
    ADD_FAILURE() << "estimated";
  } catch (const InputError& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr(
            "640 x 480 px: expected 1280 x 960 px, the size of camera \"front\" in the file of cameras"));
  }
  EXPECT_THROW(estimate_command(with_size("[0, 480]"), out), InputError);
  EXPECT_THROW(estimate_command(with_size("[640]"), out), InputError);
}

// A principal point far from the middle does not suggest another size if the file gives the size.
TEST_F(EstimateHints, DoNotGuessASizeThatIsSaid) {
  const std::string aside = replaced(two_measured_cameras, "cx = 319.5", "cx = 180");
  const auto answer_by = [&](const char* name, const std::string& cameras) {
    EstimateArguments arguments = arguments_;
    arguments.cameras = (folder_.path() / name).string();
    write_new_file(arguments.cameras, cameras);
    std::ostringstream out;
    (void)estimate_command(arguments, out);
    return out.str();
  };
  EXPECT_THAT(answer_by("aside.toml", aside), HasSubstr("of another size"));
  EXPECT_THAT(answer_by("said.toml", replaced(aside, "cx = 180", "size = [640, 480]\ncx = 180")),
              Not(HasSubstr("of another size")));
}

// Upside down, nothing is where the base should be, and the answer reports it.
TEST_F(EstimateHints, TellWhereTheBaseIsLookedFor) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  for (const std::string& name : arguments_.images) {
    Image<std::uint8_t> picture = picture_of(name);
    for (int v = 0; v < picture.height() / 2; ++v)
      std::ranges::swap_ranges(picture.row(v), picture.row(picture.height() - 1 - v));
    replace_file(name, png(picture));
  }
  const Node turned = answer(exit_missed);
  const auto& notes = *turned.find("notes")->as<Node::Array>();
  EXPECT_TRUE(std::ranges::any_of(notes, [](const Node& note) {
    return note.as<std::string>()->starts_with("the base would be visible at (");
  }));
}

TEST_F(EstimateHints, TellOfSaturation) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  Image<std::uint8_t> picture = picture_of(arguments_.images.front());
  for (std::uint8_t& value : picture.values()) value = static_cast<std::uint8_t>(std::min(255, 3 * value));
  replace_file(arguments_.images.front(), png(picture));
  std::ostringstream out;
  (void)estimate_command(arguments_, out);
  EXPECT_THAT(out.str(), HasSubstr("% of the picture is saturated"));
}

}  // namespace
}  // namespace flexura
