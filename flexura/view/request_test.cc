#include "flexura/view/request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "flexura/view/document.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

template <class S>
S read_as_ask(const std::string& text) {
  const Request request = read_request(text);
  EXPECT_EQ(request.error, "") << text;
  EXPECT_EQ(request.id, 7) << text;
  const auto* ask = std::get_if<S>(&request.ask);
  return ask == nullptr ? (ADD_FAILURE() << text, S{}) : *ask;
}

TEST(Request, ReadsEverythingThatAPageCanAsk) {
  const auto arm =
      read_as_ask<ArmRequest>(R"({"id":7,"do":"arm","bends":[[1,2]],"stretches":[1],"duration":2})");
  EXPECT_EQ(arm.bends->at(0), (std::array{1.0, 2.0}));
  EXPECT_EQ(arm.duration, 2);
  EXPECT_EQ(read_as_ask<ArmRequest>(R"({"id":7,"do":"arm","tendons":[0.1]})").tendons->at(0), 0.1);
  EXPECT_EQ(read_as_ask<ArmRequest>(R"({"do":"arm","cord_angles":[1.5],"id":7})").cord_angles->at(0), 1.5);
  EXPECT_EQ(read_as_ask<ArmRequest>(R"({"do":"arm","archings":[2],"id":7})").archings->at(0), 2);
  const auto tip = read_as_ask<TipRequest>(R"({"id":7,"do":"tip","position":[1,2,3],"direction":[0,0,1]})");
  EXPECT_EQ(tip.position[2], 3);
  EXPECT_TRUE(tip.direction);
  EXPECT_EQ(read_as_ask<HeadRequest>(R"({"id":7,"do":"head","camera":"front","pan":0.1})").pan, 0.1);
  EXPECT_EQ(read_as_ask<StageRequest>(R"({"id":7,"do":"stage","camera":"front","y":0.1})").y, 0.1);
  (void)read_as_ask<HaltRequest>(R"({"id":7,"do":"halt"})");
  (void)read_as_ask<ResetRequest>(R"({"id":7,"do":"reset"})");
  EXPECT_FALSE(read_as_ask<WeightRequest>(R"({"id":7,"do":"weight","on":false})").on);
  EXPECT_FALSE(read_as_ask<RunRequest>(R"({"id":7,"do":"run"})").task);
  EXPECT_EQ(read_as_ask<RunRequest>(R"({"id":7,"do":"run","task":2})").task, 2);
  EXPECT_EQ(read_as_ask<RunRequest>(R"({"id":7,"do":"run"})").speed, 1) << "real time";
  EXPECT_EQ(read_as_ask<RunRequest>(R"({"id":7,"do":"run","speed":0.25})").speed, 0.25);
  EXPECT_EQ(read_as_ask<SpeedRequest>(R"({"id":7,"do":"speed","speed":4})").speed, 4);
  EXPECT_NE(read_request(R"({"id":7,"do":"speed","speed":-1})").error, "");
  EXPECT_NE(read_request(R"({"id":7,"do":"speed"})").error, "");
  (void)read_as_ask<CancelRequest>(R"({"id":7,"do":"cancel"})");
  (void)read_as_ask<OpenRequest>(R"({"id":7,"do":"open"})");
  (void)read_as_ask<LiveRequest>(R"({"id":7,"do":"live"})");
  EXPECT_EQ(read_as_ask<AtRequest>(R"({"id":7,"do":"at","time":2.5})").time, 2.5);
  EXPECT_EQ(read_as_ask<ExperimentRequest>(R"({"id":7,"do":"experiment","add":"view","camera":"a"})").camera,
            "a");
  EXPECT_FALSE(read_as_ask<ExperimentRequest>(R"({"id":7,"do":"experiment"})").add);
  EXPECT_EQ(read_as_ask<CheckRequest>(R"({"id":7,"do":"check","text":"seed = 1"})").text.content, "seed = 1");
  EXPECT_EQ(read_as_ask<SaveRequest>(R"({"id":7,"do":"save","text":"","name":"a.toml"})").name, "a.toml");
  EXPECT_EQ(read_as_ask<BranchRequest>(R"({"id":7,"do":"branch","time":2.5})").time, 2.5);
  const auto images =
      read_as_ask<ImagesRequest>(R"({"id":7,"do":"images","camera":"a","rate":30,"quality":60})");
  EXPECT_EQ(images.rate, 30);
  EXPECT_EQ(images.quality, 60);
  EXPECT_EQ(read_as_ask<AckRequest>(R"({"id":7,"do":"ack","camera":"a","number":9})").number, 9);
  EXPECT_EQ(read_as_ask<PixelRequest>(R"({"id":7,"do":"pixel","camera":"a","u":3,"v":4})").v, 4);
  const auto measure =
      read_as_ask<MeasureRequest>(R"({"id":7,"do":"measure","camera":"a","layers":["axis"]})");
  EXPECT_EQ(measure.layers->at(0), "axis");
  EXPECT_FALSE(read_as_ask<MeasureRequest>(R"({"id":7,"do":"measure","camera":"a"})").layers);
  EXPECT_FALSE(read_as_ask<MeasureRequest>(R"({"id":7,"do":"measure","camera":"a"})").seeing);
  EXPECT_EQ(read_as_ask<ColorRequest>(R"({"id":7,"do":"color","camera":"a","u":3,"v":4})").v, 4);
  (void)read_as_ask<ShapeRequest>(R"({"id":7,"do":"shape"})");
  EXPECT_EQ(read_as_ask<PointRequest>(R"({"id":7,"do":"point","s":0.5})").s, 0.5);
  EXPECT_TRUE(read_as_ask<BackboneRequest>(R"({"id":7,"do":"backbone","bends":[[0,1]]})").bends);
  const auto push = read_as_ask<PushRequest>(R"({"id":7,"do":"push","s":0.5,"to":[1,2,3],"stiffness":4})");
  EXPECT_EQ(push.s, 0.5);
  EXPECT_EQ(push.to->at(2), 3);
  EXPECT_EQ(push.stiffness, 4);
  EXPECT_EQ(read_as_ask<PushRequest>(R"({"id":7,"do":"push","s":0,"force":[0,-1,0]})").force->at(1), -1);
  (void)read_as_ask<ReleaseRequest>(R"({"id":7,"do":"release"})");
  (void)read_as_ask<PingRequest>(R"({"id":7,"do":"ping"})");
}

TEST(Request, SaysThatNoMoreIsExpectedWhereNothingIs) {
  EXPECT_THAT(read_request(R"({"id":7,"do":"ping","x":1})").error,
              HasSubstr("x: unknown key; no keys are expected here"));
}

TEST(Request, NeedsNoIdForAnAcknowledgement) {
  const Request ack = read_request(R"({"do":"ack","camera":"a","number":0})");
  EXPECT_EQ(ack.error, "");
  EXPECT_FALSE(ack.id);
}

TEST(Request, SaysInOneLineWhatIsWrong) {
  const std::vector<std::pair<const char*, const char*>> cases{
      {"", "JSON"},
      {"{", "JSON"},
      {"[1]", "expected a JSON object"},
      {R"({"do":"ping"})", "id is missing"},
      {R"({"id":null,"do":"ping"})", "id is missing"},
      {R"({"id":1.5,"do":"ping"})", "id = 1.5: expected a whole number"},
      {R"({"id":1e99,"do":"ping"})", "id = 1e+99: expected a whole number from -2^53 to 2^53"},
      {R"({"id":99999999999999999,"do":"ping"})", "id = 99999999999999999: expected"},
      {R"({"id":1e99,"do":"ack","camera":"a","number":0})", "id = 1e+99"},
      {R"({"id":7})", "do is missing"},
      {R"({"id":7,"do":"fly"})", "expected one of arm, tip"},
      {R"({"id":7,"do":"fly\nhigh"})", "expected one of arm, tip"},
      {R"({"id":7,"do":"ping","x":1})", "x"},
      {R"({"id":7,"do":"arm"})", "has no shape"},
      {R"({"id":7,"do":"arm","tendons":[0],"bends":[[0,0]]})", "expected only tendons"},
      {R"({"id":7,"do":"arm","bends":[[0,0,0]]})", "bends[0]"},
      {R"({"id":7,"do":"arm","bends":[[0,1e9]]})", "bends[0][1]"},
      {R"({"id":7,"do":"arm","bends":[[0,0]],"duration":-1})", "duration"},
      {R"({"id":7,"do":"tip"})", "position: missing"},
      {R"({"id":7,"do":"tip","position":[0,0,0],"direction":[0,0,0]})", "direction: is zero"},
      {R"({"id":7,"do":"head","camera":""})", "camera"},
      {R"({"id":7,"do":"images","camera":"a","rate":1,"quality":0})", "quality"},
      {R"({"id":7,"do":"pixel","camera":"a","u":-1,"v":0})", "u"},
      {R"({"id":7,"do":"measure"})", "camera: missing"},
      {R"({"id":7,"do":"measure","camera":"a","layers":["axis","edges"]})",
       "layers[1]: there is no layer \"edges\": expected one of mask, silhouette, axis, markers, circle"},
      {R"({"id":7,"do":"measure","camera":"a","layers":"axis"})", "layers"},
      {R"({"id":7,"do":"shape","camera":"a"})", "camera: unknown key"},
      {R"({"id":7,"do":"push","force":[0,0,1]})", "s: missing"},
      {R"({"id":7,"do":"push","s":0.1})", "expected one of to (end of a spring) and force"},
      {R"({"id":7,"do":"push","s":0.1,"to":[0,0,0],"force":[0,0,1]})", "expected one of to"},
      {R"({"id":7,"do":"push","s":-0.1,"force":[0,0,1]})", "s = -0.1"},
      {R"({"id":7,"do":"push","s":NaN,"force":[0,0,1]})", "JSON"},
      {R"({"id":7,"do":"push","s":0.1,"force":[0,0,1e300]})", "force[2]"},
      {R"({"id":7,"do":"push","s":0.1,"force":[0,null,1]})", "force[1]"},
      {R"({"id":7,"do":"push","s":0.1,"force":[0,1]})", "force"},
      {R"({"id":7,"do":"push","s":0.1,"to":[0,0,0],"stiffness":0})", "stiffness"},
      {R"({"id":7,"do":"push","s":0.1,"force":[0,0,1],"stiffness":5})",
       "stiffness: applies only to a spring"},
      {R"({"id":7,"do":"push","s":0.1,"force":[0,0,1],"hand":1})", "hand: unknown key"},
      {R"({"id":7,"do":"release","s":0.1})", "s: unknown key"},
      {R"({"id":7,"do":"at","time":"now"})", "time"},
      {R"({"id":7,"do":"branch"})", "time"},
      {R"({"id":7,"do":"experiment","add":"all"})", "add"},
      {R"({"id":7,"do":"experiment","add":"view"})", "camera"},
      {R"({"id":7,"do":"experiment","add":"pose","camera":"a"})", "camera"},
      {R"({"id":7,"do":"check"})", "text"},
      {R"({"id":7,"do":"save","text":"seed = 1"})", "name"},
      {R"({"id":"7","do":"ack","camera":"a","number":0})", "id = \"7\": expected a whole number"}};
  for (const auto& [text, error] : cases) {
    const Request request = read_request(text);
    EXPECT_THAT(request.error, HasSubstr(error)) << text;
    EXPECT_EQ(request.error.find('\n'), std::string::npos) << text;
  }
  EXPECT_EQ(read_request(R"({"id":7,"do":"fly"})").id, 7) << "for the reply";
}

TEST(Document, IsFoundByItsAddress) {
  const auto image = std::get<ImageAsk>(read_document("/image/front%20left.png?time=1.5"));
  EXPECT_EQ(image.camera, "front left");
  EXPECT_EQ(image.time, 1.5);
  EXPECT_FALSE(std::get<ImageAsk>(read_document("/image/front.png")).time);
  const auto series = std::get<SeriesAsk>(read_document("/series?names=tip_x,tip_y&points=20"));
  EXPECT_EQ(series.names, (std::vector<std::string>{"tip_x", "tip_y"}));
  EXPECT_EQ(series.points, 20);
  EXPECT_TRUE(std::holds_alternative<ReportAsk>(read_document("/report")));
}

TEST(Document, IsRefusedAtAnyOtherAddress) {
  for (const char* target :
       {"", "/", "/reports", "/report?x=1", "/image/front", "/image/front.png?time=nan",
        "/image/front.png?time=", "/image/front.png?time=1&time=2", "/image/front.png?size=1",
        "/image/fr%zz.png", "/series", "/series?names=", "/series?names=a,a", "/series?names=a&points=1",
        "/series?names=a&points=1e3", "/../experiment.toml", "/image/%"})
    EXPECT_THROW((void)read_document(target), ViewRefusal) << target;
}

}  // namespace
}  // namespace flexura
