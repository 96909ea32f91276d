#include "flexura/view/viewer.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "flexura/store/text_file.h"
#include "flexura/view/describe.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::StrEq;

// Returns the zoom unit of a rig's last camera.
std::string zoom_unit(const std::string& rig) {
  const Node controls = controls_node(*viewed_rig(rig));
  return *controls.find("heads")->as<Node::Array>()->back().find("zoom_unit")->as<std::string>();
}

std::string error_in(const Node& reply) {
  const Node* error = reply.find("error");
  return error == nullptr ? "" : *error->as<std::string>();
}

class ViewerTest : public ::testing::Test {
 protected:
  ViewerTest()
      : viewer_({.session = "0815", .rig = viewed_rig(), .results = folder_.path() / "run"}, messenger_,
                background_, 0) {
    viewer_.opened(me);
  }
  // Returns the reply to a message.
  Node send_text(const std::string& text) {
    viewer_.on_message(me, text);
    return messenger_.last(me, "reply");
  }
  [[nodiscard]] std::string mode() { return *messenger_.last(me, "hello").find("mode")->as<std::string>(); }
  // Returns this flag of the last hello.
  [[nodiscard]] bool says(const char* key) { return *messenger_.last(me, "hello").find(key)->as<bool>(); }
  static std::string error_of(const Node& reply) {
    const Node* error = reply.find("error");
    return error == nullptr ? "" : *error->as<std::string>();
  }

  TemporaryFolder folder_;
  FakeMessenger messenger_;
  FakeBackground background_;
  Viewer viewer_;
};

TEST_F(ViewerTest, GreetsFirstAndSaysAllThatThereIs) {
  const Node hello = parse_json(messenger_.texts[me].front(), "hello");
  EXPECT_EQ(*hello.find("type")->as<std::string>(), "hello");
  EXPECT_EQ(*hello.find("session")->as<std::string>(), "0815");
  EXPECT_EQ(*hello.find("title")->as<std::string>(), "Two sections");
  const Node& scene = *hello.find("scene");
  EXPECT_EQ(scene.find("arm")->find("sections")->as<Node::Array>()->size(), 2);
  EXPECT_EQ(*scene.find("arm")->find("kind")->as<std::string>(), "spatial");
  EXPECT_EQ(scene.find("screens")->as<Node::Array>()->size(), 2);
  EXPECT_TRUE(scene.find("etalon")->empty());
  const Node& ball = scene.find("obstacles")->as<Node::Array>()->front();
  EXPECT_EQ(*ball.find("name")->as<std::string>(), "ball");
  EXPECT_EQ(*ball.find("kind")->as<std::string>(), "sphere");
  EXPECT_EQ(*scene.find("cameras")->as<Node::Array>()->back().find("channels")->as<std::int64_t>(), 3);
  const Node& controls = *hello.find("controls");
  EXPECT_EQ(*controls.find("sections")->as<Node::Array>()->front().find("bend")->as<double>(), 2);
  EXPECT_TRUE(controls.find("sections")->as<Node::Array>()->front().find("bend_rate")->empty());
  EXPECT_TRUE(controls.find("tendons")->empty());
  EXPECT_EQ(*controls.find("heads")
                 ->as<Node::Array>()
                 ->front()
                 .find("pan")
                 ->as<Node::Array>()
                 ->front()
                 .as<double>(),
            -0.5);
  EXPECT_EQ(zoom_unit(viewed_text), "ratio");
  EXPECT_EQ(zoom_unit(viewed_text + R"([[camera]]
name = "measured"
mount = { position = [2, 0.5, 0], look_at = [0, 0.5, 0] }
lens = { zoom = [{ ratio = 1, count = 12 }, { ratio = 2, count = 300 }] }
)"),
            "count");
  EXPECT_EQ(*controls.find("tasks")->as<Node::Array>()->front().find("name")->as<std::string>(), "bend");
}

TEST_F(ViewerTest, RepliesToEverythingUnderItsNumber) {
  const Node pong = send_text(R"({"id":3,"do":"ping"})");
  EXPECT_EQ(*pong.find("id")->as<std::int64_t>(), 3);
  EXPECT_NE(pong.find("result"), nullptr);
  const Node bad = send_text(R"({"id":4,"do":"fly"})");
  EXPECT_EQ(*bad.find("id")->as<std::int64_t>(), 4);
  EXPECT_THAT(error_of(bad), HasSubstr("expected one of"));
  EXPECT_TRUE(send_text("nonsense").find("id")->empty());
  EXPECT_THAT(
      error_of(send_text(R"({"id":5,"do":"head","camera":"back","pan":0})")),
      StrEq("camera = \"back\": there is no camera with this name; expected one of \"front\", \"side\""));
  EXPECT_THAT(error_of(send_text("{\"id\":6,\"do\":\"\xff\"}")), HasSubstr("UTF-8"));
}

TEST_F(ViewerTest, DoesNotReplyToAnAcknowledgement) {
  const std::size_t texts = messenger_.texts[me].size();
  viewer_.on_message(me, R"({"do":"ack","camera":"front","number":0})");
  viewer_.on_message(me, R"({"id":1,"do":"ack","camera":"front","number":0})");
  EXPECT_EQ(messenger_.texts[me].size(), texts);
  EXPECT_THAT(error_of(send_text(R"({"do":"ack","camera":"back","number":0})")),
              HasSubstr("there is no camera"));
}

TEST_F(ViewerTest, SaysNothingToOneWhoHasLeft) {
  viewer_.opened(other);
  background_.is_prompt = false;
  viewer_.on_message(other, R"({"id":1,"do":"tip","position":[0,0.9,0.1]})");
  viewer_.closed(other);
  const std::size_t texts = messenger_.texts[other].size();
  background_.work();
  viewer_.on_message(other, R"({"id":1,"do":"ping"})");
  viewer_.advance(1);
  EXPECT_EQ(messenger_.texts[other].size(), texts);
  EXPECT_EQ(messenger_.count(other, 0), 0);
}

TEST_F(ViewerTest, GoesFromTheRigToTheLastRunAndBack) {
  EXPECT_THAT(error_of(send_text(R"({"id":1,"do":"open"})")), HasSubstr("there is no recording yet"));
  viewer_.on_message(me, R"({"id":2,"do":"arm","bends":[[-0.5,0],[0,0]]})");
  viewer_.on_message(me, R"({"id":3,"do":"run","speed":0})");
  viewer_.advance(1);
  EXPECT_EQ(mode(), "live");
  EXPECT_EQ(error_of(send_text(R"({"id":4,"do":"open"})")), "");
  EXPECT_EQ(mode(), "recording");
  EXPECT_TRUE(messenger_.state(me).is_recording);
  EXPECT_EQ(*messenger_.last(me, "hello").find("duration")->as<double>(), 1);
  send_text(R"({"id":5,"do":"live"})");
  EXPECT_EQ(mode(), "live");
  viewer_.advance(2);
  EXPECT_NEAR(messenger_.state(me).arm.bends[0].x(), 0.8, 1e-6) << "where the tasks left it";
}

TEST_F(ViewerTest, SaysWhetherThereIsARecordingToOpen) {
  EXPECT_FALSE(says("recording"));
  viewer_.on_message(me, R"({"id":1,"do":"run","speed":0})");
  viewer_.advance(1);
  viewer_.closed(me);
  viewer_.opened(me);
  EXPECT_EQ(mode(), "live");
  EXPECT_TRUE(says("recording"));
  EXPECT_TRUE(says("rig"));
}

// A messenger whose post() fails.
class BrokenMessenger : public FakeMessenger {
 public:
  void post(ClientId client, std::uint32_t stream, std::shared_ptr<const std::string> message) override {
    if (is_broken && client == me) throw std::runtime_error("nothing goes there");
    FakeMessenger::post(client, stream, std::move(message));
  }
  bool is_broken = false;
};

TEST(ViewerOfARig, ShowsARecordingToAllWhereItFailsForOne) {
  const TemporaryFolder folder;
  BrokenMessenger messenger;
  FakeBackground background;
  Viewer viewer({.session = "1", .rig = viewed_rig(), .results = folder.path() / "run"}, messenger,
                background, 0);
  viewer.opened(me);
  viewer.opened(other);
  viewer.on_message(me, R"({"id":1,"do":"run","speed":0})");
  viewer.advance(1);
  messenger.is_broken = true;
  viewer.on_message(other, R"({"id":2,"do":"open"})");
  EXPECT_EQ(messenger.texts[me].back(), R"({"type":"reply","id":null,"error":"nothing goes there"})");
  EXPECT_EQ(*messenger.last(other, "hello").find("mode")->as<std::string>(), "recording");
  EXPECT_TRUE(messenger.state(other).is_recording);
  viewer.on_message(other, R"({"id":3,"do":"at","time":0.5})");
  EXPECT_EQ(messenger.state(other).time, 0.5);
  viewer.advance(2);
}

TEST_F(ViewerTest, AnswersDocuments) {
  HttpAnswer got;
  const auto keep = [&](const HttpAnswer& answer) { got = answer; };
  viewer_.asked("/image/front.png", keep);
  EXPECT_EQ(got.status, 200);
  viewer_.asked("/series?names=tip_x", keep);
  EXPECT_EQ(got.status, 404);
  viewer_.asked("/secret", keep);
  EXPECT_EQ(got.status, 404);
  EXPECT_EQ(*parse_json(got.body, "body").find("error")->as<std::string>(), "nothing exists at this address");
}

TEST(ViewerOfARig, StaysAsItIsWhateverIsGot) {
  const TemporaryFolder folder;
  const auto last_state = [&](bool is_asked) {
    FakeMessenger messenger;
    FakeBackground background;
    Viewer viewer({.session = "0815", .rig = viewed_rig(), .results = folder.path() / "run"}, messenger,
                  background, 0);
    viewer.opened(me);
    viewer.on_message(me, R"({"id":1,"do":"arm","bends":[[0.5,0.2],[0,0]],"duration":1})");
    for (int i = 1; i < 50; ++i) {
      for (const char* target :
           {"/image/front.png", "/image/side.png?time=3", "/series?names=tip_x", "/report", "/reset", "/halt",
            "/arm?bends=[[1,0],[0,0]]", "/run", "/recording"}) {
        if (is_asked && i % 10 == 0) viewer.asked(target, [](const HttpAnswer&) {});
      }
      viewer.advance(i / 60.0);
    }
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "run"));
    return *messenger.posts[{me, 0}].back();
  };
  const std::string untouched = last_state(false);
  EXPECT_EQ(last_state(true), untouched);
  EXPECT_TRUE(read_state_message(untouched).value().is_moving);
}

TEST(ViewerOfARun, OpensItsRecordingAtItsEnd) {
  const TemporaryFolder folder;
  FakeMessenger messenger;
  FakeBackground background;
  const auto run = std::make_shared<RunLink>();
  const auto rig = viewed_rig();
  Viewer viewer({.session = "1", .rig = rig, .run = run}, messenger, background, 0);
  viewer.opened(me);
  viewer.advance(0.1);
  EXPECT_TRUE(*messenger.last(me, "hello").find("rig")->as<bool>());
  viewer.on_message(me, R"({"id":1,"do":"halt"})");
  EXPECT_THAT(*messenger.last(me, "reply").find("error")->as<std::string>(), HasSubstr("cannot halt"));
  run_linked(rig->experiment, folder.path(), *run);
  viewer.advance(0.2);
  const Node hello = messenger.last(me, "hello");
  EXPECT_EQ(*hello.find("mode")->as<std::string>(), "recording");
  EXPECT_FALSE(*hello.find("rig")->as<bool>());
  viewer.on_message(me, R"({"id":1,"do":"live"})");
  EXPECT_NE(messenger.last(me, "reply").find("error"), nullptr);
}

TEST(ViewerOfARecording, HasItsRigToGoTo) {
  const TemporaryFolder folder;
  FakeMessenger messenger;
  FakeBackground background;
  RunLink run;
  run_linked(viewed_rig()->experiment, folder.path(), run);
  Viewer viewer({.session = "1", .recording = std::make_shared<const Recording>(folder.path())}, messenger,
                background, 0);
  viewer.opened(me);
  EXPECT_TRUE(messenger.state(me).is_recording);
  EXPECT_TRUE(*messenger.last(me, "hello").find("rig")->as<bool>());
  viewer.on_message(me, R"({"id":1,"do":"live"})");
  viewer.advance(1);
  EXPECT_FALSE(messenger.state(me).is_recording);
  viewer.on_message(me, R"({"id":1,"do":"open"})");
  EXPECT_TRUE(messenger.state(me).is_recording);
}

TEST(ViewerOfARecording, StartsARigInAnInstantOfIt) {
  const TemporaryFolder folder;
  FakeMessenger messenger;
  FakeBackground background;
  const auto run = std::make_shared<RunLink>();
  std::filesystem::create_directory(folder.path() / "first");
  // The true arm and camera start elsewhere than their models.
  const auto rig = viewed_rig(viewed_text + R"(
[truth.arm]
initial = { bends = [[0.05, 0], [0, 0]] }
[[truth.camera]]
name = "front"
initial = { pan = 0.02 }
)");
  run_linked(rig->experiment, folder.path() / "first", *run);
  Viewer viewer({.session = "1",
                 .recording = std::make_shared<const Recording>(folder.path() / "first"),
                 .results = folder.path() / "next"},
                messenger, background, 0);
  viewer.opened(me);
  viewer.on_message(me, R"({"id":1,"do":"branch","time":0.5})");
  EXPECT_EQ(messenger.last(me, "reply").find("error"), nullptr);
  const Node hello = messenger.last(me, "hello");
  EXPECT_EQ(*hello.find("mode")->as<std::string>(), "live");
  EXPECT_EQ(*hello.find("title")->as<std::string>(), "Two sections (from 0.5 s)");
  EXPECT_TRUE(*hello.find("recording")->as<bool>());
  viewer.advance(0.1);
  const StateMessage start = messenger.state(me);
  EXPECT_FALSE(start.is_moving);
  EXPECT_NEAR(start.arm.bends[0].x(), 0.4 + 0.05, 1e-6) << "half of the way, and as far off as before";
  EXPECT_NEAR(start.arm.bends[1].y(), 0.35, 1e-6);
  EXPECT_NEAR(start.cameras[0].head.pan, 0.02, 1e-6);
  EXPECT_NEAR(start.cameras[0].commanded_head.pan, 0, 1e-6);

  // Tasks go from there, and reset goes back there.
  viewer.on_message(me, R"({"id":2,"do":"run","speed":0})");
  viewer.advance(0.2);
  EXPECT_NEAR(messenger.state(me).arm.bends[0].x(), 0.8 + 0.05, 1e-6);
  viewer.on_message(me, R"({"id":3,"do":"reset"})");
  viewer.advance(0.3);
  EXPECT_NEAR(messenger.state(me).arm.bends[0].x(), 0.4 + 0.05, 1e-6);
  // The run's results say where it started, and it can be branched in turn.
  viewer.on_message(me, R"({"id":4,"do":"open"})");
  EXPECT_NEAR(messenger.state(me).arm.bends[0].x(), 0.4, 1e-6);
  viewer.on_message(me, R"({"id":5,"do":"branch","time":1})");
  viewer.advance(0.4);
  EXPECT_NEAR(messenger.state(me).arm.bends[0].x(), 0.8 + 0.05, 1e-6);
  viewer.on_message(me, R"({"id":6,"do":"branch","time":1})");
  EXPECT_THAT(*messenger.last(me, "reply").find("error")->as<std::string>(),
              HasSubstr("expected a recording"));
}

TEST(ViewerOfARig, GivesChecksAndSavesTheTextOfItsExperiment) {
  const TemporaryFolder folder;
  FakeMessenger messenger;
  FakeBackground background;
  const std::string text = "# Mine.\n" + viewed_text;
  Viewer viewer({.session = "1",
                 .rig = viewed_rig(text),
                 .results = folder.path() / "results",
                 .text = text,
                 .folder = folder.path(),
                 .stem = "mine"},
                messenger, background, 0);
  viewer.opened(me);
  const auto ask = [&](const std::string& members) {
    viewer.on_message(me, "{\"id\":1," + members + "}");
    return messenger.last(me, "reply");
  };
  const auto text_of = [](const Node& reply, const char* key) {
    return *reply.find("result")->find(key)->as<std::string>();
  };
  EXPECT_EQ(text_of(ask(R"("do":"experiment")"), "text"), text);
  ask(R"("do":"arm","bends":[[-0.5,0],[0,0]])");
  ask(R"("do":"head","camera":"front","pan":0.25)");
  for (int i = 1; i < 30; ++i) viewer.advance(0.1 * i);
  const Node pose = ask(R"("do":"experiment","add":"pose")");
  EXPECT_EQ(text_of(pose, "name"), "mine-2.toml");
  EXPECT_THAT(text_of(pose, "text"), HasSubstr("to = { bends = [[-0.5, 0], [0, 0]] }"));
  EXPECT_THAT(text_of(ask(R"("do":"experiment","add":"view","camera":"front")"), "text"),
              HasSubstr("initial = { pan = 0.25, tilt = 0, zoom = 1 }"));
  EXPECT_THAT(error_in(ask(R"("do":"experiment","add":"view","camera":"back")")), HasSubstr("no camera"));

  const Node problems = *ask(R"("do":"check","text":"[arm]\nkind = 3\n")").find("result")->find("problems");
  const Node& first = problems.as<Node::Array>()->back();
  EXPECT_EQ(*first.find("line")->as<std::int64_t>(), 2);
  EXPECT_EQ(*first.find("column")->as<std::int64_t>(), 8);
  EXPECT_THAT(*first.find("text")->as<std::string>(), HasSubstr("arm.kind = 3"));

  const std::string good = write_json({Node::Table{{"text", {}, text_node(text)}}, {}});
  const auto save = [&](const std::string& name) {
    return ask(good.substr(1, good.size() - 2) + R"(,"do":"save","name":")" + name + '"');
  };
  EXPECT_EQ(text_of(save("mine-2.toml"), "file"), (folder.path() / "mine-2.toml").string());
  EXPECT_EQ(read_text_file(folder.path() / "mine-2.toml", 10'000), text);
  EXPECT_THAT(error_in(save("mine-2.toml")), HasSubstr("already exists"));
  EXPECT_THAT(error_in(save("../mine.toml")), HasSubstr("expected a name"));
  const Node refused = ask(R"("do":"save","name":"bad.toml","text":"seed = -1")");
  EXPECT_EQ(refused.find("result")->find("file"), nullptr);
  EXPECT_FALSE(refused.find("result")->find("problems")->as<Node::Array>()->empty());
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "bad.toml"));
}

TEST(ViewerOfARun, CanBeContinuedFromItsRecording) {
  const TemporaryFolder folder;
  FakeMessenger messenger;
  FakeBackground background;
  const auto run = std::make_shared<RunLink>();
  const auto rig = viewed_rig();
  Viewer viewer({.session = "1", .rig = rig, .run = run}, messenger, background, 0);
  viewer.opened(me);
  viewer.on_message(me, R"({"id":1,"do":"branch","time":0})");
  EXPECT_NE(messenger.last(me, "reply").find("error"), nullptr);
  run_linked(rig->experiment, folder.path(), *run);
  viewer.advance(0.2);
  viewer.on_message(me, R"({"id":2,"do":"branch","time":1})");
  const Node hello = messenger.last(me, "hello");
  EXPECT_EQ(*hello.find("mode")->as<std::string>(), "live");
  EXPECT_TRUE(*hello.find("rig")->as<bool>());
  EXPECT_FALSE(*hello.find("readonly")->as<bool>()) << "nobody else moves this rig";
  viewer.advance(0.3);
  EXPECT_NEAR(messenger.state(me).arm.bends[0].x(), 0.8, 1e-6);
}

TEST(ViewerExamples, AreOfferedAndOpenedOneAfterAnother) {
  FakeMessenger messenger;
  FakeBackground background;
  const auto load = [] { return viewed_rig(); };
  Viewer viewer({.session = "0815",
                 .rig = viewed_rig(),
                 .results = "results",
                 .examples = {{"bow", "An arm that bows", load, "results/bow"},
                              {"wave", "A wave", load, "results/wave"}}},
                messenger, background, 0);
  viewer.opened(me);
  const Node::Array offered = *messenger.last(me, "hello").find("examples")->as<Node::Array>();
  ASSERT_EQ(offered.size(), 2);
  EXPECT_EQ(*offered[0].find("name")->as<std::string>(), "bow");
  EXPECT_EQ(*offered[1].find("title")->as<std::string>(), "A wave");
  const auto hellos = [&] {
    return std::ranges::count_if(messenger.texts[me], [](const std::string& text) {
      return text.find(R"("type":"hello")") != std::string::npos;
    });
  };
  for (const char* name : {"wave", "bow", "wave"}) {
    const auto before = hellos();
    viewer.on_message(me, fmt::format(R"({{"id":1,"do":"open","example":"{}"}})", name));
    EXPECT_EQ(messenger.last(me, "reply").find("error"), nullptr) << name;
    EXPECT_EQ(hellos(), before + 1) << "everybody is greeted by the new rig";
    viewer.advance(1);
  }
  viewer.on_message(me, R"({"id":2,"do":"open","example":"spider"})");
  EXPECT_THAT(*messenger.last(me, "reply").find("error")->as<std::string>(),
              HasSubstr(R"(no example "spider")"));
  viewer.on_message(me, R"({"id":3,"do":"open"})");
  EXPECT_THAT(*messenger.last(me, "reply").find("error")->as<std::string>(), HasSubstr("no recording yet"));
}

}  // namespace
}  // namespace flexura
