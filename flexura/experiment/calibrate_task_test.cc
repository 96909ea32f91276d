#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/base/table.h"
#include "flexura/calibrate/rig_session_plan.h"
#include "flexura/rig/photographer.h"
#include "flexura/sim/simulated_rig.h"
#include "flexura/tasks/calibrate/calibrate_results.h"
#include "flexura/tasks/calibrate/calibrate_run.h"
#include "tests/support/calibration_bench.h"
#include "tests/support/calibration_files.h"
#include "tests/support/experiment_files.h"
#include "tests/support/runs.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

const std::string three_poses =
    "pose = [{ bends = [[0.5, 0], [0.5, 0], [0.5, 0]] }, { bends = [[0, 0.5], [0, 0.5], [0, 0.5]] }, "
    "{ bends = [[-0.6, 0.3], [0.7, 0.1], [0.5, -0.8]] }]\n";

TEST(CalibrateTask, FindsARigThatIsWrongInEveryWayAndSquaresItsAxes) {
  CalibrationBench bench(small_calibration("images = 6\n" + three_poses, wrong_cameras));
  const RigSessionResult result = bench.calibrate_bundle(bench.ports());
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_EQ(result.looks, 6U);
  EXPECT_LT(std::abs(result.remainder.angle), 0.005);
  EXPECT_NEAR(result.remainder.zoom_ratio, 1, 0.01);
  EXPECT_NEAR(result.found.model.cameras[0].lens.fx, 424, 8);
  EXPECT_NEAR(result.found.model.cameras[1].lens.fx, 380, 8);
  EXPECT_LT(result.steps.back().sigmas.angle, result.steps.front().sigmas.angle);
}

// Returns the true cameras of small_calibration with `head` for both.
std::string both_heads(const std::string& head) {
  return fmt::format(
      "[[truth.camera]]\nname = \"front\"\nhead = {0}\n[[truth.camera]]\nname = \"side\"\nhead = {0}\n",
      head);
}

TEST(CalibrateTask, FindsZerosOfHeadsThatStagesTellFromTurnedMounts) {
  CalibrationBench bench(small_calibration(
      "images = 8\n" + three_poses, both_heads("{ pan = { zero_deg = 2.5 }, tilt = { zero_deg = -2 } }")));
  const RigSessionResult result = bench.calibrate_bundle(bench.ports());
  ASSERT_TRUE(result.is_done) << result.reason;
  const double sigma = result.steps.back().sigmas.angle;
  EXPECT_LT(sigma, 0.005);
  EXPECT_LT(std::abs(bench.truth(result.target).angle), 4 * sigma);
}

TEST(CalibrateTask, StopsWhereTheMoveEndsElsewhereThanPredicted) {
  CalibrationBench bench(small_calibration(
      "images = 8\n" + three_poses, both_heads("{ pan = { backlash_deg = 3 }, tilt = { zero_deg = 0 } }")));
  const RigSessionResult result = bench.calibrate_bundle(bench.ports());
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("from its predicted position, "));
  bench.expect_back();
}

TEST(CalibrateTask, StopsWhereAHeadEndsBeforeTheAxesAreOrthogonal) {
  std::string file = small_calibration("images = 8\nstages = false\n" + three_poses,
                                       "[[truth.camera]]\nname = \"front\"\nmount = { position = [0.25, 0.5, "
                                       "2.5], look_at = [0.6, 0.5, 0] }\n");
  const std::string wide = "limits_deg = [-90, 90]";
  for (std::size_t at = file.find(wide); at != std::string::npos; at = file.find(wide, at + 1))
    file.replace(at, wide.size(), "limits_deg = [-1.5, 1.5]");
  CalibrationBench bench(file);
  const RigSessionResult result = bench.calibrate_bundle(bench.ports());
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason,
              HasSubstr("at the limits of heads and stages, the angle between the axes would"));
  EXPECT_THAT(result.reason, HasSubstr("pan ends at"));
}

TEST(CalibrateTask, StopsWhereTheArmIsOutOfView) {
  CalibrationBench bench(
      small_calibration("images = 5\n" + three_poses,
                        "[[truth.camera]]\nname = \"side\"\nmount = { position = [-2.5, 0.5, 0], look_at = "
                        "[-2.5, 0.5, 3] }\n"));
  const RigSessionResult result = bench.calibrate_bundle(bench.ports());
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("the arm is out of view of camera side"));
  EXPECT_THAT(result.reason, HasSubstr("have returned to the start"));
  bench.expect_back();
}

// Counts pictures of the search for the arm, and records where cameras missed it.
class SeenLooks : public NobodyWatches {
 public:
  void seen(const CameraObservation& observed) override {
    if (observed.look == 0) ++searches;
    if (observed.look > 0 && !observed.seen.reason.empty())
      missed.push_back({observed.pose, {observed.stance}});
  }
  int searches = 0;
  std::vector<ViewCandidate> missed;
};

// Returns a file with a side camera that truly looks beside the arm, by `aside` m at its distance of 2.5 m.
std::string looking_beside(double aside, const std::string& poses) {
  return small_calibration(
      "images = 6\n" + poses,
      fmt::format("[[truth.camera]]\nname = \"side\"\nmount = {{ position = [-2.5, 0.5, 0], "
                  "look_at = [0, 0.5, {}] }}\n",
                  aside));
}

TEST(CalibrateTask, SearchesForAnArmThatItDoesNotSeeAtFirst) {
  CalibrationBench bench(looking_beside(1.15, three_poses));
  SeenLooks looks;
  const RigSessionResult result = bench.calibrate_bundle(bench.ports(), looks);
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_GT(looks.searches, 0);
  EXPECT_LT(std::abs(bench.truth(result.target).angle), 0.01);
}

// Visible in the first pose, and bent out of view in the following ones.
TEST(CalibrateTask, SearchesForAnArmThatBendsOutOfViewBeforeAnythingIsKnown) {
  CalibrationBench bench(looking_beside(
      0.8,
      "pose = [{ bends = [[0, -0.5], [0, -0.5], [0, -0.5]] }, { bends = [[0, 0.5], [0, 0.5], [0, 0.5]] }, "
      "{ bends = [[-0.6, 0.7], [0.7, 0.6], [0.5, 0.8]] }]\n"));
  SeenLooks looks;
  const RigSessionResult result = bench.calibrate_bundle(bench.ports(), looks);
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_GT(looks.searches, 0);
  EXPECT_FALSE(looks.missed.empty());
  EXPECT_LT(std::abs(bench.truth(result.target).angle), 0.01);
}

// The camera's pictures are empty when it zooms in.
TEST(CalibrateTask, DoesNotLookAgainFromWhereACameraSawNothing) {
  CalibrationBench bench(small_calibration("images = 9\n" + three_poses, wrong_cameras));
  RigPorts ports = bench.ports();
  AlteredCamera blind(*ports.cameras[1].camera, [&head = *ports.cameras[1].head](Frame frame) {
    if (head.read().value().state.zoom < 1.5) return frame;
    const auto& seen = std::get<Image<std::uint8_t>>(*frame.picture);
    frame.picture = std::make_shared<const Picture>(
        Image<std::uint8_t>(seen.width(), seen.height(), seen.channels(), 200));
    return frame;
  });
  ports.cameras[1].camera = &blind;
  SeenLooks looks;
  const RigSessionResult result = bench.calibrate_bundle(ports, looks);
  EXPECT_FALSE(looks.missed.empty());
  const RigModel nominal = rig_model(bench.experiment().arm.arm(), bench.experiment().cameras());
  for (std::size_t i = 0; i < looks.missed.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_FALSE(is_like(nominal, looks.missed[i], looks.missed[j])) << i << " and " << j;
  if (!result.is_done) {
    EXPECT_THAT(result.reason, HasSubstr("does not see the arm in 3 successive pictures"));
  }
}

TEST(CalibrateTask, StopsWhereBothCamerasLookFromOneSide) {
  std::string text = small_calibration("images = 5\n" + three_poses, "");
  const std::string side = "position = [-2.5, 0.5, 0]";
  text.replace(text.find(side), side.size(), "position = [-0.4, 0.5, 2.47]");
  CalibrationBench bench(text);
  const RigSessionResult result = bench.calibrate_bundle(bench.ports());
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("both cameras look from one side"));
  EXPECT_THAT(result.reason, HasSubstr("have returned to the start"));
  bench.expect_back();
}

// Stages with a little more travel leave a larger angle between the lines of sight. For the rest, the heads
// would turn away from the arm.
TEST(CalibrateTask, StopsWhereOrthogonalAxesPassBesideTheArm) {
  std::string text = small_calibration("images = 5\n" + three_poses, "");
  const std::string side = "position = [-2.5, 0.5, 0]", stage = "limits = [-0.5, 0.5]";
  text.replace(text.find(side), side.size(), "position = [-1.25, 0.5, 2.165]");
  for (std::size_t at = text.find(stage); at != std::string::npos; at = text.find(stage))
    text.replace(at, stage.size(), "limits = [-0.6, 0.6]");
  CalibrationBench bench(text);
  const RigSessionResult result = bench.calibrate_bundle(bench.ports());
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("m from the arm"));
  EXPECT_THAT(result.reason, HasSubstr("have returned to the start"));
  bench.expect_back();
}

// One straight pose.
TEST(CalibrateTask, StopsWhereThePicturesDoNotTellTheAngle) {
  CalibrationBench bench(
      small_calibration("images = 3\npose = [{ bends = [[0, 0], [0, 0], [0, 0]] }]\n", wrong_cameras));
  const RigSessionResult result = bench.calibrate_bundle(bench.ports());
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("the standard deviation of the angle between the axes is still"));
  bench.expect_back();
}

TEST(CalibrateTask, StopsWhereAHeadDoesNotFollow) {
  CalibrationBench bench(small_calibration("images = 5\n" + three_poses, ""));
  RigPorts ports = bench.ports();
  StuckPan stuck(*ports.cameras[1].head);
  ports.cameras[1].head = &stuck;
  const RigSessionResult result = bench.calibrate_bundle(ports);
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("the head of camera side does not follow: pan was commanded to"));
  bench.expect_back();
}

TEST(CalibrateTask, StopsWhereNoFrameComes) {
  CalibrationBench bench(
      small_calibration("images = 5\nframe_timeout = 1\n" + three_poses, "", ", drop = 1"));
  const RigSessionResult result = bench.calibrate_bundle(bench.ports());
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("camera front sent no frame for 1 s"));
  bench.expect_back();
}

TEST(CalibrateTask, StopsWhereALinkIsLost) {
  CalibrationBench bench(small_calibration("images = 5\n" + three_poses, ""));
  bench.rig().camera(0).camera().link().lose(3, 1e6);
  const RigSessionResult result = bench.calibrate_bundle(bench.ports());
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("link lost: camera front does not answer"));
  bench.expect_back();
}

TEST(CalibrateTask, WaitsForAnotherFrameWhereSomeAreLost) {
  CalibrationBench all(small_calibration("images = 4\n" + three_poses, wrong_cameras));
  CalibrationBench some(small_calibration("images = 4\n" + three_poses, wrong_cameras, ", drop = 0.6"));
  const RigSessionResult one = all.calibrate_bundle(all.ports()), other = some.calibrate_bundle(some.ports());
  ASSERT_TRUE(one.is_done) << one.reason;
  ASSERT_TRUE(other.is_done) << other.reason;
  EXPECT_EQ(one.looks, other.looks);
  EXPECT_GT(some.rig().clock().now(), all.rig().clock().now());
}

// Records the cameras that a watcher receives.
class LastCameras : public RunWatcher {
 public:
  void state(double, const ArmState&, std::span<const CameraReading> cameras) override {
    cameras_.assign(cameras.begin(), cameras.end());
    if (!cameras_.empty()) pans_.insert(cameras_.front().head.pan);
  }
  [[nodiscard]] const std::vector<CameraReading>& cameras() const { return cameras_; }
  [[nodiscard]] const std::set<double>& pans() const { return pans_; }

 private:
  std::vector<CameraReading> cameras_;
  std::set<double> pans_;
};

TEST(CalibrateTask, LeavesALogASummaryAReportAndARigToInclude) {
  Runs runs;
  LastCameras seen;
  const RunResult result = runs.run(
      parse_experiment(small_calibration("name = \"look\"\nimages = 4\n" + three_poses, wrong_cameras) +
                           "\n[[task]]\nkind = \"hold\"\nduration = 0.5\n[record]\ncameras = true\n",
                       "x.toml"),
      &seen);
  ASSERT_EQ(result.outcome, RunOutcome::done) << result.reasons.front();
  const Node& calibration = entry_of(result, "calibrations");
  EXPECT_TRUE(*calibration.find("done")->as<bool>());
  EXPECT_LT(std::abs(*calibration.find("remainder")->find("angle_from_square")->as<double>()), 0.1);
  const auto angle = [&](const char* key) {
    return *calibration.find(key)->find("angle_from_square")->as<double>();
  };
  EXPECT_NEAR(*calibration.find("error_over_sigma")->find("angle")->as<double>() *
                  *calibration.find("sigma")->find("angle")->as<double>(),
              angle("remainder") - angle("remainder_in_truth"), 1e-12);

  auto counts = logged_counts(result);
  const auto heads = logged<HeadReadingMessage>(result, "/head/front");
  const auto stages = logged<StageReadingMessage>(result, "/stage/front");
  const auto states = logged<ArmStateMessage>(result, arm_state_topic);
  EXPECT_TRUE(std::ranges::is_sorted(states, {}, &ArmStateMessage::time));
  EXPECT_GT(counts["/calibration/moves"], 6U);
  EXPECT_EQ(counts["/calibration/observations"], 8U);
  EXPECT_EQ(counts["/calibration/decisions"], 3U);
  EXPECT_GE(counts["/camera/front"], 4U);
  EXPECT_NEAR(states.back().time, *result.summary.find("duration")->as<double>(), 1e-6);

  // Watcher and log have the cameras' final axis positions.
  ASSERT_EQ(seen.cameras().size(), 2U);
  EXPECT_NE(seen.cameras()[0].head.pan, 0);
  EXPECT_GT(seen.pans().size(), 2U);
  EXPECT_EQ(heads.back().pan, seen.cameras()[0].head.pan);
  EXPECT_EQ(Eigen::Vector3d(stages.back().offset.data()), seen.cameras()[0].stage.offset);
  EXPECT_EQ(stages.size(), heads.size());
  EXPECT_EQ(std::ranges::adjacent_find(heads, {}, &HeadReadingMessage::time), heads.end())
      << "once for each time";

  // The calibrated rig is an experiment's arm and cameras, with initial positions where they were sent.
  const Experiment found = load_experiment(result.folder / rig_file_name);
  EXPECT_EQ(found.cameras().size(), 2U);
  EXPECT_NEAR(found.cameras()[0].lens.fx, 424, 12);
  EXPECT_NE(found.cameras()[0].initial.pan, 0);
  EXPECT_THAT(text_of(result, report_file_name), HasSubstr("Calibration: look"));
}

TEST(CalibrateTask, RefusesWhatItCannotDo) {
  EXPECT_THAT(error_of_file(small_calibration("cameras = [\"front\", \"back\"]\n", "")),
              HasSubstr("there is no camera \"back\""));
  EXPECT_THAT(error_of_file(small_calibration("cameras = [\"front\", \"front\"]\n", "")),
              HasSubstr("expected two"));
  EXPECT_THAT(error_of_file(small_calibration("save = \"../rig.toml\"\n", "")),
              HasSubstr("expected a file name"));
  EXPECT_THAT(error_of_file("[arm]\n[[arm.section]]\nlength = 1\n[[task]]\nkind = \"calibrate\"\n"),
              HasSubstr("needs at least 4 markers"));
}

}  // namespace
}  // namespace flexura
