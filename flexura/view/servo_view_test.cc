#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "flexura/experiment/run.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/log/results.h"
#include "flexura/servo/servo_session.h"
#include "flexura/store/text_file.h"
#include "flexura/tasks/servo/servo_messages.h"
#include "flexura/view/live_session.h"
#include "flexura/view/recording_session.h"
#include "flexura/view/servo_extras.h"
#include "tests/support/live_sessions.h"
#include "tests/support/quiet.h"
#include "tests/support/random_cases.h"
#include "tests/support/servo_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/view_fakes.h"
#include "tests/support/watched_views.h"

namespace flexura {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A servo with logged images on a true arm that is slightly longer than the model, followed by a rest.
std::string filmed_servo() {
  ServoSetup setup;
  setup.rest =
      "[record]\ncameras = true\nreport = false\n"
      "[[truth.arm.section]]\nlength = 0.352\n[[truth.arm.section]]\nlength = 0.35\n"
      "[[truth.arm.section]]\nlength = 0.3\n";
  return servo_file("name = \"bow\"\n" + servo_target + "[[task]]\nkind = \"hold\"\nduration = 1\n", setup);
}

const ArmState desired_shape = {{{0.8, 0.3}, {-0.7, 0.9}, {1.0, -0.6}}, {1, 1, 1}};

const Node::Array& list_in(const Node& node, const char* key) { return *node.find(key)->as<Node::Array>(); }

double number_in(const Node& node, const char* key) { return *node.find(key)->as<double>(); }

std::vector<std::string> ids_of(const Node::Array& list) {
  std::vector<std::string> ids;
  for (const Node& node : list) ids.push_back(*node.find("id")->as<std::string>());
  return ids;
}

// Returns the root mean square of a curve along the arm, mm.
double rms_of(const Node& curve) {
  const Node::Array& values = list_in(curve, "values");
  double squares = 0;
  for (const Node& value : values) squares += *value.as<double>() * *value.as<double>();
  return std::sqrt(squares / static_cast<double>(values.size()));
}

Eigen::Vector3d tip_of(const Node& ghost) {
  const Node::Array& pose = *list_in(ghost, "poses").back().as<Node::Array>();
  return {*pose[0].as<double>(), *pose[1].as<double>(), *pose[2].as<double>()};
}

// Lets a session look at a run in progress, on the run's own thread.
class SeenRun : public RunLink {
 public:
  std::function<void()> look = [] {};
  void state(double time, const ArmState& state, std::span<const CameraReading> cameras) override {
    RunLink::state(time, state, cameras);
    look();
  }
};

// One watched run with its recording, shared by all tests.
class ServoView : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { seen = watched_view<SeenRun>(filmed_servo()); }
  static void TearDownTestSuite() { seen.reset(); }

  static std::vector<Node> live_extras() {
    std::vector<Node> list;
    for (const auto& message : seen->live.posts[{me, extras_stream}]) list.push_back(extras_in(*message));
    return list;
  }
  // Returns the extras of the recording at a time.
  static Node extras_at(RecordingSession& session, FakeMessenger& messenger, double time) {
    session.take(me, AtRequest{time}, [](const ViewAnswer&) {});
    return extras_in(*messenger.posts[{me, extras_stream}].back());
  }

  static inline std::unique_ptr<WatchedView> seen;
};

TEST_F(ServoView, ShowsWantedSeenAndTrueShapesWhileARunGoesOn) {
  const std::vector<Node> all = live_extras();
  ASSERT_GT(all.size(), 10);
  const Node& extras = all[all.size() / 2];
  const Node::Array& ghosts = list_in(extras, "ghosts");
  ASSERT_THAT(ids_of(ghosts), ElementsAre("target", "seen", "truth"));
  const ViewedRig& rig = *seen->rig;
  EXPECT_LT((tip_of(ghosts[0]) - tip_pose(rig.model.driven(), desired_shape).position).norm(), 1e-9);
  const double off = (tip_of(ghosts[2]) - tip_of(ghosts[0])).norm();
  EXPECT_NEAR(off, number_in(*extras.find("values"), "servo_true_tip") / 100 * rig.model.driven().length(),
              1e-9);
  const Node::Array& overlays = list_in(extras, "overlays");
  ASSERT_EQ(overlays.size(), 2);
  for (const Node& overlay : overlays) {
    EXPECT_THAT(ids_of(list_in(overlay, "layers")), ElementsAre("seen", "target"));
    for (const Node& line : list_in(overlay, "layers")) EXPECT_GT(list_in(line, "points").size(), 20);
  }
  EXPECT_TRUE(list_in(all.back(), "ghosts").empty()) << "with the servo its shapes are gone";
}

// The servo computes its errors from the shapes; the extras compute them from the log.
TEST_F(ServoView, TellsErrorsAlongTheArmAsTheServoKnowsThem) {
  double first = 0, last = 0;
  int compared = 0;
  for (const Node& extras : live_extras()) {
    const Node* along = extras.find("along");
    if (along == nullptr) continue;
    const double millimetres = 10 * seen->rig->model.driven().length();  // Of a percent of the length.
    const Node::Array& curves = list_in(*along, "curves");
    ASSERT_THAT(ids_of(curves), ElementsAre("seen", "truth"));
    last = rms_of(curves[0]);
    if (compared++ == 0) first = last;
    EXPECT_NEAR(last, millimetres * number_in(*extras.find("values"), "servo_rms"), 1e-6);
    EXPECT_NEAR(rms_of(curves[1]), millimetres * number_in(*extras.find("values"), "servo_true_rms"), 1e-6);
  }
  EXPECT_GT(compared, 10);
  EXPECT_LT(last, 0.1 * first);
}

TEST_F(ServoView, TellsHowItGoesAndHowItEnds) {
  std::vector<std::string> events;
  std::set<std::string> progress;
  for (const std::string& text : seen->live.texts[me]) {
    const Node node = parse_json(text, "text");
    const std::string& type = *node.find("type")->as<std::string>();
    if (type == "event") events.push_back(*node.find("text")->as<std::string>());
    if (type == "progress" && node.find("what") != nullptr)
      progress.insert(*node.find("what")->as<std::string>());
  }
  EXPECT_THAT(events, ElementsAre("servo starts", "there", "hold starts", "done"));
  EXPECT_GT(progress.size(), 5) << "how far it is off";
  EXPECT_THAT(progress, ::testing::Contains(HasSubstr("bow: error 0.")));
}

TEST_F(ServoView, IsInTheRecordingUponItsPictures) {
  FakeMessenger messenger;
  FakeBackground background;
  RecordingSession session(std::make_shared<const Recording>(seen->folder.path()), messenger, background);
  session.opened(me);
  for (const char* camera : {"front", "side"})
    session.take(me, ImagesRequest{camera, 30, 80}, [](const ViewAnswer&) {});
  const Node extras = extras_at(session, messenger, 0.5);
  EXPECT_THAT(ids_of(list_in(extras, "ghosts")), ElementsAre("target", "seen", "truth"));
  session.advance(1);
  const Node::Array& overlays = list_in(extras, "overlays");
  ASSERT_EQ(overlays.size(), 2);
  for (std::uint32_t i = 0; i < 2; ++i) {
    const std::string image = *messenger.posts[{me, i + 1}].back();
    EXPECT_EQ(*overlays[i].find("number")->as<std::int64_t>(), static_cast<unsigned char>(image[4]));
    EXPECT_EQ(list_in(overlays[i], "layers").size(), 2);
  }
  const double end = session.hello().duration;
  EXPECT_THAT(ids_of(list_in(extras_at(session, messenger, end), "ghosts")), ElementsAre("truth"))
      << "at rest nothing is wanted";
  EXPECT_THAT(ids_of(list_in(extras_at(session, messenger, end - 1.05), "ghosts")), Contains("target"))
      << "to its last command";
}

TEST_F(ServoView, IsAQuantityOfTheRecording) {
  FakeMessenger messenger;
  FakeBackground background;
  RecordingSession session(std::make_shared<const Recording>(seen->folder.path()), messenger, background);
  const auto quantities = session.hello().quantities;
  ASSERT_EQ(quantities.back().name, "servo_true_tip");
  EXPECT_EQ(quantities.back().group, "servo_error");
  HttpAnswer got;
  session.take(SeriesAsk{{"servo_rms", "tip_x"}, 1000}, [&](const HttpAnswer& answer) { got = answer; });
  ASSERT_EQ(got.status, 200) << got.body;
  const Node series = parse_json(got.body, "series");
  const auto &times = list_in(series, "time"), &rms = list_in(series, "servo_rms");
  ASSERT_EQ(rms.size(), times.size());
  const double servo_end = *times.back().as<double>() - 1;
  std::vector<double> values;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const bool is_steered = *times[i].as<double>() <= servo_end;
    if (!rms[i].empty()) values.push_back(*rms[i].as<double>());
    if (*times[i].as<double>() > servo_end + 0.15) {
      EXPECT_TRUE(rms[i].empty()) << *times[i].as<double>();
    }
    if (is_steered && *times[i].as<double>() > 0.2) {
      EXPECT_FALSE(rms[i].empty()) << *times[i].as<double>();
    }
  }
  ASSERT_GT(values.size(), 5);
  EXPECT_LT(values.back(), 0.5);
  EXPECT_GT(values.front(), 5);
}

TEST_F(ServoView, WritesTheSameBytesWhenItIsWatched) {
  const TemporaryFolder unwatched;
  Quiet quiet;
  (void)run_experiment(seen->rig->experiment, unwatched.path(), quiet);
  for (const char* name : {log_file_name, summary_file_name})
    EXPECT_TRUE(read_text_file(unwatched.path() / name, std::size_t{1} << 30) ==
                read_text_file(seen->folder.path() / name, std::size_t{1} << 30))
        << name;
}

// A servo that ends early leaves its reason, and a recording to view.
class HurriedServo : public LiveSessionTest {
 protected:
  HurriedServo()
      : LiveSessionTest(
            servo_file("name = \"hurry\"\ntolerance = 1e-5\nsettle = 0.2\ntimeout = 0.5\n" + servo_target)) {}
};

TEST_F(HurriedServo, SaysWhyItEndedAndLeavesARecording) {
  EXPECT_EQ(ask(RunRequest{.task = {}, .speed = 0}).error, "");
  pass(0.1);
  const Node end = messenger_.last(me, "progress");
  EXPECT_EQ(*end.find("outcome")->as<std::string>(), "failed");
  EXPECT_THAT(*end.find("text")->as<std::string>(), HasSubstr("hurry: not settled"));
  EXPECT_TRUE(*end.find("recording")->as<bool>());
  EXPECT_THAT(messenger_.texts[me],
              ::testing::Contains(AllOf(HasSubstr(R"("type":"event")"), HasSubstr("not settled"))));
  EXPECT_TRUE(session_.results());
}

ServoStep random_step(TestRandom& random, ArmState& desired, ArmState& seen, Arm& arm) {
  ServoStep step;
  const auto fill = [&](ArmState& state) {
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      const Eigen::Vector2d bend = random.vector<2>(-1, 1);
      state.bends.push_back(bend), state.stretches.push_back(random.uniform(0.9, 1.1));
    }
  };
  for (Section& section : arm.sections) step.lengths.push_back(section.length = random.uniform(0.2, 0.4));
  fill(desired), fill(seen);
  step.desired = desired, step.seen = seen;
  return step;
}

TEST(ServoExtras, MeasureDistancesAsServosDo) {
  const ViewedRigPtr rig = viewed_rig(servo_file(servo_target));
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE("seed " + std::to_string(case_seed(i)));
    TestRandom random(case_seed(i));
    Arm arm = rig->model.driven();
    ArmState desired, seen;
    const Extras extras = servo_extras(*rig, {random_step(random, desired, seen, arm), {}});
    const ServoError error = servo_error(arm, seen, desired);
    const std::vector<double>& along = extras.along.front().values;
    double squares = 0;
    for (const double value : along) squares += value * value / static_cast<double>(along.size());
    EXPECT_NEAR(std::sqrt(squares), 1000 * error.rms * arm.length(), 1e-9);
    EXPECT_NEAR(along.back(), 1000 * error.tip * arm.length(), 1e-9);
    EXPECT_EQ(along.front(), 0);
    const Eigen::Vector3d tip = extras.ghosts[1].samples.back().X_WS.position;
    EXPECT_LT((tip - tip_pose(arm, seen).position).norm(), 1e-12);
  }
}

TEST(ServoExtras, DrawWhatTheLawComparesWithLinesBetween) {
  const ViewedRigPtr rig = viewed_rig(servo_file(servo_target));
  TestRandom random(case_seed(0));
  Arm arm = rig->model.driven();
  ArmState desired, seen;
  ServoObservationMessage observation;
  observation.camera = "front";
  observation.features.emplace();
  observation.features->push_back({{{1, 2}}, {{3, 4}}});
  observation.features->push_back({{{5, 6}, {7, 8}}, {{5, 8}, {7, 6}}});
  const Extras extras = servo_extras(*rig, {random_step(random, desired, seen, arm), {{observation, 1}}});
  std::string drawn;
  for (const Node& layer : extras.overlays.at(0).layers) drawn += write_json(layer) + "\n";
  const std::string id = R"({"id":"features","label":"Features","kind":)";
  EXPECT_EQ(drawn,
            id + R"("lines","color":"#da77f2","lines":[[[1.0,2.0],[3.0,4.0]]],"dashed":false})" + "\n" + id +
                R"("points","color":"#22b8cf","of":"seen","points":[[1.0,2.0]]})" + "\n" + id +
                R"("lines","color":"#22b8cf","of":"seen","lines":[[[5.0,6.0],[7.0,8.0]]],"dashed":false})" +
                "\n" + id + R"("points","color":"#ff922b","of":"target","points":[[3.0,4.0]]})" + "\n" + id +
                R"("lines","color":"#ff922b","of":"target","lines":[[[5.0,8.0],[7.0,6.0]]],"dashed":true})" +
                "\n");
}

TEST(ServoExtras, RefuseShapesOfAnotherArm) {
  const ViewedRigPtr rig = viewed_rig(servo_file(servo_target));
  TestRandom random(case_seed(0));
  Arm arm = rig->model.driven();
  ArmState desired, seen;
  const ServoStep good = random_step(random, desired, seen, arm);
  const auto refuses = [&](const std::function<void(ServoStep&)>& damage) {
    ServoStep step = good;
    damage(step);
    EXPECT_THROW((void)servo_extras(*rig, {step, {}}), InputError);
  };
  (void)servo_extras(*rig, {good, {}});
  refuses([](ServoStep& step) { step.desired.bends.pop_back(); });
  refuses([](ServoStep& step) { step.seen->bends.front().x() = 1e300; });
  refuses([](ServoStep& step) { step.lengths.front() = 0; });
  refuses([](ServoStep& step) { step.lengths.pop_back(); });
  refuses([](ServoStep& step) { step.desired.stretches.front() = -1; });
}

}  // namespace
}  // namespace flexura
