#include "flexura/calibrate/rig_session_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/banded_arms.h"
#include "tests/support/rig_trials.h"

namespace flexura {
namespace {

ZoomRow row(double ratio, double count) {
  ZoomRow row;
  row.ratio = ratio, row.count = count;
  return row;
}

// Motor counts that fall from wide to long on the first camera, and rise on the second.
RigModel rig_of_two_lenses() {
  RigModel rig = nominal_rig();
  rig.cameras[0].lens.zoom = {row(1, 9000), row(4, 8000)};
  rig.cameras[1].lens.zoom = {row(1, 0), row(4, 600)};
  rig.cameras[0].initial.zoom = 9000, rig.cameras[1].initial.zoom = 0;
  return rig;
}

ViewCandidate look_of(std::size_t camera, const HeadState& head, const Eigen::Vector3d& offset = {0, 0, 0}) {
  return {some_poses()[0], {{.camera = camera, .head = head, .stage = {offset}}}};
}

TEST(IsLike, GoesByWhatIsSeenOfThePoseAndFromWhere) {
  const RigModel rig = nominal_rig();
  const ViewCandidate look = look_of(0, {.pan = 0.1, .tilt = 0.05, .zoom = 2});
  EXPECT_TRUE(is_like(rig, look, look));
  EXPECT_TRUE(is_like(rig, look_of(0, {.pan = 0.12, .tilt = 0.04, .zoom = 2.1}, {0.03, 0, 0}), look));
  EXPECT_FALSE(is_like(rig, look_of(1, look.stances[0].head), look));
  EXPECT_FALSE(is_like(rig, look_of(0, {.pan = 0.15, .tilt = 0.05, .zoom = 2}), look));
  EXPECT_FALSE(is_like(rig, look_of(0, {.pan = 0.1, .tilt = 0, .zoom = 2}), look));
  EXPECT_FALSE(is_like(rig, look_of(0, look.stances[0].head, {0, 0, 0.06}), look));
  ViewCandidate bent = look;
  bent.pose = some_poses()[1];
  EXPECT_FALSE(is_like(rig, bent, look));
  // One similar stance is enough.
  ViewCandidate both = look_of(1, {});
  both.stances.push_back(look.stances[0]);
  EXPECT_TRUE(is_like(rig, both, look));
}

// A ninth of the count is the whole zoom range of the first lens; on the second, relative changes of a count
// of 0 mean nothing.
TEST(IsLike, ComparesZoomRatiosAndNotTheMotorsCounts) {
  const RigModel rig = rig_of_two_lenses();
  EXPECT_FALSE(is_like(rig, look_of(0, {.zoom = 8200}), look_of(0, {.zoom = 9000})));
  EXPECT_TRUE(is_like(rig, look_of(0, {.zoom = 8960}), look_of(0, {.zoom = 9000})));
  EXPECT_TRUE(is_like(rig, look_of(1, {.zoom = 20}), look_of(1, {.zoom = 0})));
  EXPECT_FALSE(is_like(rig, look_of(1, {.zoom = 60}), look_of(1, {.zoom = 0})));
}

// A session about to choose its next look after three pictures per camera.
struct Choice {
  explicit Choice(const RigModel& rig) : nominal(rig) {
    TestRandom random(5);
    config.poses = some_poses(), config.picture.markers = bands();
    RigTrialConfig wrong;
    wrong.turn = 3 * degree, wrong.shift = 0.05;
    RigTrial trial(true_rig(nominal, wrong, random), wrong, random);
    for (const ArmState& shown : config.poses) {
      const std::size_t pose = trial.add_pose(shown);
      for (const std::size_t camera : {std::size_t{0}, std::size_t{1}}) {
        const HeadState start = Camera(nominal.cameras[camera]).initial_head();
        trial.add_image(trial.add_stance({.camera = camera, .head = start}), pose);
      }
    }
    problem.emplace(nominal, rough_prior(nominal), trial.seen());
    found = calibrate_rig(*problem);
  }
  [[nodiscard]] std::optional<ViewCandidate> next(const std::vector<ViewCandidate>& missed) const {
    const RigSessionPlan plan(nominal, config);
    const std::array<RigStance, 2> stands = {RigStance{.camera = 0}, RigStance{.camera = 1}};
    return plan.next(*problem, found, plan.desired(found.model, stands), stands, missed).first;
  }

  RigModel nominal;
  RigSessionConfig config;
  std::optional<RigProblem> problem;
  RigCalibration found;
};

TEST(RigSessionPlan, TriesNoViewAgainThatWasMissed) {
  const Choice choice(nominal_rig());
  ASSERT_TRUE(choice.found.is_found) << choice.found.reason;
  std::vector<ViewCandidate> missed;
  for (int i = 0; i < 4; ++i) {
    const auto next = choice.next(missed);
    ASSERT_TRUE(next);
    for (const ViewCandidate& one : missed) EXPECT_FALSE(is_like(choice.nominal, *next, one)) << i;
    missed.push_back({next->pose, {next->stances[static_cast<std::size_t>(i % 2)]}});
  }
}

TEST(RigSessionPlan, ZoomsEachLensByItsOwnTable) {
  const RigModel rig = rig_of_two_lenses();
  const Choice choice(rig);
  ASSERT_TRUE(choice.found.is_found) << choice.found.reason;
  const auto next = choice.next({});
  ASSERT_TRUE(next);
  std::array<double, 2> ratios{};
  for (const RigStance& stance : next->stances)
    ratios[stance.camera] = Camera(rig.cameras[stance.camera]).lens().ratio(stance.head.zoom);
  EXPECT_NEAR(ratios[0], ratios[1], 0.02 * ratios[0]);
}

}  // namespace
}  // namespace flexura
