#include "flexura/app/estimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "flexura/app/commands.h"
#include "flexura/base/image.h"
#include "flexura/base/node.h"
#include "flexura/picture/image_file.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "tests/support/camera_files.h"
#include "tests/support/estimate_bench.h"
#include "tests/support/experiment_files.h"

namespace flexura {
namespace {

using ::testing::HasSubstr, ::testing::Not;

class Estimate : public EstimateBench {};

TEST_F(Estimate, OfAKnownArmIsRightToATenthOfAMillimetreOrTwo) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  const Node found = answer(exit_done);
  EXPECT_LT(error(found), 5e-4);
  EXPECT_LT(*found.find("rms_px")->as<double>(), 0.05);
  EXPECT_EQ(found.find("bends")->as<Node::Array>()->size(), 3u);
}

// The sections bend more near their bases than any model of one arc a section can.
TEST_F(Estimate, OfAnUnevenArmIsRightWithTheModelOfItsArcs) {
  std::string uneven = photographed_arm;
  for (std::size_t at = 0; (at = uneven.find("radius = 0.018\n", at)) != std::string::npos; at += 30)
    uneven.insert(at, "bend_profile = [1.3, 1, 0.7]\n");
  write_new_file(folder_.path() / "uneven.toml", uneven);
  arguments_.images = {photographed("uneven", "front"), photographed("uneven", "side")};
  arguments_.arm = (folder_.path() / "uneven.toml").string();
  const Node found = answer(exit_done);
  EXPECT_LT(error(found, "uneven"), 1e-3);
  EXPECT_EQ(found.find("bends")->as<Node::Array>()->size(), 9U) << "one an arc";
  // With one arc a section, the answer reports that no shape explains the images.
  arguments_.arm = (folder_.path() / "arm.toml").string();
  const Node refused = answer(exit_missed);
  EXPECT_THAT(*refused.find("reason")->as<std::string>(), HasSubstr("no shape explains the images"));
}

TEST_F(Estimate, OfAnUnknownArmNeedsNothingButTheCameras) {
  arguments_.base = {0, 0, 0};
  arguments_.length = 1;
  EXPECT_LT(error(answer(exit_done)), 4e-3);
  arguments_.length.reset();
  arguments_.base.clear();
  const Node found = answer(exit_done);
  EXPECT_LT(error(found), 1.5e-2);
  EXPECT_NEAR(*found.find("length")->as<double>(), 1, 0.015);
}

TEST_F(Estimate, UsesBandsOfWhichBothPicturesShowTheSame) {
  const std::vector<std::string> places = {"0.15", "0.3", "0.45", "0.6", "0.75", "0.9"};
  arguments_.base = {0, 0, 0};
  arguments_.length = 1;
  write_banded("banded", places);
  arguments_.images = {photographed("banded", "front"), photographed("banded", "side")};
  const Node found = answer(exit_done);
  ASSERT_NE(found.find("markers"), nullptr) << write_json(found);
  const auto& markers = *found.find("markers")->as<Node::Array>();
  ASSERT_EQ(markers.size(), places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_NEAR(*markers[i].find("s")->as<double>(), std::stod(places[i]), 1.5e-3);
    EXPECT_EQ(*markers[i].find("images")->as<std::int64_t>(), 2);
  }
  EXPECT_LT(error(found), 4e-3);
  arguments_.markers = {"15%", "0.3", "0.45", "60%", "0.75", "0.9"};
  EXPECT_LT(error(answer(exit_done)), 4e-3);
  // One marker is hidden from the second camera, which sees another at a place without one.
  write_banded("false", {"0.15", "0.3", "0.45", "0.67", "0.75", "0.9"});
  arguments_.images[1] = photographed("false", "side");
  const Node uncertain = answer(exit_done);
  EXPECT_LT(error(uncertain), 5e-3);
  EXPECT_EQ(uncertain.find("markers")->as<Node::Array>()->size(), places.size());
  arguments_.markers.clear();
  EXPECT_LT(error(answer(exit_done)), 5e-3);
}

// The second camera is turned by half a degree; its nominal orientation is not.
TEST_F(Estimate, FindsWhatIsWrongWithACameraThatIsDoubted) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  const std::string turned =
      "rotation = [[0.0087265, 0, 0.99996192], [0, -1, 0], [0.99996192, 0, -0.0087265]]";
  const std::string wrong =
      replaced(two_measured_cameras, "rotation = [[0, 0, 1], [0, -1, 0], [1, 0, 0]]", turned);
  arguments_.cameras = (folder_.path() / "wrong.toml").string();
  write_new_file(arguments_.cameras, wrong);
  EXPECT_NE(answer(exit_done).find("notes"), nullptr);
  EXPECT_GT(error(answer(exit_done)), 5e-3);
  arguments_.cameras = (folder_.path() / "doubted.toml").string();
  write_new_file(arguments_.cameras,
                 replaced(wrong, "name = \"side\"",
                          "name = \"side\"\nprior = { rotation_std_deg = 1, focal_std = 0.01 }"));
  const Node found = answer(exit_done);
  EXPECT_LT(error(found), 1.5e-3);
  const auto& images = *found.find("images")->as<Node::Array>();
  EXPECT_EQ(images[0].find("camera_error"), nullptr);
  const auto& turn = *images[1].find("camera_error")->find("turn")->as<Node::Array>();
  EXPECT_NEAR(*turn[1].as<double>(), 0.0087265, 5e-4);
}

std::string replaced_everywhere(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

// The lens distortion shifts the arm's ends by some pixels.
TEST_F(Estimate, UndoesTheLensesDistortionWhereTheFileTellsIt) {
  const std::string distortion = "distortion = [-0.4, 0.15, 0.003, -0.002, 0.0]";
  write_new_file(
      folder_.path() / "bent.toml",
      replaced_everywhere(photographed_arm, "sensor =", "lens = { " + distortion + " }\nsensor ="));
  arguments_.images = {photographed("bent", "front"), photographed("bent", "side")};
  const std::string without_lens = arguments_.cameras, reported = (folder_.path() / "lenses.toml").string();
  write_new_file(reported,
                 replaced_everywhere(two_measured_cameras, "fx = 800.0", "fx = 800.0\n" + distortion));
  const auto expect_right_where_reported = [&](double most) {
    arguments_.cameras = without_lens;
    const Node wrong = answer(exit_done);
    EXPECT_GT(error(wrong), 5e-3);
    EXPECT_FALSE(*wrong.find("trusted")->as<bool>());
    arguments_.cameras = reported;
    EXPECT_LT(error(answer(exit_done)), most);
  };
  // A known arm, then one without a kinematic model.
  arguments_.arm = (folder_.path() / "arm.toml").string();
  expect_right_where_reported(5e-4);
  arguments_.arm.clear(), arguments_.base = {0, 0, 0}, arguments_.length = 1;
  expect_right_where_reported(4e-3);
}

// A lens whose distortion folds back within the picture has no rays for the arm beyond. The answer reports
// it.
TEST_F(Estimate, SaysWhereADistortionHasNoRays) {
  const auto notes_by = [&](const std::string& k1) {
    arguments_.cameras = (folder_.path() / (k1 + ".toml")).string();
    write_new_file(arguments_.cameras,
                   replaced_everywhere(two_measured_cameras, "fx = 800.0",
                                       "fx = 800.0\ndistortion = [" + k1 + ", 0, 0, 0, 0]"));
    std::ostringstream out;
    (void)estimate_command(arguments_, out);
    return out.str();
  };
  const std::string reported = "has no ray for some pixels of the arm: they count for nothing";
  EXPECT_THAT(notes_by("-5"), HasSubstr(reported));
  EXPECT_THAT(notes_by("-0.1"), Not(HasSubstr(reported)));
}

// Returns the values of `node` at `key`, which must be finite numbers; rows are concatenated.
std::vector<double> numbers_in(const Node& node, const char* key) {
  std::vector<double> numbers;
  const Node* values = node.find(key);
  EXPECT_NE(values, nullptr) << key;
  if (values == nullptr) return numbers;
  const auto add = [&](const auto& self, const Node& value) -> void {
    if (const auto* array = value.as<Node::Array>()) {
      for (const Node& one : *array) self(self, one);
      return;
    }
    const auto* number = value.as<double>();
    EXPECT_TRUE(number != nullptr && std::isfinite(*number)) << key << ": " << write_json(value);
    if (number != nullptr) numbers.push_back(*number);
  };
  add(add, *values);
  return numbers;
}

// The table of docs/estimation.md, for a known arm and cameras that look along Z and X.
TEST_F(Estimate, HasEveryKeyThatIsDocumentedInItsShape) {
  constexpr std::size_t points = 33;
  write_banded("banded", {"0.2", "0.5", "0.8"});
  arguments_.images = {photographed("banded", "front"), photographed("banded", "side")};
  arguments_.arm = (folder_.path() / "banded.toml").string();
  arguments_.points = points;
  arguments_.markers = {"0.2", "0.5", "0.8"};
  write_new_file(folder_.path() / "doubted.toml",
                 replaced(two_measured_cameras, "name = \"side\"",
                          "name = \"side\"\nprior = { rotation_std_deg = 0.1 }"));
  arguments_.cameras = (folder_.path() / "doubted.toml").string();
  const Node found = answer(exit_done);
  EXPECT_TRUE(*found.find("found")->as<bool>());
  ASSERT_NE(found.find("trusted"), nullptr);
  EXPECT_EQ(*found.find("trusted")->as<bool>(), found.find("notes") == nullptr);
  EXPECT_EQ(found.find("reason"), nullptr);
  EXPECT_EQ(numbers_in(found, "backbone").size(), 3 * points);
  EXPECT_EQ(found.find("backbone")->as<Node::Array>()->size(), points);
  for (const char* key : {"azimuth", "elevation", "sigmas"})
    EXPECT_EQ(numbers_in(found, key).size(), points) << key;
  const Node* planes = found.find("planes");
  ASSERT_NE(planes, nullptr);
  for (const char* key : {"azimuth", "elevation"}) EXPECT_EQ(numbers_in(*planes, key).size(), points) << key;
  const auto& singular = *planes->find("singular")->as<Node::Array>();
  EXPECT_EQ(singular.size(), points);
  for (const Node& one : singular) EXPECT_NE(one.as<bool>(), nullptr);
  EXPECT_NEAR(numbers_in(found, "length").at(0), 1, 1e-3);
  const std::vector<double> sigmas = numbers_in(found, "sigmas");
  const double sigma = numbers_in(found, "sigma").at(0);
  EXPECT_GT(sigma, 0);
  EXPECT_LT(sigma, std::ranges::max(sigmas));
  EXPECT_GT(numbers_in(found, "rms_px").at(0), 0);
  EXPECT_EQ(numbers_in(found, "bends").size(), 6U);
  EXPECT_EQ(found.find("bends")->as<Node::Array>()->size(), 3U);
  const auto& markers = *found.find("markers")->as<Node::Array>();
  ASSERT_EQ(markers.size(), 3U);
  for (const Node& marker : markers) {
    EXPECT_EQ(numbers_in(marker, "s").size(), 1U);
    EXPECT_EQ(numbers_in(marker, "at").size(), 3U);
    EXPECT_EQ(*marker.find("images")->as<std::int64_t>(), 2);
  }
  const auto& images = *found.find("images")->as<Node::Array>();
  ASSERT_EQ(images.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(*images[i].find("image")->as<std::string>(), arguments_.images[i]);
    EXPECT_EQ(*images[i].find("camera")->as<std::string>(), i == 0 ? "front" : "side");
    EXPECT_GT(*images[i].find("points")->as<std::int64_t>(), 50);
  }
  const Node* off = images[1].find("camera_error");
  ASSERT_NE(off, nullptr);
  EXPECT_EQ(numbers_in(*off, "turn").size(), 3U);
  EXPECT_EQ(numbers_in(*off, "focal").size(), 1U);
}

// The angles are those of the printed backbone, whose direction is (sin a cos e, cos a cos e, sin e).
TEST_F(Estimate, TellsTheAnglesOfItsBackbone) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  arguments_.points = 201;
  const Node found = answer(exit_done);
  const std::vector<double> points = numbers_in(found, "backbone"), azimuth = numbers_in(found, "azimuth"),
                            elevation = numbers_in(found, "elevation");
  for (std::size_t i = 1; i < 200; ++i) {
    const Eigen::Vector3d before(&points[3 * (i - 1)]), after(&points[3 * (i + 1)]);
    const double a = azimuth[i], e = elevation[i];
    const Eigen::Vector3d reported(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e));
    EXPECT_LT(((after - before).normalized() - reported).norm(), 0.01) << i;
  }
}

TEST_F(Estimate, SaysWhetherItsAnswerIsToBeTrusted) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  const Node right = answer(exit_done);
  EXPECT_TRUE(*right.find("trusted")->as<bool>()) << write_json(right);
  EXPECT_EQ(right.find("notes"), nullptr);
  // Without a kinematic model the result is less certain, and the choice of the base end is a guess.
  arguments_.arm.clear();
  const Node guessed = answer(exit_done);
  EXPECT_FALSE(*guessed.find("trusted")->as<bool>());
  EXPECT_NE(guessed.find("notes"), nullptr);
  arguments_.images[1] = (folder_.path() / "blank.png").string();
  write_new_file(arguments_.images[1], png(Image<std::uint8_t>(64, 48)));
  EXPECT_FALSE(*answer(exit_missed).find("trusted")->as<bool>());
}

TEST_F(Estimate, SaysWhyThereIsNone) {
  arguments_.images[1] = (folder_.path() / "blank.png").string();
  write_new_file(arguments_.images[1], png(Image<std::uint8_t>(64, 48)));
  const Node found = answer(exit_missed);
  EXPECT_NE(found.find("reason"), nullptr);
  EXPECT_EQ(found.find("backbone"), nullptr);
}

// There is a hair in front of one picture, and a second, smaller arm in the other.
TEST_F(Estimate, IsNotMisledByAHairOrASecondArm) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  const auto changed = [&](std::size_t i, const std::string& name, const auto& change) {
    Image<std::uint8_t> picture = picture_of(arguments_.images[i]);
    change(picture);
    arguments_.images[i] = (folder_.path() / name).string();
    write_new_file(arguments_.images[i], png(picture));
  };
  const auto darken = [](Image<std::uint8_t>& picture, int u, int v) {
    for (int c = 0; c < picture.channels(); ++c)
      picture.at(u, v, c) = std::min<std::uint8_t>(picture.at(u, v, c), 25);
  };
  changed(0, "hair.png", [&](Image<std::uint8_t>& picture) {
    for (int u = 0; u < picture.width(); ++u)
      for (int k = 0; k < 2; ++k) darken(picture, u, 200 + u / 11 + k);
  });
  EXPECT_LT(error(answer(exit_done)), 1e-3);
  changed(1, "two.png", [&](Image<std::uint8_t>& picture) {
    for (int v = 60; v < 200; ++v)
      for (int u = 560; u < 574; ++u) darken(picture, u, v);
  });
  EXPECT_LT(error(answer(exit_done)), 1e-3);
}

// The pictures have half the size, and the cameras' file gives no size.
TEST_F(Estimate, SaysThatCamerasAreForPicturesOfAnotherSize) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  EXPECT_EQ(write_json(answer(exit_done)).find("another size"), std::string::npos);
  for (std::string& image : arguments_.images) {
    const Image<std::uint8_t> whole = picture_of(image);
    Image<std::uint8_t> half(whole.width() / 2, whole.height() / 2, whole.channels());
    for (int v = 0; v < half.height(); ++v)
      for (int u = 0; u < half.width(); ++u)
        for (int c = 0; c < half.channels(); ++c) half.at(u, v, c) = whole.at(2 * u, 2 * v, c);
    image += ".half.png";
    write_new_file(image, png(half));
  }
  const std::string found = write_json(answer(exit_missed));
  EXPECT_THAT(found, ::testing::HasSubstr("for pictures of another size, 2 times as large?"));
  EXPECT_THAT(found, ::testing::HasSubstr("picture 2 may not have the size of its camera"));
}

TEST_F(Estimate, SaysThatAPictureIsGivenTwice) {
  arguments_.images[1] = arguments_.images[0];
  const Node found = answer(exit_done);
  EXPECT_NE(write_json(*found.find("notes")).find("pictures 1 and 2 are identical"), std::string::npos);
  EXPECT_FALSE(*found.find("trusted")->as<bool>());
}

TEST_F(Estimate, SaysThatTheBaseIsGuessed) {
  const auto says = [&] {
    const Node found = answer(exit_done);
    const Node* notes = found.find("notes");
    return notes != nullptr && write_json(*notes).find("give the base with --base") != std::string::npos;
  };
  EXPECT_TRUE(says());
  arguments_.base = {0, 0, 0};
  EXPECT_FALSE(says());
}

TEST_F(Estimate, DoubtsPicturesOfTheOtherCameraAndNoneElse) {
  arguments_.arm = (folder_.path() / "arm.toml").string();
  const Node right = answer(exit_done);
  EXPECT_EQ(right.find("notes"), nullptr) << write_json(right);
  std::swap(arguments_.images[0], arguments_.images[1]);
  std::ostringstream out;
  const int status = estimate_command(arguments_, out);
  const Node wrong = parse_json(out.str(), "answer");
  EXPECT_NE(wrong.find(status == exit_done ? "notes" : "reason"), nullptr) << out.str();
}

}  // namespace
}  // namespace flexura
