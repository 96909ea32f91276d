// The true arm, as recordings show it beside the commanded one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "flexura/base/source.h"
#include "flexura/experiment/run.h"
#include "flexura/log/recorder.h"
#include "flexura/log/results.h"
#include "flexura/servo/servo_step.h"
#include "flexura/store/text_file.h"
#include "flexura/tasks/servo/servo_messages.h"
#include "flexura/view/live_rig.h"
#include "flexura/view/recording_session.h"
#include "flexura/view/truth_extras.h"
#include "tests/support/quiet.h"
#include "tests/support/rod_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/watched_views.h"

namespace flexura {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const ArmState bent{{{0.8, 0.5}, {-0.4, 0.7}}, {1, 1}};

class TruthView : public ::testing::Test {
 protected:
  void record(const std::string& text) {
    Quiet quiet;
    const Experiment experiment = parse_experiment(text, "x.toml");
    ASSERT_EQ(run_experiment(experiment, folder_.path(), quiet).outcome, RunOutcome::done);
    open();
  }
  void open() {
    session_.emplace(std::make_shared<const Recording>(folder_.path()), messenger_, background_);
    session_->opened(me);
  }
  // Returns the extras at a time.
  Node extras_at(double time) {
    session_->take(me, AtRequest{time}, [](const ViewAnswer& answer) { EXPECT_EQ(answer.error, ""); });
    return extras_in(*messenger_.posts[{me, extras_stream}].back());
  }
  static std::vector<std::string> ghosts_in(const Node& extras) {
    std::vector<std::string> ids;
    for (const Node& ghost : *extras.find("ghosts")->as<Node::Array>())
      ids.push_back(*ghost.find("id")->as<std::string>());
    return ids;
  }
  static Eigen::Vector3d tip_of_last(const Node& extras) {
    const Node& ghost = extras.find("ghosts")->as<Node::Array>()->back();
    const Node::Array& pose = *ghost.find("poses")->as<Node::Array>()->back().as<Node::Array>();
    return {*pose[0].as<double>(), *pose[1].as<double>(), *pose[2].as<double>()};
  }
  Eigen::Vector3d shown_tip() { return messenger_.state(me).samples.back().X_WS.position; }

  TemporaryFolder folder_;
  FakeMessenger messenger_;
  FakeBackground background_;
  std::optional<RecordingSession> session_;
};

const std::string filmed = "[record]\ncameras = true\nreport = false\n";

TEST_F(TruthView, ShowsARodBesideTheCommandedArcs) {
  record(viewed_rod() + filmed + "[[task]]\nkind = \"hold\"\nduration = 0.5\n");
  const Node end = extras_at(1.5);
  ASSERT_THAT(ghosts_in(end), ElementsAre("truth"));
  const Node& ghost = end.find("ghosts")->as<Node::Array>()->front();
  EXPECT_EQ(*ghost.find("label")->as<std::string>(), "True");
  EXPECT_EQ(*ghost.find("color")->as<std::string>(), true_arm.color);
  EXPECT_EQ(ghost.find("poses")->as<Node::Array>()->size(), 49U);
  EXPECT_EQ(*end.find("title")->as<std::string>(), "Truth");
  EXPECT_THAT(*end.find("text")->as<std::string>(), HasSubstr("distance from the commanded shape"));
  LiveRig live(viewed_rig(viewed_rod()), 0);
  const Eigen::Vector3d rod = live.at_rest(bent).tip().position;
  EXPECT_LT((tip_of_last(end) - rod).norm(), 1e-4);
  EXPECT_GT((tip_of_last(end) - shown_tip()).norm(), 3e-3);
}

// Slow enough for its rates.
TEST_F(TruthView, ShowsNoTruthOfAnArmThatIsAsItIsBelievedToBe) {
  std::string text = viewed_text + filmed;
  text.replace(text.find("duration = 1"), 12, "duration = 3");
  record(text);
  for (const double time : {0.0, 0.5, 1.51, 2.2, 3.0})
    EXPECT_THAT(ghosts_in(extras_at(time)), IsEmpty()) << time;
}

TEST_F(TruthView, SaysNothingOfARunThatKnowsNoTruth) {
  record(viewed_text);
  EXPECT_EQ(messenger_.count(me, extras_stream), 0U);
}

// Tensions, energies and contacts, as logged by the run.
TEST_F(TruthView, ShowsTheForcesOfAnArmInMotion) {
  record(R"(
[arm]
kind = "spatial"
model = "dynamic"
gravity = [0, 0, 0]
[[arm.section]]
length = 0.3
radius = [0.02, 0.012]
max_bend_deg = 300
max_bend_rate_deg = 500
material = { youngs_modulus = 1e6, poisson = 0.49, density = 1070, damping_time = 0.05 }
[[arm.tendon]]
section = 1
radius_mm = 10
[arm.contact]
spacing_mm = 20
[[obstacle]]
kind = "capsule"
name = "post"
from = [0.07, 0.2, -0.3]
to = [0.07, 0.2, 0.3]
radius = 0.03
may_touch = true
[[camera]]
name = "front"
mount = { position = [0, 0.5, 2], look_at = [0, 0.5, 0] }
[[task]]
kind = "move"
duration = 0.6
to.bends_deg = [[150, 0]]
[[task]]
kind = "hold"
duration = 0.4
[record]
cameras = false
report = false
)");
  const auto state_at = [&](double time) {
    session_->take(me, AtRequest{time}, [](const ViewAnswer& answer) { EXPECT_EQ(answer.error, ""); });
    return messenger_.state(me);
  };
  const StateMessage start = state_at(0), end = state_at(1);
  EXPECT_TRUE(start.contacts.empty());
  EXPECT_EQ(start.energy.value().kinetic, 0);
  EXPECT_GT(state_at(0.3).energy.value().kinetic, 1e-6);
  EXPECT_GT(end.energy.value().strain, 1e-3);
  ASSERT_FALSE(end.contacts.empty());
  EXPECT_EQ(end.contacts.front().obstacle, 0);
  EXPECT_GT(end.contacts.front().normal_force, 0);
  EXPECT_NE(end.contacts.front().slip, ContactSample::Slip::unknown);
  ASSERT_EQ(end.actuators.size(), 1U);
  EXPECT_GT(end.actuators[0].force, 0.01);
  EXPECT_FALSE(end.push);
  std::string names;
  for (const Quantity& quantity : session_->hello().quantities) names += quantity.name + " ";
  EXPECT_THAT(names, HasSubstr("energy_kinetic energy_elastic energy_gravity energy_total tension_1 "
                               "contact_force "));
  std::string series;
  session_->take(SeriesAsk{{"energy_total", "tension_1", "contact_force"}, 50},
                 [&](const HttpAnswer& answer) { series = answer.body; });
  EXPECT_THAT(series, HasSubstr("\"contact_force\":[0"));
  EXPECT_EQ(series.find("null"), std::string::npos);
  EXPECT_THROW(session_->take(me, PushRequest{}, [](const ViewAnswer&) {}), ViewRefusal);
}

// A log of states, each bent further by 0.1 rad, and of additional messages.
class WrittenTruth : public TruthView {
 protected:
  void write(const std::function<void(Recorder&)>& more) {
    const std::string text = viewed_rod();
    write_new_file(folder_.path() / experiment_file_name, text);
    const Arm arm = parse_experiment(text, "x.toml").arm.arm();
    Recorder recorder(folder_.path() / log_file_name, arm);
    for (int i = 0; i < 5; ++i) recorder.state(i, turned(0.1 * i), Backbone(arm, turned(0.1 * i)));
    more(recorder);
    recorder.close();
    open();
  }
  static ArmState turned(double bend) { return {{{bend, 0}, {bend, 0}}, {1, 1}}; }
  static Backbone lain(double bend) {
    return Backbone(parse_experiment(viewed_rod(), "x.toml").arm.arm(), turned(bend));
  }
};

TEST_F(WrittenTruth, LiesBetweenTheTimesOfTheLog) {
  write([](Recorder& recorder) {
    recorder.truth(0.8, lain(0.1));
    recorder.truth(1.2, lain(0.2));
    recorder.truth(2, lain(0.2));
    recorder.truth(3 + 1e-9, lain(0.31));
  });
  EXPECT_THAT(ghosts_in(extras_at(0)), IsEmpty()) << "none yet";
  ASSERT_THAT(ghosts_in(extras_at(1)), ElementsAre("truth"));
  EXPECT_LT((tip_of_last(extras_at(1)) - lain(0.15).tip().position).norm(), 2e-3) << "half way";
  EXPECT_THAT(ghosts_in(extras_at(2)), IsEmpty()) << "as it was commanded";
  ASSERT_THAT(ghosts_in(extras_at(3)), ElementsAre("truth"));
  EXPECT_LT((tip_of_last(extras_at(3)) - lain(0.31).tip().position).norm(), 1e-9) << "of that time";
  EXPECT_THAT(ghosts_in(extras_at(4)), IsEmpty()) << "none any more";
}

TEST_F(WrittenTruth, IsNotDrawnWhereItIsDamaged) {
  PosesMessage alone;
  alone.poses.resize(1);
  write([&](Recorder& recorder) {
    recorder.truth(1, lain(0.3));
    recorder.write({arm_truth_topic, 2, alone});
    recorder.truth(3, lain(0.1));
  });
  EXPECT_THAT(ghosts_in(extras_at(1)), ElementsAre("truth"));
  EXPECT_THAT(ghosts_in(extras_at(2)), IsEmpty());
  EXPECT_THAT(ghosts_in(extras_at(3)), ElementsAre("truth"));
}

// The logged truth has a bend for each arc of the rod.
TEST_F(WrittenTruth, StandsBesideWhatAServoDrawsOfARod) {
  ServoStep step;
  step.time = 1, step.desired = step.seen.emplace(turned(0.2)), step.lengths = {0.5, 0.5};
  TrueShape& truth = step.truth.emplace();
  truth.bends.assign(48, {0.01, 0}), truth.lengths.assign(48, 1.0 / 48), truth.error.rms = 0.01;
  write([&](Recorder& recorder) {
    recorder.write({servo_steps_topic, 1, step});
    recorder.truth(1, lain(0.3));
  });
  const Node extras = extras_at(1);
  EXPECT_THAT(ghosts_in(extras), ElementsAre("target", "seen", "truth"));
  EXPECT_EQ(*extras.find("title")->as<std::string>(), "Servo");
  EXPECT_LT((tip_of_last(extras) - lain(0.3).tip().position).norm(), 1e-9);
  EXPECT_EQ(extras.find("along")->find("curves")->as<Node::Array>()->size(), 1U) << "of what is seen";
  EXPECT_EQ(*extras.find("values")->find("servo_true_rms")->as<double>(), 1);
}

PosesMessage poses_of(const Backbone& backbone) {
  PosesMessage message;
  const auto add = [&](const Pose& pose) {
    const Eigen::Vector4d q = quaternion_wxyz(pose.rotation);
    const Eigen::Vector3d& p = pose.position;
    message.poses.push_back({{p.x(), p.y(), p.z()}, {q[1], q[2], q[3], q[0]}});
  };
  for (const Arc& arc : backbone.arcs()) add(arc.X_WS);
  add(backbone.tip());
  return message;
}

// Also for arcs of more than half a turn.
TEST(TrueArm, LiesAsTheArcsBetweenItsPoses) {
  Arm arm;
  arm.sections.resize(3);
  const Backbone backbone(arm, {{{0.3, -4}, {0, 0}, {1.2, 3}}, {1, 1, 1}});
  const std::vector<ArmSample> is = samples_of(logged_arm(poses_of(backbone))), shall = arm_samples(backbone);
  ASSERT_EQ(is.size(), shall.size());
  for (std::size_t i = 0; i < is.size(); ++i) {
    EXPECT_NEAR(is[i].s, shall[i].s, 1e-9);
    EXPECT_LT((is[i].X_WS.position - shall[i].X_WS.position).norm(), 1e-9);
    EXPECT_LT((is[i].X_WS.rotation - shall[i].X_WS.rotation).norm(), 1e-9);
  }
  Extras extras;
  add_true_arm(is, backbone, extras);
  EXPECT_TRUE(extras.ghosts.empty());
}

TEST(TrueArm, IsAddedWhereItIsOffByATenthOfAMillimetre) {
  Arm arm;
  arm.sections.resize(2);
  const Backbone commanded(arm, bent);
  for (const double off : {0.5e-4, 1.5e-4}) {
    Arm moved = arm;
    moved.X_WB.position.x() += off;
    Extras extras;
    add_true_arm(samples_of(logged_arm(poses_of(Backbone(moved, bent)))), commanded, extras);
    EXPECT_EQ(extras.ghosts.size(), off > 1e-4 ? 1U : 0U);
  }
}

TEST(TrueArm, IsNoneThatALogCannotMean) {
  Arm arm;
  arm.sections.resize(2);
  const PosesMessage good = poses_of(Backbone(arm, bent));
  const auto refuses = [&](const auto& damage) {
    PosesMessage bad = good;
    damage(bad.poses);
    EXPECT_THROW((void)samples_of(logged_arm(bad)), InputError);
  };
  (void)samples_of(logged_arm(good));
  refuses([](auto& poses) { poses.resize(1); });
  refuses([](auto& poses) { poses.clear(); });
  refuses([](auto& poses) { poses[1] = poses[0]; });
  refuses([](auto& poses) { poses[1].position.x = std::numeric_limits<double>::quiet_NaN(); });
  refuses([](auto& poses) { poses[2].position.y = 1e300; });
  refuses([](auto& poses) { poses[0].orientation.w = 2; });
  refuses([](auto& poses) { poses[1].orientation = {0, 0, 0, 0}; });
}

}  // namespace
}  // namespace flexura
