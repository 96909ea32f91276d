// Servos whose devices' clocks stand still, go back or run ahead.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/servo_bench.h"

namespace flexura {
namespace {

using Told = std::function<double(double now)>;

// An arm whose clock says from 0.4 s on what `told` makes of the time.
class OddClockArm : public ArmPort {
 public:
  OddClockArm(ArmPort& arm, Told told) : arm_(arm), told_(std::move(told)) {}
  CommandOutcome command(const ArmState& state, double duration) override {
    return arm_.command(state, duration);
  }
  CommandOutcome halt() override { return arm_.halt(); }
  Outcome<ArmReading> read() override {
    ArmReading reading = arm_.read().value();
    if (reading.time >= 0.4) reading.time = told_(reading.time);
    return reading;
  }

 private:
  ArmPort& arm_;
  Told told_;
};

class OddClockHead : public HeadPort {
 public:
  OddClockHead(HeadPort& head, Told told) : head_(head), told_(std::move(told)) {}
  CommandOutcome command(const HeadState& state) override { return head_.command(state); }
  CommandOutcome halt() override { return head_.halt(); }
  Outcome<HeadReading> read() override {
    HeadReading reading = head_.read().value();
    if (reading.time >= 0.4) reading.time = told_(reading.time);
    return reading;
  }

 private:
  HeadPort& head_;
  Told told_;
};

class OddClockCamera : public CameraPort {
 public:
  OddClockCamera(CameraPort& camera, Told told) : camera_(camera), told_(std::move(told)) {}
  Outcome<std::optional<Frame>> newest() override { return told(camera_.newest()); }
  Outcome<std::optional<Frame>> wait(double timeout) override { return told(camera_.wait(timeout)); }

 private:
  Outcome<std::optional<Frame>> told(Outcome<std::optional<Frame>> outcome) {
    if (outcome.fault() || !outcome.value()) return outcome;
    Frame frame = *outcome.value();
    if (frame.time >= 0.4) frame.time = told_(frame.time);
    return std::optional(frame);
  }

  CameraPort& camera_;
  Told told_;
};

struct OddClock {
  Told told;
  const char* reason;  // Of the arm and of heads.
};

const std::vector<OddClock>& odd_clocks() {
  static const std::vector<OddClock> list = {
      {[](double now) { return now + 1000; }, " tells of a time that is 1000 s from now"},
      {[](double now) { return now - 1000; }, " tells of nothing since 1000 s ago"},
      {[](double) { return 0.4; }, " tells of nothing since 0.3"},
      {[](double) { return std::numeric_limits<double>::infinity(); }, ""},
      {[](double) { return 1e300; }, " tells of a time that is 1e+300 s from now"}};
  return list;
}

// Brought to rest, and with a reason.
void expect_stopped(ServoBench& bench, const ServoResult& result, const ServoNotes& notes,
                    const std::string& reason) {
  EXPECT_FALSE(result.is_done);
  EXPECT_NE(result.reason.find(reason), std::string::npos) << result.reason << " is not " << reason;
  ASSERT_TRUE(result.fault);
  EXPECT_LT(result.steps.back().time, 1.5);
  for (const auto& [time, state] : notes.sent)
    for (const Eigen::Vector2d& bend : state.bends) EXPECT_TRUE(bend.allFinite()) << "at " << time;
  bench.rig().clock().wait_until(bench.rig().clock().now() + 0.5);
  EXPECT_FALSE(bench.ports().arm->read().value().moving);
}

TEST(ServoClocks, AnArmWhoseClockIsOddIsStopped) {
  for (const OddClock& odd : odd_clocks()) {
    ServoBench bench(servo_file(servo_target));
    RigPorts ports = bench.ports();
    OddClockArm arm(*ports.arm, odd.told);
    ports.arm = &arm;
    ServoNotes notes;
    const ServoResult result = bench.servo(ports, notes);
    expect_stopped(bench, result, notes, std::string("the arm") + odd.reason);
  }
}

TEST(ServoClocks, AHeadWhoseClockIsOddStopsTheArm) {
  for (const OddClock& odd : odd_clocks()) {
    ServoBench bench(servo_file(servo_target));
    RigPorts ports = bench.ports();
    OddClockHead head(*ports.cameras[1].head, odd.told);
    ports.cameras[1].head = &head;
    ServoNotes notes;
    const ServoResult result = bench.servo(ports, notes);
    expect_stopped(bench, result, notes,
                   *odd.reason == 0 ? "camera side does not tell how it stands"
                                    : std::string("the head of camera side") + odd.reason);
  }
}

// From the start: nothing is sent.
TEST(ServoClocks, AnArmThatBeginsInAnotherTimeIsNotMoved) {
  for (const double off : {-1000.0, 1000.0}) {
    ServoBench bench(servo_file(servo_target));
    bench.rig().clock().wait_until(1);
    RigPorts ports = bench.ports();
    OddClockArm arm(*ports.arm, [off](double now) { return now + off; });
    ports.arm = &arm;
    ServoNotes notes;
    EXPECT_NE(bench.servo(ports, notes).reason.find("1000 s"), std::string::npos);
    EXPECT_TRUE(notes.sent.empty());
  }
}

// A reading that is told twice, or a little late, does no harm.
TEST(ServoClocks, ReadingsThatAreRepeatedDoNoHarm) {
  const std::vector<Told> harmless = {[](double now) { return 0.1 * std::floor(now / 0.1); },
                                      [](double now) { return now - 0.01; }};
  for (const Told& told : harmless) {
    ServoBench bench(servo_file(servo_target));
    RigPorts ports = bench.ports();
    OddClockArm arm(*ports.arm, told);
    ports.arm = &arm;
    OddClockHead head(*ports.cameras[0].head, told);
    ports.cameras[0].head = &head;
    ServoNotes notes;
    const ServoResult result = bench.servo(ports, notes);
    EXPECT_TRUE(result.is_done) << result.reason;
    EXPECT_LT(result.remaining->rms, 0.005);
  }
}

// Of its pictures nothing is believed: the arm waits, and is given up.
TEST(ServoClocks, ACameraWhoseClockIsOddIsNotBelieved) {
  const std::vector<std::pair<Told, std::string>> cases = {
      {[](double now) { return now + 1000; }, "camera side: its picture tells of a time that is "},
      {[](double now) { return now - 1000; }, "s older than the one before"},
      {[](double) { return 0.4; }, "no pictures come"}};
  for (const auto& [told, reason] : cases) {
    ServoBench bench(servo_file(servo_target));
    RigPorts ports = bench.ports();
    OddClockCamera camera(*ports.cameras[1].camera, told);
    ports.cameras[1].camera = &camera;
    ServoNotes notes;
    const ServoResult result = bench.servo(ports, notes);
    EXPECT_FALSE(result.is_done);
    EXPECT_EQ(result.reason.find("out of view: "), 0u) << result.reason;
    EXPECT_NE(result.reason.find(reason), std::string::npos) << result.reason;
    EXPECT_FALSE(bench.ports().arm->read().value().moving);
    for (const ServoStep& step : result.steps) EXPECT_LT(step.seen_at.value_or(0), 0.5);
  }
}

// For a moment: what comes after it is as good as before.
TEST(ServoClocks, ACameraWhoseClockWasOddIsBelievedAgain) {
  for (const auto& [off, said] : {std::pair{1000.0, " a time that is "},
                                  std::pair{std::numeric_limits<double>::quiet_NaN(), " no time"}}) {
    ServoBench bench(servo_file(servo_target));
    RigPorts ports = bench.ports();
    OddClockCamera camera(*ports.cameras[1].camera,
                          [off = off](double now) { return now < 0.7 ? now + off : now; });
    ports.cameras[1].camera = &camera;
    ServoNotes notes;
    const ServoResult result = bench.servo(ports, notes);
    EXPECT_TRUE(result.is_done) << result.reason;
    EXPECT_TRUE(notes.has(std::string("camera side: its picture tells of") + said));
    EXPECT_TRUE(notes.has("the arm is seen again"));
    EXPECT_EQ(result.missed_steps, 0);
    for (const ServoStep& step : result.steps)
      EXPECT_TRUE(!step.seen_at || (std::isfinite(*step.seen_at) && std::isfinite(step.error->rms)));
  }
}

}  // namespace
}  // namespace flexura
