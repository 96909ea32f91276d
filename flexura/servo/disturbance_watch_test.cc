#include "flexura/servo/disturbance_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "flexura/model/arm_response.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

Arm watched_arm() {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.resize(2);
  for (Section& section : arm.sections) section.length = 0.5;
  return arm;
}

// An arm that follows its commands by a share, with two tendons. Without the first one, the first section
// straightens; without the second one, the second section does.
class TwoTendons : public ArmResponse {
 public:
  [[nodiscard]] ArmState shape(const ArmState& command) const override { return command; }
  void slopes(const ArmState&, Eigen::MatrixXd& by_command) const override { by_command.setIdentity(6, 6); }
  [[nodiscard]] std::vector<ArmState> released(const ArmState& command) const override {
    ArmState first = command, second = command;
    first.bends[0].setZero();
    second.bends[1].setZero();
    return {first, second};
  }
};

ArmModel watched_model() {
  const Arm arm = watched_arm();
  const Actuation actuation(arm, std::make_shared<TwoTendons>());
  return {arm, actuation, shaped_arm(arm, actuation)};
}

// A command at a time of a motion.
ArmState moving(double time) { return {{{0.5 * time, 0.2}, {0.3, -0.4 * time}}, {1, 1}}; }

// The true arm bends by 20 % too little and hangs to one side.
ArmState lagging(ArmState state) {
  for (Eigen::Vector2d& bend : state.bends) bend = 0.8 * bend + Eigen::Vector2d(0.1, -0.05);
  return state;
}

TEST(DisturbanceWatch, TakesErrorsOfTheModelForNone) {
  for_random_cases(20, [](TestRandom& random) {
    DisturbanceWatch watch(watched_model());
    for (int i = 0; i < 100; ++i) {
      const double time = 0.033 * i;
      ArmState seen = lagging(moving(time));
      for (Eigen::Vector2d& bend : seen.bends) bend += 0.003 * random.vector<2>(-1, 1);
      watch.add(time, seen, moving(time), 0.001);
      EXPECT_FALSE(watch.is_disturbed());
    }
    EXPECT_EQ(watch.slow_cause(), "");
  });
}

TEST(DisturbanceWatch, DetectsAPushAndItsEnd) {
  DisturbanceWatch watch(watched_model());
  const auto add = [&](int i, double push) {
    const double time = 0.033 * i;
    ArmState seen = lagging(moving(1));
    seen.bends[0].y() += push, seen.bends[1].x() -= push;
    watch.add(time, seen, moving(1), 0.001);
  };
  for (int i = 0; i < 30; ++i) add(i, 0);
  // One or two observations may be outliers.
  add(30, 0.4), add(31, 0.4);
  EXPECT_FALSE(watch.is_disturbed());
  add(32, 0.4);
  EXPECT_TRUE(watch.is_disturbed());
  EXPECT_GT(watch.deviation(), 0.05);
  EXPECT_NE(watch.what().find("as if something pushed or held the arm"), std::string::npos) << watch.what();
  for (int i = 33; i < 63; ++i) add(i, 0.4);
  EXPECT_TRUE(watch.is_disturbed()) << "longer than the window";
  EXPECT_NEAR(watch.lasts(), 0.033 * 30, 1e-9);
  for (int i = 63; i < 66; ++i) add(i, 0);
  EXPECT_FALSE(watch.is_disturbed());
  EXPECT_EQ(watch.lasts(), 0);
}

TEST(DisturbanceWatch, NamesTheTendonThatGaveWay) {
  for (const std::size_t tendon : {0U, 1U}) {
    DisturbanceWatch watch(watched_model());
    ArmState seen = moving(2);
    for (int i = 0; i < 20; ++i) watch.add(0.033 * i, seen, moving(2), 0.001);
    seen.bends[tendon] *= 0.2;
    for (int i = 20; i < 24; ++i) watch.add(0.033 * i, seen, moving(2), 0.001);
    EXPECT_TRUE(watch.is_disturbed());
    const std::string name = tendon == 0 ? "tendon 1 were released" : "tendon 2 were released";
    EXPECT_NE(watch.what().find(name), std::string::npos) << watch.what();
    EXPECT_NE(watch.slow_cause().find(name), std::string::npos);
  }
}

TEST(DisturbanceWatch, HandlesShapesThatAreNoNumbers) {
  DisturbanceWatch watch(watched_model());
  ArmState none = moving(1);
  none.bends[0].x() = std::nan("");
  for (int i = 0; i < 10; ++i) watch.add(0.033 * i, none, moving(1), 0.001);
  EXPECT_FALSE(watch.is_disturbed());
  EXPECT_EQ(watch.what().find("tendon"), std::string::npos);
  EXPECT_THROW(DisturbanceWatch(watched_model(), {.limit = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
