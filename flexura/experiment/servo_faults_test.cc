// Servos whose devices answer with invalid numbers, late or in the wrong order.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "flexura/experiment/schedule.h"
#include "tests/support/servo_bench.h"

namespace flexura {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
const ArmState servo_goal_state = {{{0.8, 0.3}, {-0.7, 0.9}, {1.0, -0.6}}, {1, 1, 1}};

// A head whose tilt is not a number from a time on.
AlteredHead::ChangeReading lost_from(double from) {
  return [from](HeadReading reading) {
    if (reading.time >= from) reading.state.tilt = none;
    return reading;
  };
}

// A camera that sometimes answers slowly.
class SlowCamera : public CameraPort {
 public:
  SlowCamera(CameraPort& camera, ClockPort& clock, double takes, int every)
      : camera_(camera), clock_(clock), takes_(takes), every_(every) {}
  Outcome<std::optional<Frame>> newest() override {
    if (++asked_ % every_ == 0) clock_.wait_until(clock_.now() + takes_);
    return camera_.newest();
  }
  Outcome<std::optional<Frame>> wait(double timeout) override { return camera_.wait(timeout); }

 private:
  CameraPort& camera_;
  ClockPort& clock_;
  double takes_;
  int every_, asked_ = 0;
};

// An arm whose readings have an invalid time from a time on.
class TimelessArm : public ArmPort {
 public:
  TimelessArm(ArmPort& arm, ClockPort& clock, double from) : arm_(arm), clock_(clock), from_(from) {}
  CommandOutcome command(const ArmState& state, double duration) override {
    return arm_.command(state, duration);
  }
  CommandOutcome halt() override { return arm_.halt(); }
  Outcome<ArmReading> read() override {
    ArmReading reading = arm_.read().value();
    if (clock_.now() >= from_) reading.time = none;
    return reading;
  }

 private:
  ArmPort& arm_;
  ClockPort& clock_;
  double from_;
};

// A camera whose pictures have an invalid time between two times.
class TimelessCamera : public CameraPort {
 public:
  TimelessCamera(CameraPort& camera, ClockPort& clock, double from, double to)
      : camera_(camera), clock_(clock), from_(from), to_(to) {}
  Outcome<std::optional<Frame>> newest() override { return without_time(camera_.newest()); }
  Outcome<std::optional<Frame>> wait(double timeout) override { return without_time(camera_.wait(timeout)); }

 private:
  Outcome<std::optional<Frame>> without_time(Outcome<std::optional<Frame>> outcome) {
    if (clock_.now() < from_ || clock_.now() >= to_ || outcome.fault() || !outcome.value()) return outcome;
    Frame frame = *outcome.value();
    frame.time = none;
    return std::optional(frame);
  }

  CameraPort& camera_;
  ClockPort& clock_;
  double from_, to_;
};

TEST(ServoFaults, AHeadThatTellsNoNumberStopsTheArm) {
  ServoBench bench(servo_file(servo_target));
  RigPorts ports = bench.ports();
  AlteredHead lost(*ports.cameras[1].head, lost_from(0.4));
  ports.cameras[1].head = &lost;
  ServoNotes notes;
  const ServoResult result = bench.servo(ports, notes);
  EXPECT_FALSE(result.is_done);
  EXPECT_NE(result.reason.find("camera side: the readings of its head or stage are not finite"),
            std::string::npos)
      << result.reason;
  ASSERT_TRUE(result.fault);
  EXPECT_LT(result.steps.back().time, 1.5);
  bench.rig().clock().wait_until(bench.rig().clock().now() + 0.5);
  EXPECT_FALSE(bench.ports().arm->read().value().moving);
  for (const auto& [time, state] : notes.sent)
    for (const Eigen::Vector2d& bend : state.bends) EXPECT_TRUE(bend.allFinite()) << "at " << time;
  // From the start: no commands at all.
  AlteredHead never(*bench.ports().cameras[0].head, lost_from(0));
  ports = bench.ports();
  ports.cameras[0].head = &never;
  ServoNotes silent;
  EXPECT_NE(bench.servo(ports, silent)
                .reason.find("camera front: the readings of its head or stage are not finite"),
            std::string::npos);
  EXPECT_TRUE(silent.sent.empty());
}

// A step that takes too long: missed steps are not made up for.
TEST(ServoFaults, StepsThatArePassedAreLeftOut) {
  ServoBench bench(servo_file(servo_target));
  RigPorts ports = bench.ports();
  constexpr double takes = 0.11;
  SlowCamera slow(*ports.cameras[0].camera, *ports.clock, takes, 7);
  ports.cameras[0].camera = &slow;
  ServoNotes notes;
  const ServoResult result = bench.servo(ports, notes);
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_LT(bench.truth(servo_goal_state).rms, 0.006);
  const double step = 1.0 / 30;
  long missed = 0;
  for (std::size_t i = 1; i < result.steps.size(); ++i) {
    const double ticks = (result.steps[i].time - result.start) / step,
                 gone = (result.steps[i].time - result.steps[i - 1].time) / step;
    EXPECT_NEAR(ticks, std::round(ticks), 1e-6);
    // Never sooner than a step after the previous one: the limiter relies on it.
    EXPECT_GT(gone, 1 - 1e-6);
    missed += std::lround(gone) - 1;
  }
  // Three whole steps each time: 0.11 s are 3.3.
  EXPECT_EQ(result.missed_steps, missed);
  EXPECT_GE(missed, 3 * static_cast<long>(result.steps.size() / 7 - 1));
  EXPECT_LE(missed, 3 * static_cast<long>(result.steps.size() / 7 + 1));
  EXPECT_TRUE(notes.has("a control step took longer than 0.03333 s"));
  EXPECT_TRUE(notes.has(fmt::format("{} control steps of 0.03333 s were skipped", missed)));
}

// Two pictures of the target shape, in their order and swapped.
TEST(ServoFaults, PicturesInTheWrongOrderAreRefused) {
  ServoBench bench(servo_file(servo_target));
  RigBench other(
      servo_file(servo_target, {.rest = "[arm.initial]\nbends = [[0.8, 0.3], [-0.7, 0.9], [1.0, -0.6]]\n"}));
  RecordedViews views;
  for (std::size_t i = 0; i < 2; ++i) views[i] = *other.ports().cameras[i].camera->wait(1).value()->picture;
  ServoConfig config = bench.config();
  const RigModel model = bench.nominal();
  config.goals = {{0, RecordedViews{views[1], views[0]}}};
  ServoNotes notes;
  const ServoResult refused = servo_in_session(bench.ports(), model, config, notes);
  EXPECT_FALSE(refused.is_done);
  EXPECT_NE(refused.reason.find("the pictures of target 1 are in the wrong order"), std::string::npos)
      << refused.reason;
  EXPECT_TRUE(notes.sent.empty());
  config.goals = {{0, views}};
  const ServoResult result = servo_in_session(bench.ports(), model, config, notes);
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_LT(bench.truth(servo_goal_state).rms, 0.006);
}

// Pictures without a shape must give a reason.
TEST(ServoFaults, PicturesOfTwoShapesAreRefusedWithAReason) {
  ServoBench bench(servo_file(servo_target));
  RecordedViews views;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string bends = i == 0 ? "[[0, 0], [0, 0], [0, 0]]" : "[[0, 2], [0, 2], [0, 2]]";
    RigBench other(servo_file(servo_target, {.rest = "[arm.initial]\nbends = " + bends + "\n"}));
    views[i] = *other.ports().cameras[i].camera->wait(1).value()->picture;
  }
  ServoConfig config = bench.config();
  config.goals = {{0, views}};
  const RigModel model = bench.nominal();
  ServoNotes notes;
  const ServoResult result = servo_in_session(bench.ports(), model, config, notes);
  EXPECT_FALSE(result.is_done);
  const std::string begins = "the pictures of target 1 show no shape: ";
  EXPECT_TRUE(result.reason.starts_with(begins)) << result.reason;
  EXPECT_GT(result.reason.size(), begins.size());
  EXPECT_TRUE(notes.sent.empty());
}

const std::string colored = "read_noise = 1, delay = 0.06, exposure = 0.002, pixels = \"color\"";

std::string bands(const std::string& table, const std::string& colors) {
  return "[" + table + "]\nbands = { per_section = 3, width = 0.03, colors = [" + colors + "] }\n";
}

TEST(ServoFaults, BandsCountAndOneThatIsLostDoesNoHarm) {
  const std::array<std::string, 3> colors = {"[0.85, 0.1, 0.1]", "[0.1, 0.6, 0.15]", "[0.1, 0.2, 0.85]"};
  const std::string dark = "[0.08, 0.08, 0.09]";
  std::string all, but_one;
  for (std::size_t i = 0; i < 9; ++i) {
    const std::string& color = colors[i % 3];
    all += (i > 0 ? ", " : "") + color;
    but_one += (i > 0 ? ", " : "") + (i == 4 ? dark : color);  // Of the arm's own colour.
  }
  for (const bool is_one_lost : {false, true}) {
    const std::string rest = bands("arm.look", all) + (is_one_lost ? bands("truth.arm.look", but_one) : "");
    ServoBench bench(servo_file("law = \"points\"\n" + servo_target, {.sensor = colored, .rest = rest}));
    EXPECT_EQ(bench.config().markers.size(), 9u);
    class BandNotes : public ServoNotes {
     public:
      std::vector<double> middles;
      std::set<std::size_t> gone_by;  // Numbers of the bands that shapes were fitted to.
      void seen(const ServoObservation& observed) override {
        const auto distance = [](double s) { return [s](double middle) { return std::abs(middle - s); }; };
        for (const PlacedMarker& marker : observed.estimate.markers)
          gone_by.insert(static_cast<std::size_t>(std::ranges::min_element(middles, {}, distance(marker.s)) -
                                                  middles.begin()));
      }
    } notes;
    notes.middles = bench.config().markers;
    const ServoResult result = bench.servo(bench.ports(), notes);
    ASSERT_TRUE(result.is_done) << result.reason;
    std::printf("%zu bands were gone by, %.4f %% of the length left\n", notes.gone_by.size(),
                100 * bench.truth(servo_goal_state).rms);
    EXPECT_LT(bench.truth(servo_goal_state).rms, 0.006);
    EXPECT_LT(*result.settled, 2);
    // The missing band must not be confused with another one.
    EXPECT_EQ(notes.gone_by.contains(4), !is_one_lost);
    EXPECT_GE(notes.gone_by.size(), 6u);
  }
}

// Expects the true arm at its last target.
void expect_arrival(const std::string& file) {
  ServoBench bench(file);
  const ServoResult result = bench.servo();
  EXPECT_TRUE(result.is_done) << result.reason;
  EXPECT_LT(bench.truth(std::get<ArmState>(bench.config().goals.back().shape)).rms, 0.006);
}

// The target moves on at once, the arm at its sections' rates: it is left behind, and follows later.
TEST(ServoFaults, AnArmThatIsLeftBehindByItsTargetIsNotDiverging) {
  ServoSetup slow;
  slow.arm = "max_bend_deg = 120\nmax_bend_rate_deg = 30";
  expect_arrival(
      servo_file("timeout = 15\n[[task.target]]\ntime = 3\nbends = [[0.8, 0.3], [-0.7, 0.9], [1.0, -0.6]]\n"
                 "[[task.target]]\ntime = 3.1\nbends = [[-0.8, -0.3], [0.7, -0.9], [-1.0, 0.6]]\n",
                 slow));
}

// The motion in the check before the run is as slow as the arm.
TEST(ServoFaults, SlowSectionsAreNotUnsafe) {
  ServoSetup rig;
  rig.arm = "max_bend_deg = 120\nmax_bend_rate_deg = 5";
  ServoBench bench(servo_file(servo_target, rig));
  const Arm arm = bench.experiment().arm.arm();
  const MotionPtr motion = Schedule(bench.experiment()).legs().front().motion;
  constexpr double step = 0.01;
  for (double time = 0; time < motion->duration(); time += step)
    for (std::size_t i = 0; i < 3; ++i)
      ASSERT_LE((motion->at(time + step).bends[i] - motion->at(time).bends[i]).norm(),
                step * arm.sections[i].max_bend_rate);
}

// Between two pictures of a slow camera the arm does not count as unobserved.
TEST(ServoFaults, SettlesByCamerasThatAreSlowerThanItsSteps) {
  std::string file = servo_file("step = 0.05\ntimeout = 20\n" + servo_target);
  for (std::size_t at = 0; (at = file.find("frame_rate = 30", at)) != std::string::npos; ++at)
    file.replace(at, 15, "frame_rate = 2");
  expect_arrival(file);
}

// Exposures of 2 and 30 ms: the pictures' middles are 14 ms apart, more than half a step.
TEST(ServoFaults, PairsPicturesByTheCamerasPeriodAndNotByItsStep) {
  std::string file = servo_file("step = 0.02\n" + servo_target);
  file.replace(file.rfind("exposure = 0.002"), 16, "exposure = 0.030");
  expect_arrival(file);
}

TEST(ServoFaults, ArrivesWhereFramesAreDropped) {
  ServoSetup rig;
  rig.sensor = "read_noise = 1, delay = 0.06, exposure = 0.002, drop = 0.4";
  expect_arrival(servo_file(servo_target, rig));
}

// A full log throws at every step from then on.
TEST(ServoFaults, AWatcherThatFailsLeavesTheArmAtRestAndIsTheReason) {
  class Failing : public ServoNotes {
   public:
    int failures = 0;
    void stepped(const ServoStep& step) override {
      if (step.time < 0.5) return;
      throw std::runtime_error(++failures == 1 ? "cannot write the log: no space" : "the log is closed");
    }
    void reported(double, const std::string&) override {
      if (failures > 0) throw std::runtime_error("the log is closed");
    }
  };
  ServoBench bench(servo_file(servo_target));
  Failing notes;
  try {
    (void)bench.servo(bench.ports(), notes);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "cannot write the log: no space");
  }
  const auto bends = [&] { return bench.ports().arm->read().value().state.bends; };
  bench.rig().clock().wait_until(bench.rig().clock().now() + 0.5);
  const auto before = bends();
  bench.rig().clock().wait_until(bench.rig().clock().now() + 1);
  EXPECT_EQ(bends(), before);
}

TEST(ServoFaults, AnArmThatTellsNoTimeIsStopped) {
  ServoBench bench(servo_file(servo_target));
  RigPorts ports = bench.ports();
  TimelessArm timeless(*ports.arm, *ports.clock, 0.4);
  ports.arm = &timeless;
  ServoNotes notes;
  const ServoResult result = bench.servo(ports, notes);
  EXPECT_FALSE(result.is_done);
  EXPECT_NE(result.reason.find("the arm's timestamp is not finite"), std::string::npos) << result.reason;
  ASSERT_TRUE(result.fault);
  bench.rig().clock().wait_until(bench.rig().clock().now() + 0.5);
  EXPECT_FALSE(bench.ports().arm->read().value().moving);
}

TEST(ServoFaults, PicturesOfNoTimeAreNoPictures) {
  ServoBench bench(servo_file(servo_target));
  RigPorts ports = bench.ports();
  TimelessCamera timeless(*ports.cameras[1].camera, *ports.clock, 0.3, 1.3);
  ports.cameras[1].camera = &timeless;
  ServoNotes notes;
  const ServoResult result = bench.servo(ports, notes);
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_TRUE(notes.has("camera side: its picture's timestamp is not finite"));
  EXPECT_TRUE(notes.has("the arm is visible again"));
  EXPECT_LT(bench.truth(servo_goal_state).rms, 0.006);
  for (const ServoStep& step : result.steps) {
    if (!step.seen_at) continue;
    EXPECT_TRUE(std::isfinite(*step.seen_at));
    EXPECT_TRUE(std::isfinite(step.error->rms));
  }
}

}  // namespace
}  // namespace flexura
