#include "flexura/port/device_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "flexura/port/clocked_ports.h"
#include "tests/support/random_cases.h"
#include "tests/support/stub_ports.h"

namespace flexura {
namespace {

constexpr double not_a_time = std::numeric_limits<double>::quiet_NaN();
constexpr double ever = std::numeric_limits<double>::infinity();

// A device's clock with an offset and a different rate.
struct OwnClock {
  double offset = 0, drift = 0;
  [[nodiscard]] double shows(double rig) const { return offset + (1 + drift) * rig; }
};

OwnClock random_clock(TestRandom& random) { return {random.uniform(-1e6, 1e6), random.uniform(-1e-4, 1e-4)}; }

// Mostly short, sometimes long delays, s.
double random_delay(TestRandom& random) {
  return random.integer(0, 9) == 0 ? random.uniform(0, 0.2) : random.uniform(2e-4, 5e-3);
}

TEST(DeviceClock, BoundsTheRigsTimeByWhenItAskedAndWhenItWasAnswered) {
  for_random_cases(20, [](TestRandom& random) {
    const OwnClock own = random_clock(random);
    DeviceClock clock;
    double now = random.uniform(0, 100), sum = 0;
    int count = 0;
    for (int i = 0; i < 600; ++i) {
      now += random.uniform(0.02, 0.2);
      const double asked = now, reported = now + random_delay(random),
                   answered = reported + random_delay(random);
      ASSERT_TRUE(clock.add(own.shows(reported), asked, answered));
      now = answered;
      const double ago = random.uniform(0, 5), when = std::max(reported - ago, asked - 5);
      const double error = std::abs(clock.rig_time(own.shows(when)) - when);
      ASSERT_LE(error, clock.uncertainty(own.shows(when))) << "it is a bound";
      if (i < 300) continue;
      ASSERT_LE(clock.uncertainty(own.shows(reported)), 2e-3) << "the delays are 2 to 50 times as long";
      sum += error * error, ++count;
    }
    EXPECT_LE(std::sqrt(sum / count), 3e-4);
    EXPECT_NEAR(clock.drift(), -own.drift, 1e-4);
  });
}

// As for pictures: the time of arrival and the least delay are known.
TEST(DeviceClock, GoesByTheQuickestWhereNobodyKnowsHowOldAnAnswerIs) {
  for_random_cases(20, [](TestRandom& random) {
    const OwnClock own = random_clock(random);
    DeviceClock clock;
    for (int i = 0; i < 1200; ++i) {
      const double exposed = 0.05 * i, received = exposed + 0.03 + random_delay(random);
      ASSERT_TRUE(clock.add(own.shows(exposed), -ever, received - 0.03));
      if (i < 200) continue;
      ASSERT_NEAR(clock.rig_time(own.shows(exposed)), exposed, 2e-3);
      ASSERT_LE(clock.uncertainty(own.shows(exposed)), 2e-3);
    }
    EXPECT_NEAR(clock.drift(), -own.drift, 4e-5);
  });
}

TEST(DeviceClock, IsExactWhereAnswersTakeNoTime) {
  const OwnClock own{1000, 5e-5};
  for (const double age : {0.0, ever}) {
    DeviceClock clock;
    for (int i = 0; i < 400; ++i) {
      const double now = 0.1 * i;
      ASSERT_TRUE(clock.add(own.shows(now), now - age, now));
      ASSERT_NEAR(clock.rig_time(own.shows(now)), now, i < 20 ? 5e-4 : 1e-5) << "at first it may drift";
    }
    EXPECT_NEAR(clock.rig_time(own.shows(41)), 41, 1e-5) << "ahead";
    EXPECT_NEAR(clock.drift(), -5e-5, 1e-6);
    EXPECT_LE(clock.uncertainty(own.shows(40)), 1e-5);
  }
}

TEST(DeviceClock, KnowsOfOneAnswerNoMoreThanItTells) {
  DeviceClock clock;
  EXPECT_FALSE(clock.is_known());
  EXPECT_THROW((void)clock.rig_time(1), std::logic_error);
  ASSERT_TRUE(clock.add(500, 10, 10.2));
  EXPECT_NEAR(clock.rig_time(500), 10.1, 1e-9);
  EXPECT_NEAR(clock.uncertainty(500), 0.1, 1e-5);
  // Until the next request, the clock may have drifted.
  EXPECT_NEAR(clock.uncertainty(600), 0.1 + 100 * 5e-4, 1e-5);
}

TEST(DeviceClock, LearnsAgainWhenItIsSetAndPassesOverOneOddTime) {
  for (const double age : {0.01, ever}) {
    OwnClock own{1000, 2e-5};
    DeviceClock clock;
    double now = 0;
    const auto ask = [&](double off) {
      now += 0.1;
      return clock.add(own.shows(now) + off, now - age, now);
    };
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(ask(0));
    EXPECT_FALSE(ask(3600)) << "an hour ahead";
    EXPECT_FALSE(ask(not_a_time));
    EXPECT_TRUE(ask(0));
    EXPECT_NEAR(clock.rig_time(own.shows(now)), now, 0.011);
    own.offset = 1007;
    EXPECT_FALSE(ask(0));
    EXPECT_FALSE(ask(0));
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(ask(0));
    EXPECT_NEAR(clock.rig_time(own.shows(now)), now, 0.011);
  }
}

// The drift changes, as with temperature: bounds older than the window must not count.
TEST(DeviceClock, ForgetsWhatIsLongAgo) {
  DeviceClock clock({.window = 20});
  double shows = 0;
  for (int i = 0; i < 3000; ++i) {
    const double now = 0.1 * i;
    shows += 0.1 * (1 + 1e-4 * std::sin(2e-3 * i));
    ASSERT_TRUE(clock.add(shows, now - 0.002, now + 0.002)) << now;
    ASSERT_NEAR(clock.rig_time(shows), now, 0.002);
  }
}

TEST(DeviceClock, RefusesWhatIsNoTime) {
  DeviceClock clock;
  EXPECT_FALSE(clock.add(not_a_time, 0, 1));
  EXPECT_FALSE(clock.add(ever, 0, 1));
  EXPECT_FALSE(clock.add(5, 0, not_a_time));
  EXPECT_FALSE(clock.add(5, 2, 1)) << "answered before it was asked";
  EXPECT_FALSE(clock.add(5, not_a_time, 1));
  EXPECT_FALSE(clock.is_known());
  EXPECT_THROW(DeviceClock({.window = 0}), std::invalid_argument);
  EXPECT_THROW(DeviceClock({.drift = not_a_time}), std::invalid_argument);
}

// A clock that advances with each call, like the time that an answer takes.
class WaitedClock : public ClockPort {
 public:
  [[nodiscard]] double now() const override { return time; }
  void wait_until(double until) override { time = std::max(time, until); }
  double time = 0;
};

class SlowHead : public StubHead {
 public:
  SlowHead(WaitedClock& rig, const OwnClock& own, TestRandom& random)
      : rig_(rig), own_(own), random_(random) {}
  Outcome<HeadReading> read() override {
    rig_.time += random_delay(random_);
    next_reading.time = own_.shows(truth = rig_.time);
    auto reading = StubHead::read();
    rig_.time += random_delay(random_);
    return reading;
  }
  double truth = 0;

 private:
  WaitedClock& rig_;
  OwnClock own_;
  TestRandom& random_;
};

TEST(ClockedPorts, ReadingsOfADeviceWithItsOwnClockHaveTheRigsTime) {
  for_random_cases(10, [](TestRandom& random) {
    WaitedClock rig;
    SlowHead slow(rig, random_clock(random), random);
    DeviceClock clock;
    ClockedHead head(slow, rig, clock);
    double last = -1;
    for (int i = 0; i < 300; ++i) {
      const double asked = rig.time;
      const HeadReading reading = head.read().value();
      EXPECT_GE(reading.time, last);
      EXPECT_LE(reading.time, rig.time);
      EXPECT_NEAR(reading.time, slow.truth, i < 100 ? rig.time - asked : 4e-3);
      EXPECT_EQ(reading.state, slow.next_reading.state);
      last = reading.time;
      rig.time += 0.05;
    }
    slow.fault = PortFault{FaultKind::link_lost, "gone"};
    EXPECT_EQ(head.read().fault()->what, "gone");
    EXPECT_TRUE(head.command({}));
    EXPECT_TRUE(head.halt());
  });
}

TEST(ClockedPorts, TimesDoNotGoBackWhereTheDevicesGoOn) {
  DeviceClock clock;
  MappedTime time(clock);
  EXPECT_NEAR(time.of(500, 10, 10.2), 10.1, 1e-9);
  // Without the earlier answer the result would be 10.08 s.
  EXPECT_NEAR(time.of(500.01, 10, 10.15), 10.1, 1e-9);
  EXPECT_NEAR(time.of(500.02, 10, 10.04), 10.03, 1e-4) << "it was too late before";
  EXPECT_LT(time.of(499, 9, 10.05), 9.1) << "an older one";
}

// Frames arrive late, each with its own delay; their times are of the device's clock.
class StubCameraPort : public CameraPort {
 public:
  std::optional<Frame> next;
  Outcome<std::optional<Frame>> newest() override { return next; }
  Outcome<std::optional<Frame>> wait(double) override { return next; }
};

TEST(ClockedPorts, FramesOfACameraWithItsOwnClockHaveTheRigsTime) {
  for_random_cases(10, [](TestRandom& random) {
    const OwnClock own = random_clock(random);
    StubCameraPort device;
    DeviceClock clock;
    ClockedCamera camera(device, clock, 0.04);
    EXPECT_FALSE(camera.newest().value());
    double last = -1;
    for (int i = 0; i < 300; ++i) {
      const double exposed = 0.1 * i;
      device.next = Frame{i, own.shows(exposed), 0.01, exposed + 0.04 + random_delay(random), nullptr};
      const Frame frame = *(i % 2 == 0 ? camera.newest() : camera.wait(1)).value();
      EXPECT_EQ(frame.number, i);
      EXPECT_EQ(frame.received, device.next->received);
      EXPECT_GE(frame.time, last);
      if (i > 100) {
        EXPECT_NEAR(frame.time, exposed, 3e-3);
      }
      last = frame.time;
    }
  });
}

}  // namespace
}  // namespace flexura
