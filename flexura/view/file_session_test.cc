#include "flexura/view/file_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexura/store/json.h"
#include "flexura/view/request.h"
#include "flexura/view/viewer.h"
#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// Two vertical tubes in front of a bright wall, a red one at u = 40 and a blue one at u = 110.
std::shared_ptr<const Photograph> two_tubes() {
  Photograph photograph;
  photograph.bytes = Image<std::uint8_t>(160, 200, 3);
  for (int v = 0; v < 200; ++v) {
    for (int u = 0; u < 160; ++u) {
      const bool is_red = std::abs(u - 40) < 6 && v >= 20, is_blue = std::abs(u - 110) < 8 && v >= 10;
      const std::array<int, 3> color = is_red    ? std::array{170, 30, 30}
                                       : is_blue ? std::array{30, 30, 150}
                                                 : std::array{220, 220, 220};
      for (int c = 0; c < 3; ++c)
        photograph.bytes.at(u, v, c) = static_cast<std::uint8_t>(color[static_cast<std::size_t>(c)]);
    }
  }
  return std::make_shared<const Photograph>(std::move(photograph));
}

std::shared_ptr<const Photograph> gray_one() {
  Photograph photograph;
  photograph.bytes = Image<std::uint8_t>(60, 80);
  return std::make_shared<const Photograph>(std::move(photograph));
}

class FileSessionTest : public ::testing::Test {
 protected:
  FileSessionTest()
      : viewer_({.session = "1", .pictures = {{"tubes.png", two_tubes()}, {"gray.png", gray_one()}}},
                messenger_, background_, 0) {
    viewer_.opened(me);
  }
  Node send(const std::string& text) {
    viewer_.on_message(me, text);
    return messenger_.last(me, "reply");
  }
  std::string error_of(const std::string& text) {
    const Node reply = send(text);
    const Node* error = reply.find("error");
    return error == nullptr ? "" : *error->as<std::string>();
  }
  // Returns u in the middle of the axis that is found, or nothing.
  std::optional<double> middle(const std::string& seeing) {
    const Node reply =
        send(R"({"id":3,"do":"measure","camera":"tubes.png","layers":["axis"],"seeing":)" + seeing + "}");
    const Node& result = *reply.find("result");
    if (!*result.find("found")->as<bool>()) return std::nullopt;
    const Node::Array& layers = *result.find("layers")->as<Node::Array>();
    const Node::Array& points = *layers.at(0).find("points")->as<Node::Array>();
    return points[points.size() / 2].as<Node::Array>()->at(0).as<double>()[0];
  }

  FakeMessenger messenger_;
  FakeBackground background_;
  Viewer viewer_;
};

TEST_F(FileSessionTest, GreetsWithThePicturesAndWithoutARig) {
  const Node hello = messenger_.last(me, "hello");
  EXPECT_EQ(*hello.find("mode")->as<std::string>(), "pictures");
  EXPECT_FALSE(*hello.find("rig")->as<bool>());
  EXPECT_FALSE(*hello.find("recording")->as<bool>());
  const Node::Array& cameras = *hello.find("scene")->find("cameras")->as<Node::Array>();
  ASSERT_EQ(cameras.size(), 2);
  EXPECT_EQ(write_json(cameras[0]), R"({"name":"tubes.png","width":160,"height":200,"channels":3})");
}

TEST_F(FileSessionTest, SendsEachPictureOnce) {
  EXPECT_EQ(error_of(R"({"id":1,"do":"images","camera":"tubes.png","rate":30})"), "");
  for (int i = 1; i < 10; ++i) viewer_.advance(i / 60.0);
  EXPECT_EQ(messenger_.count(me, 1), 1);
  EXPECT_EQ(messenger_.count(me, 2), 0);
  viewer_.on_message(me, R"({"do":"ack","camera":"tubes.png","number":0})");
  viewer_.advance(1);
  EXPECT_EQ(messenger_.count(me, 1), 1);
  EXPECT_EQ(error_of(R"({"id":1,"do":"images","camera":"tubes.png","rate":30})"), "");
  viewer_.advance(2);
  EXPECT_EQ(messenger_.count(me, 1), 2) << "a client that asks again may have lost it";
}

TEST_F(FileSessionTest, FindsTheTubeThatRegionColorOrBaseName) {
  EXPECT_NEAR(middle("{}").value(), 110, 1) << "the largest figure";
  EXPECT_NEAR(middle(R"({"region":[[10,0],[80,199]]})").value(), 40, 1);
  EXPECT_NEAR(middle(R"({"region":[[80,0],[150,0],[150,199],[80,199]]})").value(), 110, 1);
  EXPECT_NEAR(middle(R"({"color":[170,30,30]})").value(), 40, 1);
  EXPECT_NEAR(middle(R"({"base":[40,199]})").value(), 40, 1);
  EXPECT_FALSE(middle(R"({"region":[[300,300],[400,400]]})")) << "outside";
  EXPECT_NEAR(middle("{}").value(), 110, 1) << "nothing is kept";
}

TEST_F(FileSessionTest, SaysWhatIsWrongInOneLine) {
  const Node outside =
      send(R"({"id":3,"do":"measure","camera":"tubes.png","seeing":{"region":[[300,300],[400,400]]}})");
  EXPECT_THAT(*outside.find("result")->find("reason")->as<std::string>(), HasSubstr("the region has fewer"));
  const Node gray = send(R"({"id":3,"do":"measure","camera":"gray.png","seeing":{"color":[1,2,3]}})");
  EXPECT_THAT(*gray.find("result")->find("reason")->as<std::string>(), HasSubstr("the picture is gray"));
  EXPECT_THAT(error_of(R"({"id":3,"do":"color","camera":"gray.png","u":1,"v":1})"), HasSubstr("gray"));
  EXPECT_THAT(error_of(R"({"id":3,"do":"color","camera":"tubes.png","u":160,"v":1})"), HasSubstr("outside"));
  EXPECT_THAT(error_of(R"({"id":3,"do":"color","camera":"none","u":1,"v":1})"), HasSubstr("no picture"));
  for (const char* what : {"arm\",\"bends\":[[0,0]]", "halt\"", "open\"", "live\"", "experiment\"", "shape\"",
                           "run\"", "at\",\"time\":1", "branch\",\"time\":1", "point\",\"s\":0"})
    EXPECT_THAT(error_of(std::string(R"({"id":3,"do":")") + what + "}"), HasSubstr("there is no rig"));
}

TEST_F(FileSessionTest, ReadsPixelsAndColors) {
  const Node pixel = send(R"({"id":3,"do":"pixel","camera":"tubes.png","u":40,"v":100})");
  EXPECT_EQ(write_json(*pixel.find("result")->find("value")), "[170,30,30]");
  EXPECT_EQ(write_json(*pixel.find("result")->find("bits")), "8");
  const Node color = send(R"({"id":3,"do":"color","camera":"tubes.png","u":40,"v":100})");
  EXPECT_EQ(write_json(*color.find("result")->find("color")), "[170,30,30]");
}

TEST_F(FileSessionTest, RefusesTooLargePictures) {
  Photograph wide;
  wide.bytes = Image<std::uint8_t>(most_viewed_side + 1, 1);
  EXPECT_THROW(FileSession({{"wide.png", std::make_shared<const Photograph>(std::move(wide))}}, messenger_,
                           background_),
               std::invalid_argument);
}

}  // namespace
}  // namespace flexura
