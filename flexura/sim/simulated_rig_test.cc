#include "flexura/sim/simulated_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <vector>

#include "flexura/sim/thread_pool.h"
#include "tests/support/random_cases.h"
#include "tests/support/rigs.h"

namespace flexura {
namespace {

using Taken = std::map<std::int64_t, Frame>;

void expect_same(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.number, b.number);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.received, b.received);
  EXPECT_TRUE(*a.picture == *b.picture);
}

// Commands at fixed times, and frames asked for at whatever times besides.
Taken run(const RigConfig& model, const RigConfig& truth, std::uint64_t seed, TestRandom* asks) {
  SimulatedRig rig(model, truth, numbers_renderer, seed);
  const RigPorts ports = rig.ports();
  const CameraPorts& front = ports.cameras[0];
  TestRandom commands(7);
  Taken taken;
  const auto look = [&] {
    const auto frame = front.camera->newest().value();
    if (frame) taken.emplace(frame->number, *frame);
  };
  for (double time = 0; time < 4; time += 0.4) {
    while (asks != nullptr && ports.clock->now() < time - 0.05) {
      ports.clock->wait_until(ports.clock->now() + asks->uniform(0, 0.05));
      look();
      (void)ports.arm->read();
      (void)front.head->read();
    }
    ports.clock->wait_until(time);
    look();
    ArmState state = ArmState::straight(2);
    for (Eigen::Vector2d& bend : state.bends) bend = commands.vector<2>(-1, 1);
    EXPECT_TRUE(ports.arm->command(state, 0));
    EXPECT_TRUE(front.head->command({commands.uniform(-0.1, 0.1), commands.uniform(-0.1, 0.1), 1.5}));
  }
  return taken;
}

RigConfig with_slow_cameras() {
  RigConfig rig = two_section_rig();
  for (CameraConfig& camera : rig.cameras) {
    camera.sensor.delay = 0.07, camera.sensor.exposure = 0.01, camera.sensor.drop = 0.2;
    camera.head.delay = 0.05, camera.head.pan.backlash = 0.01, camera.head.pan.resolution = 0.001;
  }
  return rig;
}

TEST(SimulatedRig, ShowsTheSameWhoeverElseAsksAndWhen) {
  for (const bool has_drive : {true, false}) {
    RigConfig rig = with_slow_cameras();
    if (!has_drive) rig.drive.reset();
    const Taken seldom = run(rig, rig, 5, nullptr);
    for_random_cases(5, [&](TestRandom& random) {
      const Taken often = run(rig, rig, 5, &random);
      EXPECT_GT(often.size(), 2 * seldom.size());
      int both = 0;
      for (const auto& [number, frame] : seldom) {
        if (!often.contains(number)) continue;
        ++both;
        expect_same(frame, often.at(number));
      }
      EXPECT_GT(both, 0);
    });
  }
}

TEST(SimulatedRig, AnotherSeedLosesOtherFrames) {
  const RigConfig rig = with_slow_cameras();
  TestRandom one(1), other(1);
  const Taken a = run(rig, rig, 5, &one), b = run(rig, rig, 6, &other);
  std::vector<std::int64_t> in_a, in_b;
  for (const auto& [number, frame] : a) in_a.push_back(number);
  for (const auto& [number, frame] : b) in_b.push_back(number);
  EXPECT_NE(in_a, in_b);
}

TEST(SimulatedRig, ShowsTheTrueWorldAndNotTheModel) {
  const RigConfig model = two_section_rig();
  RigConfig truth = model;
  truth.cameras[0].lens.fx = 88;  // a tenth longer
  truth.cameras[0].mount.position[0] += 0.1;
  truth.cameras[0].mount.look_at = {{0.1, 0, 0}};
  SimulatedRig nominal(model, model, numbers_renderer, 1), real(model, truth, numbers_renderer, 1);
  const auto a = numbers_of(*nominal.ports().cameras[0].camera->newest().value());
  const auto b = numbers_of(*real.ports().cameras[0].camera->newest().value());
  const double distance = model.cameras[0].mount.position[2];
  EXPECT_NEAR(b[8], 31.5 - 88 * 0.1 / distance, 1e-9);  // the tip
  EXPECT_NEAR(23.5 - b[9], 1.1 * (23.5 - a[9]), 1e-9);
}

TEST(SimulatedRig, RefusesAWorldThatTheModelCannotBeBelievedIn) {
  const RigConfig model = two_section_rig();
  const auto refuses = [&](auto&& spoil) {
    RigConfig truth = model;
    spoil(truth);
    EXPECT_NE(truth_problem(model, truth), "");
    EXPECT_THROW(SimulatedRig(model, truth, numbers_renderer, 1), std::invalid_argument);
  };
  refuses([](RigConfig& truth) { truth.arm.kind = ArmKind::planar; });
  refuses([](RigConfig& truth) { truth.arm.section.resize(3); });
  refuses([](RigConfig& truth) { truth.drive.reset(); });
  refuses([](RigConfig& truth) { truth.drive->tendon.pop_back(); });
  refuses([](RigConfig& truth) { truth.cameras.pop_back(); });
  refuses([](RigConfig& truth) { std::swap(truth.cameras[0], truth.cameras[1]); });
  refuses([](RigConfig& truth) { truth.cameras[0].sensor.width = 32; });
}

TEST(SimulatedRig, ShowsTheSameToThreadsThatAskItsCamerasAtOnce) {
  const RigConfig config = with_slow_cameras();
  const auto films_by = [&](std::size_t threads) {
    SimulatedRig rig(config, config, numbers_renderer, 5);
    const RigPorts ports = rig.ports();
    ThreadPool thread_pool(threads);
    TestRandom random(7);
    std::vector<std::vector<Frame>> films(ports.cameras.size());
    for (int step = 1; step < 100; ++step) {
      ArmState state = ArmState::straight(2);
      for (Eigen::Vector2d& bend : state.bends) bend = random.vector<2>(-1, 1);
      EXPECT_TRUE(ports.arm->command(state, 0.05));
      ports.clock->wait_until(0.05 * step);
      thread_pool.run(films.size(), [&](std::size_t i) {
        if (const auto frame = ports.cameras[i].camera->newest().value()) films[i].push_back(*frame);
        (void)ports.cameras[i].head->read();
      });
    }
    return films;
  };
  const auto one = films_by(1), two = films_by(2);
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_GT(one[i].size(), 20U);
    ASSERT_EQ(one[i].size(), two[i].size());
    for (std::size_t j = 0; j < one[i].size(); ++j) expect_same(one[i][j], two[i][j]);
  }
}

// Follows an arm's command with the newest frames, and knows nothing of who answers.
class SimulatedCameraTest : public testing::Test {
 protected:
  void start(double rate, double exposure, double delay, double drop) {
    RigConfig rig = two_section_rig();
    SensorConfig& sensor = rig.cameras[0].sensor;
    sensor.frame_rate = rate, sensor.exposure = exposure, sensor.delay = delay, sensor.drop = drop;
    rig_ = std::make_unique<SimulatedRig>(rig, rig, numbers_renderer, 3);
    ports_ = rig_->ports();
  }
  [[nodiscard]] CameraPort& camera() const { return *ports_.cameras[0].camera; }
  [[nodiscard]] ClockPort& clock() const { return *ports_.clock; }

  std::unique_ptr<SimulatedRig> rig_;
  RigPorts ports_;
};

TEST_F(SimulatedCameraTest, FramesCanBeHadAfterExposureAndDelay) {
  start(10, 0.02, 0.13, 0);
  EXPECT_FALSE(camera().newest().value());
  clock().wait_until(0.1499999);
  EXPECT_FALSE(camera().newest().value());
  clock().wait_until(0.1500001);
  const auto frame = camera().newest().value();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->number, 0);
  EXPECT_NEAR(frame->time, 0.01, 1e-15);
  EXPECT_NEAR(frame->received, 0.15, 1e-15);
  EXPECT_EQ(frame->exposure, 0.02);
  EXPECT_EQ(numbers_of(*frame)[10], 0);
  EXPECT_FALSE(camera().newest().value()) << "given before";
  clock().wait_until(0.96);
  EXPECT_EQ(camera().newest().value()->number, 8) << "older ones are passed over";
}

TEST_F(SimulatedCameraTest, WaitsForTheNextFrameAndNoLonger) {
  start(10, 0.02, 0.13, 0);
  EXPECT_EQ(camera().wait(1).value()->number, 0);
  EXPECT_NEAR(clock().now(), 0.15, 1e-15);
  EXPECT_EQ(camera().wait(1).value()->number, 1);
  EXPECT_FALSE(camera().wait(0.04).value());
  EXPECT_NEAR(clock().now(), 0.29, 1e-15);
  EXPECT_EQ(camera().wait(0.1).value()->number, 2);
}

TEST_F(SimulatedCameraTest, GivesAllThatIsNewToWhoFilms) {
  start(10, 0.02, 0.13, 0);
  SimulatedCamera& film = rig_->camera(0).camera();
  EXPECT_FALSE(film.has_new());
  EXPECT_TRUE(film.all_new().empty());
  clock().wait_until(0.56);
  EXPECT_TRUE(film.has_new());
  const std::vector<Frame> frames = film.all_new();
  ASSERT_EQ(frames.size(), 5U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].number, static_cast<std::int64_t>(i));
    EXPECT_NEAR(frames[i].received, 0.15 + 0.1 * static_cast<double>(i), 1e-12);
  }
  EXPECT_FALSE(film.has_new());
  EXPECT_TRUE(film.all_new().empty());
  EXPECT_FALSE(camera().newest().value()) << "given before";
  clock().wait_until(0.76);
  EXPECT_EQ(camera().newest().value()->number, 6);
  EXPECT_FALSE(film.has_new()) << "passed over, or given";
  clock().wait_until(0.96);
  film.skip_to_now();
  EXPECT_FALSE(film.has_new());
  clock().wait_until(1.06);
  EXPECT_EQ(film.all_new().at(0).number, 9);
}

TEST_F(SimulatedCameraTest, FilmsWhatIsNotLostHoweverManyAreLostInARow) {
  start(100, 0, 0, 0.95);
  SimulatedCamera& film = rig_->camera(0).camera();
  std::int64_t last = -1, longest = 0, count = 0;
  for (int second = 1; second <= 10; ++second) {
    clock().wait_until(second);
    for (const Frame& frame : film.all_new()) {
      EXPECT_GT(frame.number, last);
      longest = std::max(longest, frame.number - last);
      last = frame.number, ++count;
    }
    EXPECT_FALSE(film.has_new());
  }
  EXPECT_GT(longest, frames_kept);
  EXPECT_NEAR(static_cast<double>(count) / 1000, 0.05, 0.021);  // three standard deviations
}

// Of the frames that come after one, so many may be lost, and no more, for it to be the newest.
TEST_F(SimulatedCameraTest, LooksBackAsFarAsItSaysAndNoFarther) {
  start(100, 0, 0, 0.95);
  clock().wait_until(60);
  std::vector<std::int64_t> kept;
  for (const Frame& frame : rig_->camera(0).camera().all_new()) kept.push_back(frame.number);
  int count = 0;
  for (std::size_t i = 0; i + 1 < kept.size(); ++i) {
    if (kept[i + 1] - kept[i] <= frames_kept) continue;
    ++count;
    for (const int lost : {frames_kept - 1, frames_kept}) {
      start(100, 0, 0, 0.95);
      clock().wait_until((static_cast<double>(kept[i] + lost) + 0.5) / 100);
      const auto newest = camera().newest().value();
      EXPECT_EQ(newest ? newest->number : -1, lost < frames_kept ? kept[i] : -1);
    }
  }
  EXPECT_GT(count, 10);
}

// The arm's way is remembered as far back as that, however often it was sent elsewhere meanwhile.
TEST_F(SimulatedCameraTest, ShowsAFrameAsLateAsItCanBeHadAsItWasAtOnce) {
  RigConfig config = two_section_rig();
  config.drive.reset();
  for (CameraConfig& camera : config.cameras)
    camera.sensor.frame_rate = 100, camera.sensor.exposure = 0, camera.sensor.drop = 0.9;
  const auto steered = [&](double end, std::vector<Frame>* film) {
    SimulatedRig rig(config, config, numbers_renderer, 3);
    for (double time = 0.001; time < end; time += 0.001) {
      rig.clock().wait_until(time);
      ArmState state = ArmState::straight(2);
      state.bends[0].x() = 0.5 * std::sin(3 * time);
      EXPECT_TRUE(rig.ports().arm->command(state, 0.001));
      if (film == nullptr) continue;
      for (const Frame& frame : rig.camera(0).camera().all_new()) film->push_back(frame);
    }
    return film == nullptr ? rig.ports().cameras[0].camera->newest().value() : std::nullopt;
  };
  std::vector<Frame> film;
  (void)steered(5, &film);
  int count = 0;
  for (std::size_t i = 0; i + 1 < film.size(); ++i) {
    if (film[i + 1].number - film[i].number < frames_kept) continue;
    ++count;
    const auto late = steered((static_cast<double>(film[i].number) + frames_kept - 0.05) / 100, nullptr);
    ASSERT_TRUE(late);
    EXPECT_EQ(late->number, film[i].number);
    EXPECT_TRUE(*late->picture == *film[i].picture);
  }
  EXPECT_GT(count, 3);
}

TEST_F(SimulatedCameraTest, RefusesToWaitForATimeThatIsNotFinite) {
  start(10, 0, 0, 1);
  for (const double timeout : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    const auto frame = camera().wait(timeout);
    ASSERT_FALSE(frame) << timeout;
    EXPECT_EQ(frame.fault()->kind, FaultKind::refused);
  }
  EXPECT_EQ(clock().now(), 0);
}

TEST_F(SimulatedCameraTest, ThatLosesAllHasNone) {
  start(100, 0, 0, 1);
  EXPECT_FALSE(camera().wait(2).value());
  EXPECT_NEAR(clock().now(), 2, 1e-12);
}

TEST_F(SimulatedCameraTest, DoesNotAnswerWhileItsLinkIsLost) {
  start(10, 0, 0, 0);
  rig_->camera(0).camera().link().lose(1, 2);
  clock().wait_until(1.5);
  EXPECT_EQ(camera().newest().fault()->kind, FaultKind::link_lost);
  EXPECT_FALSE(camera().wait(1));
  clock().wait_until(2);
  EXPECT_EQ(camera().newest().value()->number, 20);
}

TEST_F(SimulatedCameraTest, SeesWhereTheArmWasWhenItWasExposed) {
  start(10, 0, 0.5, 0);
  ArmState bent = ArmState::straight(2);
  bent.bends[0] = {1, 0};
  clock().wait_until(1);
  ASSERT_TRUE(ports_.arm->command(bent, 0));
  clock().wait_until(1.55);
  const Frame frame = *camera().newest().value();
  ASSERT_EQ(frame.number, 10);
  const auto before = rig_->camera(0).view(1.0).project(rig_->arm().backbone(1.0).tip().position);
  EXPECT_NEAR(numbers_of(frame)[8], before->x(), 1e-9);
  clock().wait_until(1.85);
  const Frame later = *camera().newest().value();
  ASSERT_EQ(later.number, 13);
  EXPECT_GT(std::abs(numbers_of(later)[8] - before->x()), 0.1);
}

TEST(FrameTimes, FollowTheReadout) {
  SensorConfig sensor;
  sensor.height = 101, sensor.frame_rate = 10, sensor.exposure = 0.02, sensor.delay = 0.5;
  EXPECT_NEAR(frame_times(sensor, 3).start, 0.3, 1e-15);
  EXPECT_NEAR(frame_times(sensor, 3).middle, 0.31, 1e-15);
  EXPECT_NEAR(frame_times(sensor, 3).received, 0.82, 1e-15);
  sensor.readout = Readout::rolling, sensor.row_time = 1e-4;
  EXPECT_NEAR(frame_times(sensor, 3).middle, 0.315, 1e-15);
  EXPECT_NEAR(frame_times(sensor, 3).end, 0.33, 1e-15);
  sensor.readout = Readout::interlaced, sensor.row_time = 0;
  EXPECT_NEAR(frame_times(sensor, 3).end, 0.37, 1e-15);
  sensor.height = 1;
  EXPECT_NEAR(frame_times(sensor, 3).end, 0.32, 1e-15) << "no odd row";
}

}  // namespace
}  // namespace flexura
