#include "flexura/app/intrinsics.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "flexura/app/commands.h"
#include "flexura/base/bytes.h"
#include "flexura/base/image.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/base/table.h"
#include "flexura/board/board_target.h"
#include "flexura/camera/measured_camera.h"
#include "flexura/camera/zoom.h"
#include "flexura/experiment/experiment.h"
#include "flexura/math/so3.h"
#include "flexura/picture/image_file.h"
#include "flexura/picture/orientation.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "flexura/store/toml.h"
#include "tests/support/boards.h"
#include "tests/support/oriented_files.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using testing::HasSubstr;

constexpr int width = 240, height = 180;
const BoardTarget board{.columns = 6, .rows = 5, .square = 0.03};

Intrinsics lens_of(double focal) { return {.fx = focal, .fy = focal, .cx = 119.5, .cy = 89.5}; }

// Pictures of a board, taken by cameras without distortion, as in a laboratory.
class IntrinsicsCommand : public testing::Test {
 protected:
  void SetUp() override {
    arguments_.board = "6x5";
    arguments_.square = board.square;
    arguments_.distortion = 0;
    arguments_.json = true;
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string write(const std::string& name, const Image<std::uint8_t>& picture) {
    write_new_file(folder_.path() / name, png(picture));
    return path(name);
  }
  // Takes pictures of boards by the camera at X_1C; the boards are the same for every camera.
  std::vector<std::string> photograph(const std::string& name, double focal, const Pose& X_1C = {},
                                      int count = 5) {
    std::vector<std::string> files;
    for (int i = 0; i < count; ++i) {
      TestRandom random(static_cast<std::uint64_t>(i) + 7);
      const Pose X_1B = random_board(random, board, 0.0013 * focal, 0.6, 0.02);
      files.push_back(
          write(fmt::format("{}{}.png", name, i),
                board_picture(board, Lens(lens_of(focal)), X_1C.inverse() * X_1B, width, height)));
    }
    return files;
  }
  Node answer(int status) {
    std::ostringstream out, err;
    EXPECT_EQ(intrinsics_command(arguments_, out, err), status) << out.str();
    return parse_json(out.str(), "answer");
  }
  std::string refusal() {
    std::ostringstream out, err;
    try {
      (void)intrinsics_command(arguments_, out, err);
    } catch (const InputError& error) {
      EXPECT_EQ(out.str(), "");
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    ADD_FAILURE() << "not refused: " << out.str();
    return "";
  }
  static double number(const Node& node, const char* key) { return *node.find(key)->as<double>(); }
  static const Node& entry(const Node& node, const char* key, std::size_t i) {
    return node.find(key)->as<Node::Array>()->at(i);
  }

  TemporaryFolder folder_;
  IntrinsicsArguments arguments_;
};

TEST_F(IntrinsicsCommand, MeasuresACameraAndKeepsEarlierFiles) {
  arguments_.images = photograph("a", 260);
  arguments_.images.push_back(write("blank.png", Image<std::uint8_t>(width, height, 1, 200)));
  arguments_.out = path("cameras.toml");
  arguments_.position = {1, 2, 3};
  const Node found = answer(exit_done);
  const Node& camera = entry(found, "cameras", 0);
  EXPECT_NEAR(number(camera, "fx"), 260, 4 * number(*camera.find("sigma"), "fx") + 0.5);
  EXPECT_LT(number(found, "rms_px"), 0.15);
  EXPECT_EQ(*camera.find("views_used")->as<std::int64_t>(), 5);
  EXPECT_EQ(camera.find("covariance")->as<Node::Array>()->size(), 4U);
  EXPECT_THAT(*entry(camera, "views", 5).find("reason")->as<std::string>(),
              HasSubstr("does not contain a complete board"));
  EXPECT_EQ(*found.find("file")->as<std::string>(), path("cameras.toml"));
  const std::string first = read_text_file(path("cameras.toml"), 1 << 20);
  const auto written = read_as<MeasuredCameras>(read_toml_file(path("cameras.toml"))).camera;
  ASSERT_EQ(written.size(), 1U);
  EXPECT_EQ(written[0].fx, number(camera, "fx"));
  EXPECT_EQ(written[0].pose().position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(written[0].size, (std::array<std::int64_t, 2>{width, height}));
  const auto three_sigmas = [&](const char* key) {
    return 3 * number(*camera.find("sigma"), key) / written[0].fx;
  };
  EXPECT_NEAR(written[0].prior.focal_std, std::max(three_sigmas("fx"), three_sigmas("fy")), 1e-5);
  EXPECT_NEAR(written[0].prior.rotation_std, std::max(three_sigmas("cx"), three_sigmas("cy")), 1e-4);
  // Residuals and covariance are kept with it.
  const std::string head = "\n# The estimates, as JSON:\n# ";
  const std::size_t at = first.find(head);
  ASSERT_NE(at, std::string::npos);
  const Node kept = parse_json(first.substr(at + head.size()), "the remark");
  EXPECT_EQ(write_json(*kept.find("covariance")), write_json(*camera.find("covariance")));
  EXPECT_EQ(kept.find("views")->as<Node::Array>()->size(), 6U);
  // Calibrate again from fewer pictures.
  arguments_.images.pop_back(), arguments_.images.pop_back();
  EXPECT_EQ(*answer(exit_done).find("file")->as<std::string>(), path("cameras-2.toml"));
  EXPECT_EQ(read_text_file(path("cameras.toml"), 1 << 20), first);
}

TEST_F(IntrinsicsCommand, MeasuresWhereTheSecondCameraOfAPairStands) {
  const Pose X_12{so3_exp({0.02, -0.14, -0.03}), {0.05, 0.01, -0.02}};
  arguments_.left = photograph("left", 260), arguments_.right = photograph("right", 260, X_12);
  arguments_.names = {"front", "side"};
  arguments_.rig = path("rig.toml"), arguments_.out = path("pair.toml");
  arguments_.rotation = {0, 1, 0, 0};
  arguments_.hold_out = 5;
  const Node found = answer(exit_done);
  const Node& pair = *found.find("pair");
  const auto& position = *pair.find("position")->as<Node::Array>();
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(*position[i].as<double>(), X_12.position[static_cast<Eigen::Index>(i)], 1.5e-3);
  const auto written = read_as<MeasuredCameras>(read_toml_file(path("pair.toml"))).camera;
  for (const Node& sigma : *pair.find("sigma_rotation")->as<Node::Array>())
    EXPECT_GE(written.at(1).prior.rotation_std, 2.999 * *sigma.as<double>());
  EXPECT_EQ(*found.find("held_out")->find("views")->as<std::int64_t>(), 1);
  EXPECT_NE(entry(found, "cameras", 1).find("rms_alone_px"), nullptr);
  // An experiment can include the rig file.
  write_new_file(folder_.path() / "experiment.toml", "include = ['rig.toml']\n[[arm.section]]\nlength = 1\n");
  const auto cameras = load_experiment(path("experiment.toml")).cameras();
  ASSERT_EQ(cameras.size(), 2U);
  EXPECT_EQ(cameras[1].name, "side");
  EXPECT_EQ(cameras[1].sensor.width, width);
  const Pose X_WC = cameras[1].mount.pose();
  EXPECT_NEAR(X_WC.position.y(), -X_12.position.y(), 1.5e-3);
  EXPECT_LT((X_WC.rotation - so3_exp({std::numbers::pi, 0, 0}) * X_12.rotation).norm(), 5e-3);
}

TEST_F(IntrinsicsCommand, MeasuresAPairBeforeABoardThatLooksTheSameUpsideDown) {
  const BoardTarget small{.columns = 6, .rows = 4, .square = 0.03};
  const Lens lens(lens_of(260));
  const Pose X_12{so3_exp({0.02, -0.14, 0.3}), {0.05, 0.01, -0.02}};
  for (std::uint64_t i = 0; i < 5; ++i) {
    TestRandom random(i + 7);
    Pose X_1B = random_board(random, small, 0.34, 0.6, 0.02);
    const Eigen::Vector3d middle(2.5 * small.square, 1.5 * small.square, 0);
    const Eigen::Matrix3d turned = so3_exp({0, 0, 1.3});
    X_1B = X_1B * Pose{turned, middle - turned * middle};
    const auto name = [&](const char* side) { return fmt::format("{}{}.png", side, i); };
    arguments_.left.push_back(write(name("left"), board_picture(small, lens, X_1B, width, height)));
    arguments_.right.push_back(
        write(name("right"), board_picture(small, lens, X_12.inverse() * X_1B, width, height)));
  }
  arguments_.board = "6x4";
  const Node found = answer(exit_done);
  EXPECT_NEAR(number(*found.find("pair"), "distance"), X_12.position.norm(), 1e-3);
  // With one common view, both orders fit.
  for (std::size_t i = 1; i < 5; ++i)
    (i % 2 == 0 ? arguments_.left : arguments_.right)[i] =
        write(fmt::format("blank{}.png", i), Image<std::uint8_t>(width, height, 1, 200));
  EXPECT_THAT(*answer(exit_missed).find("reason")->as<std::string>(), HasSubstr("fit in two orders"));
}

// A picture stored upside down, with the tag that says so, is like the upright one.
TEST_F(IntrinsicsCommand, HeedsTheOrientationOfPictures) {
  arguments_.images = photograph("a", 260);
  const Node expected = answer(exit_done);
  for (const int orientation : {3, 6}) {
    Image<std::uint8_t> picture = std::get<Image<std::uint8_t>>(
        read_picture(bytes_of(read_text_file(arguments_.images[1], 1 << 20)), "a1.png", 1 << 20));
    // Half a turn, or a quarter turn; orientation 8 stores the inverse of 6.
    picture = std::get<Image<std::uint8_t>>(upright(picture, orientation == 3 ? 3 : 8));
    IntrinsicsArguments kept = arguments_;
    arguments_.images[1] = path(fmt::format("turned{}.png", orientation));
    write_new_file(arguments_.images[1], oriented_png(picture, orientation));
    const Node found = answer(exit_done);
    EXPECT_EQ(number(entry(found, "cameras", 0), "cx"), number(entry(expected, "cameras", 0), "cx"));
    EXPECT_EQ(number(found, "rms_px"), number(expected, "rms_px"));
    ASSERT_NE(found.find("notes"), nullptr);
    EXPECT_THAT(write_json(*found.find("notes")), HasSubstr("was turned as its orientation tag says"));
    arguments_ = kept;
  }
}

TEST_F(IntrinsicsCommand, NamesTheFactorOfLengthsThatAreNotInMetres) {
  arguments_.images = photograph("a", 260);
  EXPECT_EQ(answer(exit_done).find("notes"), nullptr);
  for (const auto& [factor, text] : {std::pair{1000.0, "in mm, divide it by 1000: --square 0.03"},
                                     {100.0, "in cm, divide it by 100: --square 0.03"}}) {
    arguments_.square = factor * board.square;
    EXPECT_THAT(write_json(*answer(exit_done).find("notes")), HasSubstr(text));
  }
  arguments_.square = board.square;
  arguments_.position = {900, 0, -1200};
  EXPECT_THAT(write_json(*answer(exit_done).find("notes")),
              HasSubstr("--position is 1500 m from the origin, but the boards are 0."));
  arguments_.position = {0.9, 0, -1.2};
  EXPECT_EQ(answer(exit_done).find("notes"), nullptr);
}

TEST_F(IntrinsicsCommand, NamesTheGridThatThePicturesShow) {
  const BoardTarget circles{.pattern = BoardPattern::circles, .columns = 6, .rows = 4};
  const Lens lens({.fx = 330, .fy = 330, .cx = 159.5, .cy = 119.5});
  for (std::uint64_t i = 1; i < 4; ++i) {
    TestRandom random(i);
    arguments_.images.push_back(
        write(fmt::format("{}.png", i),
              board_picture(circles, lens, random_board(random, circles, 0.3, 0.4, 0.02), 320, 240)));
  }
  arguments_.pattern = "circles", arguments_.board = "7x5";
  EXPECT_THAT(*entry(entry(answer(exit_missed), "cameras", 0), "views", 0).find("reason")->as<std::string>(),
              HasSubstr("the picture shows a grid of 6x4 circles, not of 7x5"));
  // The same grid, counted along the other side.
  arguments_.board = "4x6";
  EXPECT_EQ(*entry(answer(exit_done), "cameras", 0).find("views_used")->as<std::int64_t>(), 3);
}

TEST_F(IntrinsicsCommand, MeasuresAZoom) {
  int number_of = 0;
  for (const double focal : {240.0, 360.0, 500.0}) {
    const std::string name = fmt::format("zoom{}", ++number_of);
    std::filesystem::create_directory(folder_.path() / name);
    (void)photograph(name + "/", focal);
    write_new_file(folder_.path() / name / "notes.txt", "no picture");
    arguments_.zooms.push_back(fmt::format("@{}={}", 1000 - 200 * number_of, path(name)));
  }
  arguments_.rig = path("rig.toml");
  arguments_.names = {"front"};
  Node found = answer(exit_done);
  EXPECT_NEAR(number(entry(found, "zoom", 2), "ratio"), 500.0 / 240, 0.03);
  write_new_file(folder_.path() / "experiment.toml", "include = ['rig.toml']\n[[arm.section]]\nlength = 1\n");
  const CameraConfig camera = load_experiment(path("experiment.toml")).cameras().at(0);
  EXPECT_EQ(camera.lens.zoom.size(), 3U);
  const ZoomTable table(camera.lens, width, height);
  EXPECT_NEAR(table.at(600).fx, 360, 4);
  EXPECT_EQ(found.find("notes"), nullptr);
  // Notes report ratios that contradict the focal lengths.
  {
    const auto zooms =
        std::exchange(arguments_.zooms, {"1=" + path("zoom1"), "1.5=" + path("zoom2"), "5=" + path("zoom3")});
    const auto rig = std::exchange(arguments_.rig, "");
    const Node uncertain = answer(exit_done);
    ASSERT_NE(uncertain.find("notes"), nullptr);
    const auto& notes = *uncertain.find("notes")->as<Node::Array>();
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].as<std::string>()->find("zoom3: the given zoom ratio is 5 times"), std::string::npos);
    arguments_.zooms = zooms, arguments_.rig = rig;
  }
  // The lens replaces that of an existing camera.
  write_new_file(
      folder_.path() / "before.toml",
      "[[arm.section]]\nlength = 1\n[[camera]]\nname = 'front'\nmount = { position = [0, 0, 5], look_at = "
      "[0, 0, 0] }\n[[camera]]\nname = 'side'\nmount = { position = [5, 0, 0], look_at = [0, 0, 0] }\n");
  arguments_.rig_from = path("before.toml");
  EXPECT_EQ(*answer(exit_done).find("rig")->as<std::string>(), path("rig-2.toml"));
  write_new_file(folder_.path() / "after.toml", "include = ['rig-2.toml']\n[[arm.section]]\nlength = 1\n");
  const auto cameras = load_experiment(path("after.toml")).cameras();
  ASSERT_EQ(cameras.size(), 2U);
  EXPECT_EQ(cameras[0].mount.position[2], 5);
  EXPECT_EQ(cameras[0].lens.zoom.size(), 3U);
  EXPECT_TRUE(cameras[1].lens.zoom.empty());
  arguments_.names = {"other"};
  EXPECT_THAT(refusal(), HasSubstr("no camera"));
}

TEST_F(IntrinsicsCommand, DoesNotTakeForAZoomWhatDoesNotZoom) {
  arguments_.images = {};
  for (const std::string name : {"one", "two"}) {
    std::filesystem::create_directory(folder_.path() / name);
    (void)photograph(name + "/", 260);
    arguments_.zooms.push_back(fmt::format("{}={}", name == "one" ? 1 : 2, path(name)));
  }
  EXPECT_THAT(*answer(exit_missed).find("reason")->as<std::string>(), HasSubstr("increase from row to row"));
}

TEST_F(IntrinsicsCommand, SaysAtWhichZoomNoCameraIsFound) {
  for (const char* name : {"wide", "long"}) std::filesystem::create_directory(folder_.path() / name);
  (void)photograph("wide/", 260);
  for (const char* name : {"long/a.png", "long/b.png"})
    (void)write(name, Image<std::uint8_t>(width, height, 1, 200));
  arguments_.zooms = {"1=" + path("wide"), "2=" + path("long")};
  arguments_.rig = path("rig.toml");
  const Node found = answer(exit_missed);
  EXPECT_FALSE(*found.find("found")->as<bool>());
  EXPECT_THAT(*found.find("reason")->as<std::string>(), HasSubstr(path("long") + ": no view"));
  EXPECT_EQ(entry(found, "zoom", 0).find("reason"), nullptr);
  EXPECT_NE(entry(found, "zoom", 1).find("reason"), nullptr);
  EXPECT_FALSE(std::filesystem::exists(path("rig.toml")));
}

TEST_F(IntrinsicsCommand, SaysWhyThereIsNoCamera) {
  for (const char* name : {"a.png", "b.png"})
    arguments_.images.push_back(write(name, Image<std::uint8_t>(width, height, 1, 200)));
  arguments_.out = path("cameras.toml");
  EXPECT_THAT(*answer(exit_missed).find("reason")->as<std::string>(), HasSubstr("no view"));
  EXPECT_FALSE(std::filesystem::exists(path("cameras.toml")));
}

TEST_F(IntrinsicsCommand, SaysThatPicturesOfAPairDoNotBelongTogether) {
  const Pose X_12{so3_exp({0.02, -0.14, -0.03}), {0.05, 0.01, -0.02}};
  arguments_.left = photograph("left", 260), arguments_.right = photograph("right", 260, X_12);
  arguments_.out = path("pair.toml");
  std::ranges::rotate(arguments_.right, arguments_.right.begin() + 1);
  EXPECT_THAT(*answer(exit_missed).find("reason")->as<std::string>(),
              HasSubstr("its pictures do not match those of camera 1"));
  EXPECT_FALSE(std::filesystem::exists(path("pair.toml")));
}

TEST_F(IntrinsicsCommand, RefusesPicturesThatAreGivenTwice) {
  arguments_.images = photograph("a", 260);
  arguments_.images.push_back(arguments_.images[1]);
  EXPECT_THAT(refusal(), HasSubstr("a1.png: is given twice: expected"));
  std::filesystem::copy(path("a3.png"), path("copy.png"));
  arguments_.images.back() = path("copy.png");
  EXPECT_THAT(refusal(), HasSubstr("copy.png: the same picture as " + path("a3.png")));
  arguments_.images.pop_back();
  arguments_.left = arguments_.right = arguments_.images, arguments_.images = {};
  EXPECT_THAT(refusal(), HasSubstr("a0.png: is given twice (and 4 more like it)"));
}

TEST_F(IntrinsicsCommand, RefusesTheNumberOfAPartOfTheBoard) {
  const BoardTarget circles{.pattern = BoardPattern::circles, .columns = 7, .rows = 5};
  const Lens lens({.fx = 330, .fy = 330, .cx = 159.5, .cy = 119.5});
  for (std::uint64_t i = 1; i < 4; ++i) {
    TestRandom random(i);
    const Pose X_CB = random_board(random, circles, 0.3, 0.4, 0.02);
    arguments_.images.push_back(
        write(fmt::format("{}.png", i), board_picture(circles, lens, X_CB, 320, 240)));
  }
  arguments_.pattern = "circles", arguments_.board = "6x5";
  EXPECT_THAT(refusal(), HasSubstr("--board: 6x5: the board has more points than this"));
  arguments_.board = "7x5";
  EXPECT_EQ(*entry(answer(exit_done), "cameras", 0).find("views_used")->as<std::int64_t>(), 3);
}

TEST_F(IntrinsicsCommand, WritesBothFilesOrNone) {
  arguments_.images = photograph("a", 260);
  arguments_.out = path("cameras.toml"), arguments_.rig = path("nowhere/rig.toml");
  EXPECT_THAT(refusal(), HasSubstr("--rig"));
  EXPECT_FALSE(std::filesystem::exists(path("cameras.toml")));
  // A file name that is too long for the file system fails only when it is written.
  arguments_.rig = path(std::string(300, 'r') + ".toml");
  std::ostringstream out, err;
  EXPECT_THROW((void)intrinsics_command(arguments_, out, err), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(path("cameras.toml")));
}

TEST_F(IntrinsicsCommand, RefusesPicturesThatItCannotUse) {
  const std::string good = write("good.png", Image<std::uint8_t>(width, height));
  arguments_.images = {good};
  EXPECT_THAT(refusal(), HasSubstr("expected at least two"));
  arguments_.images = {good, write("other.png", Image<std::uint8_t>(height, width))};
  EXPECT_THAT(refusal(), HasSubstr("expected 240 x 180"));
  write_new_file(folder_.path() / "cut.png",
                 png(board_picture(board, Lens(lens_of(200)), {}, 60, 40)).substr(0, 100));
  arguments_.images = {good, path("cut.png")};
  EXPECT_THAT(refusal(), HasSubstr("cut.png"));
  arguments_.images = {good, path("missing.png")};
  EXPECT_THAT(refusal(), HasSubstr("no such file"));
  arguments_.images = {};
  EXPECT_THAT(refusal(), HasSubstr("--left"));
  arguments_.left = {good, good}, arguments_.right = {good};
  EXPECT_THAT(refusal(), HasSubstr("--right: 1 picture for 2 of --left: expected one per picture of --left"));
}

TEST_F(IntrinsicsCommand, RefusesNumbersThatItCannotUse) {
  arguments_.images = {"a.png", "b.png"};
  const IntrinsicsArguments good = arguments_;
  for (const char* text :
       {"", "9", "x", "9x", "0x6", "9x-6", "2x6", "1000000x1000000", "99999999999x6", "9x6x2", "9.5x6"}) {
    arguments_.board = text;
    EXPECT_THAT(refusal(), HasSubstr("--board")) << text;
  }
  arguments_ = good;
  for (const double square : {0.0, -0.1, 1e300, 1e-300, std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity()}) {
    arguments_.square = square;
    EXPECT_THAT(refusal(), HasSubstr("--square"));
  }
  const auto refuses = [&](const char* what, auto&& change) {
    arguments_ = good;
    change(arguments_);
    EXPECT_THAT(refusal(), HasSubstr(what));
  };
  refuses("--pattern", [](auto& a) { a.pattern = "dots"; });
  refuses("--distortion", [](auto& a) { a.distortion = 6; });
  for (const std::int64_t every : {-1, 0, 1}) refuses("--hold-out", [&](auto& a) { a.hold_out = every; });
  refuses("--position", [](auto& a) { a.position = {0, NAN, 0}; });
  refuses("--rotation", [](auto& a) { a.rotation = {0, 0, 0, 0}; });
  refuses("--out", [](auto& a) { a.out = "a.png"; });
  refuses("--rig-from", [](auto& a) { a.rig_from = "a.toml"; });
  for (const char* zoom : {"", "1", "1=", "=a", "@=a", "0=a", "-1=a", "nan=a", "1@x=a"})
    refuses("--zoom", [&](auto& a) { a.images = {}, a.zooms = {zoom, "2=b"}; });
  refuses("--zoom", [](auto& a) { a.images = {}, a.zooms = {"1=a", "2@5=b"}; });
  refuses("cannot be read", [](auto& a) { a.images = {}, a.zooms = {"1=a", "2=b"}; });
}

TEST_F(IntrinsicsCommand, PrintsAShortTableUnlessAskedForJson) {
  arguments_.images = photograph("a", 260);
  arguments_.images.push_back(write("blank.png", Image<std::uint8_t>(width, height, 1, 200)));
  arguments_.out = path("cameras.toml");
  arguments_.json = false;
  std::ostringstream out, err;
  EXPECT_EQ(intrinsics_command(arguments_, out, err), exit_done);
  EXPECT_THAT(out.str(), HasSubstr("fx (px)         26"));
  EXPECT_THAT(out.str(), HasSubstr(" +- "));
  EXPECT_THAT(out.str(), HasSubstr("pictures used   5 of 6\n"));
  EXPECT_THAT(out.str(), HasSubstr("blank.png: the picture does not contain a complete board"));
  EXPECT_THAT(out.str(), HasSubstr("file: " + path("cameras.toml")));
  EXPECT_LT(std::ranges::count(out.str(), '\n'), 15);
  EXPECT_EQ(err.str(), "") << "no terminal";
}

TEST_F(IntrinsicsCommand, SaysOfAGlobWithoutAMatchThatTheFileIsMissing) {
  arguments_.images = {path("left*.jpg")};
  EXPECT_THAT(refusal(), HasSubstr("left*.jpg: no such file"));
}

}  // namespace
}  // namespace flexura
