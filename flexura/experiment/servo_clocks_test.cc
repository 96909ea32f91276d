// Servos whose devices' clocks stop, go back or run ahead.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/servo_bench.h"

namespace flexura {
namespace {

using Shown = std::function<double(double now)>;

// Returns a function that replaces the time of readings by `shown` from 0.4 s on.
auto altered_clock(const Shown& shown) {
  return [shown](auto reading) {
    if (reading.time >= 0.4) reading.time = shown(reading.time);
    return reading;
  };
}

struct AlteredClock {
  Shown shown;
  const char* reason;  // For the arm and for heads.
};

const std::vector<AlteredClock>& altered_clocks() {
  static const std::vector<AlteredClock> list = {
      {[](double now) { return now + 1000; }, ": its timestamp is 1000 s in the future"},
      {[](double now) { return now - 1000; }, ": no reading for 1000 s"},
      {[](double) { return 0.4; }, ": no reading for 0.3"},
      {[](double) { return std::numeric_limits<double>::infinity(); }, ""},
      {[](double) { return 1e300; }, ": its timestamp is 1e+300 s in the future"}};
  return list;
}

// Expects that the arm was brought to rest, and with a reason.
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
  for (const AlteredClock& odd : altered_clocks()) {
    ServoBench bench(servo_file(servo_target));
    RigPorts ports = bench.ports();
    AlteredArm arm(*ports.arm, altered_clock(odd.shown));
    ports.arm = &arm;
    ServoNotes notes;
    const ServoResult result = bench.servo(ports, notes);
    expect_stopped(bench, result, notes, std::string("the arm") + odd.reason);
  }
}

TEST(ServoClocks, AHeadWhoseClockIsOddStopsTheArm) {
  for (const AlteredClock& odd : altered_clocks()) {
    ServoBench bench(servo_file(servo_target));
    RigPorts ports = bench.ports();
    AlteredHead head(*ports.cameras[1].head, altered_clock(odd.shown));
    ports.cameras[1].head = &head;
    ServoNotes notes;
    const ServoResult result = bench.servo(ports, notes);
    expect_stopped(bench, result, notes,
                   *odd.reason == 0 ? "camera side: the readings of its head or stage are not finite"
                                    : std::string("the head of camera side") + odd.reason);
  }
}

// From the start: no commands.
TEST(ServoClocks, AnArmThatBeginsInAnotherTimeIsNotMoved) {
  for (const double off : {-1000.0, 1000.0}) {
    ServoBench bench(servo_file(servo_target));
    bench.rig().clock().wait_until(1);
    RigPorts ports = bench.ports();
    AlteredArm arm(*ports.arm, altered_clock([off](double now) { return now + off; }));
    ports.arm = &arm;
    ServoNotes notes;
    EXPECT_NE(bench.servo(ports, notes).reason.find("1000 s"), std::string::npos);
    EXPECT_TRUE(notes.sent.empty());
  }
}

// A reading that is repeated, or slightly late, does no harm.
TEST(ServoClocks, ReadingsThatAreRepeatedDoNoHarm) {
  const std::vector<Shown> harmless = {[](double now) { return 0.1 * std::floor(now / 0.1); },
                                       [](double now) { return now - 0.01; }};
  for (const Shown& shown : harmless) {
    ServoBench bench(servo_file(servo_target));
    RigPorts ports = bench.ports();
    AlteredArm arm(*ports.arm, altered_clock(shown));
    ports.arm = &arm;
    AlteredHead head(*ports.cameras[0].head, altered_clock(shown));
    ports.cameras[0].head = &head;
    ServoNotes notes;
    const ServoResult result = bench.servo(ports, notes);
    EXPECT_TRUE(result.is_done) << result.reason;
    EXPECT_LT(result.remaining->rms, 0.005);
  }
}

// Its pictures are ignored: the arm waits, and the servo ends.
TEST(ServoClocks, ACameraWhoseClockIsOddIsNotBelieved) {
  const std::vector<std::pair<Shown, std::string>> cases = {
      {[](double now) { return now + 1000; }, "camera side: its picture's timestamp is "},
      {[](double now) { return now - 1000; }, "s older than the previous picture"},
      {[](double) { return 0.4; }, "pictures were received"}};
  for (const auto& [shown, reason] : cases) {
    ServoBench bench(servo_file(servo_target));
    RigPorts ports = bench.ports();
    AlteredCamera camera(*ports.cameras[1].camera, altered_clock(shown));
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

// For a moment: later pictures must be used again.
TEST(ServoClocks, ACameraWhoseClockWasOddIsBelievedAgain) {
  for (const auto& [off, reading] :
       {std::pair{1000.0, "999.9"}, std::pair{std::numeric_limits<double>::quiet_NaN(), "not finite"}}) {
    ServoBench bench(servo_file(servo_target));
    RigPorts ports = bench.ports();
    AlteredCamera camera(*ports.cameras[1].camera,
                         altered_clock([off = off](double now) { return now < 0.7 ? now + off : now; }));
    ports.cameras[1].camera = &camera;
    ServoNotes notes;
    const ServoResult result = bench.servo(ports, notes);
    EXPECT_TRUE(result.is_done) << result.reason;
    EXPECT_TRUE(notes.has(std::string("camera side: its picture's timestamp is ") + reading));
    EXPECT_TRUE(notes.has("the arm is visible again"));
    EXPECT_EQ(result.missed_steps, 0);
    for (const ServoStep& step : result.steps)
      EXPECT_TRUE(!step.seen_at || (std::isfinite(*step.seen_at) && std::isfinite(step.error->rms)));
  }
}

// An arm whose readings take some time, so that commands come late, by a different time at each step. It
// moves as commanded, each command evenly in its duration.
class LateArm : public ArmPort {
 public:
  LateArm(ArmPort& arm, ClockPort& clock, double latest) : arm_(arm), clock_(clock), latest_(latest) {}
  Outcome<ArmReading> read() override {
    constexpr double golden = 0.618033988749895;
    ++readings_;
    clock_.wait_until(clock_.now() + latest_ * std::fmod(golden * readings_, 1));
    return arm_.read();
  }
  CommandOutcome command(const ArmState& state, double duration) override {
    const double now = clock_.now();
    if (!to_.bends.empty()) {
      const double part = std::clamp((now - since_) / (until_ - since_), 0.0, 1.0);
      for (std::size_t i = 0; i < to_.bends.size(); ++i) {
        const Eigen::Vector2d at = from_.bends[i] + part * (to_.bends[i] - from_.bends[i]);
        fastest_ = std::max(fastest_, (state.bends[i] - at).norm() / duration);
        from_.bends[i] = at;
      }
    } else {
      from_ = state;
    }
    to_ = state, since_ = now, until_ = now + duration;
    return arm_.command(state, duration);
  }
  CommandOutcome halt() override { return arm_.halt(); }
  /// Returns the largest commanded bend rate of a section, rad/s.
  [[nodiscard]] double fastest() const { return fastest_; }

 private:
  ArmPort& arm_;
  ClockPort& clock_;
  double latest_;
  int readings_ = 0;
  ArmState from_, to_;
  double since_ = 0, until_ = 0, fastest_ = 0;
};

// Late commands delay the arm and do not make it faster. With readings up to 0.12 s late, steps are missed,
// too.
TEST(ServoClocks, LateCommandsMoveTheArmNoFaster) {
  for (const double latest : {0.0, 0.01, 0.025, 0.12}) {
    ServoBench bench(servo_file(servo_target));
    RigPorts ports = bench.ports();
    LateArm arm(*ports.arm, *ports.clock, latest);
    ports.arm = &arm;
    ServoNotes notes;
    const ServoResult result = bench.servo(ports, notes);
    EXPECT_TRUE(result.is_done) << latest << " s: " << result.reason;
    EXPECT_EQ(result.missed_steps > 0, latest > 0.05) << latest << " s";
    constexpr double rate = std::numbers::pi / 2;  // Of the file's sections.
    EXPECT_LT(arm.fastest(), rate * (1 + 1e-9)) << latest << " s";
    EXPECT_GT(arm.fastest(), 0.5 * rate) << latest << " s";
  }
}

}  // namespace
}  // namespace flexura
