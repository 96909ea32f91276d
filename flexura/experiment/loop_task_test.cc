#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/tasks/calibrate/calibrate_results.h"
#include "flexura/tasks/calibrate/calibrate_run.h"
#include "tests/support/calibration_bench.h"
#include "tests/support/experiment_files.h"
#include "tests/support/loop_files.h"
#include "tests/support/runs.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// Returns a rig with pictures of half the size, which are rendered fast.
LoopRig small(const std::array<WrongStart, 2>& wrong, const std::string& sensor = "") {
  LoopRig rig;
  rig.wrong = wrong, rig.size = 0.5, rig.sensor = sensor;
  return rig;
}

TEST(EtalonLoop, SquaresTheAxesFromRandomStarts) {
  for_random_cases(1, [](TestRandom& random) {
    CalibrationBench bench(
        etalon_rig("method = \"etalon\"\n", {.wrong = {wrong_start(random), wrong_start(random)}}));
    const LoopResult result = bench.calibrate();
    ASSERT_TRUE(result.is_done) << result.reason;
    const RigRemainder left = bench.truth(result);
    // Half a step of the head, plus the uncertainty of the pictures.
    EXPECT_LT(std::abs(left.angle), 0.1 * degree);
    EXPECT_NEAR(left.angle, *result.angle, 0.07 * degree);
    EXPECT_NEAR(left.zoom_ratio, 1, 0.003);
    EXPECT_LT(left.aim[0].norm() + left.aim[1].norm(), 0.02);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(*result.roll[i], left.roll[i], 0.1 * degree);
      EXPECT_LE(result.pictures[i], 25U);
    }
  });
}

TEST(EtalonLoop, SeesPrincipalPointsByZooming) {
  const LoopRig rig = {.wrong = {WrongStart{.zoom = 1.5, .cx = 9, .cy = -7}, WrongStart{.cx = -8, .cy = 6}}};
  CalibrationBench bench(etalon_rig("method = \"etalon\"\n", rig));
  const LoopResult result = bench.calibrate();
  ASSERT_TRUE(result.is_done) << result.reason;
  const RigRemainder left = bench.truth(result);
  EXPECT_LT(std::abs(left.angle), 0.1 * degree) << "as the file has them they are 1.2 deg off";
  for (const Eigen::Vector2d& aim : left.aim) EXPECT_LT(aim.norm(), 0.003) << "with it 0.02 m";
  EXPECT_TRUE(result.notes.empty());
  EXPECT_LT((*result.principal_point[0] - Eigen::Vector2d(9, -7)).norm(), 0.3);
  EXPECT_LT((*result.principal_point[1] - Eigen::Vector2d(-8, 6)).norm(), 0.3);
}

// A distant principal point moves the cylinder out of the picture: half of the zoom is tried then.
TEST(EtalonLoop, ZoomsLessWhereThePrincipalPointIsFarOff) {
  const LoopRig rig = {.wrong = {WrongStart{.cx = 40, .cy = -40}, WrongStart{}}};
  CalibrationBench bench(etalon_rig("method = \"etalon\"\n", rig));
  const LoopResult result = bench.calibrate();
  ASSERT_TRUE(result.is_done) << result.reason;
  std::size_t looks = 0;
  for (const LoopDecision& decision : result.steps)
    looks += decision.camera == 0 && decision.next.starts_with("zoom to") ? 1 : 0;
  EXPECT_GE(looks, 2U);
  EXPECT_LT((*result.principal_point[0] - Eigen::Vector2d(40, -40)).norm(), 0.5);
  EXPECT_LT(std::abs(bench.truth(result).angle), 0.1 * degree);
}

TEST(EtalonLoop, SaysWhereNoLongerFocalLengthShowsAllOfTheCylinder) {
  CalibrationBench bench(etalon_rig("method = \"etalon\"\n", {}, "height = 0.75\n"));
  const LoopResult result = bench.calibrate();
  ASSERT_TRUE(result.is_done) << result.reason;
  ASSERT_EQ(result.notes.size(), 2U);
  EXPECT_THAT(result.notes[0], HasSubstr("front: the principal point of the file is used"));
  EXPECT_FALSE(result.principal_point[0]);
}

TEST(EtalonLoop, ReadsEachCameraByItsOwnBitDepth) {
  TestRandom random(1);
  std::string text = etalon_rig("method = \"etalon\"\n", small({wrong_start(random), wrong_start(random)}));
  const std::size_t side = text.find("sensor = {", text.find("name = \"side\""));
  ASSERT_NE(side, std::string::npos);
  text.insert(side + std::string("sensor = {").size(), " bits = 12,");
  CalibrationBench bench(text);
  const LoopResult result = bench.calibrate();
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_LT(std::abs(bench.truth(result).angle), 0.5 * degree);
}

TEST(EtalonLoop, StopsWhereBothCamerasLookFromOneSide) {
  LoopRig rig = small({WrongStart{}, WrongStart{}});
  rig.at[1] = {1.5, 0.5, 0.3};
  std::string text = etalon_rig("method = \"etalon\"\n", rig);
  // Beside the first one, with the same direction.
  for (std::size_t at = text.find("2.5, 0.5, 0.3"); at != std::string::npos; at = text.find("2.5, 0.5, 0.3"))
    text.replace(at, 13, "1.5, 0.5, -10");
  CalibrationBench bench(text);
  const LoopResult result = bench.calibrate();
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("both cameras look from one side"));
  bench.expect_back();
}

TEST(EtalonLoop, StopsWhereTheCylinderTouchesTheBorder) {
  CalibrationBench bench(etalon_rig("method = \"etalon\"\n", small({WrongStart{}, WrongStart{}}),
                                    "radius = 0.4\nheight = 1.2\n"));
  const LoopResult result = bench.calibrate();
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("cannot show the whole cylinder"));
  bench.expect_back();
}

TEST(EtalonLoop, StopsWhereAStageDoesNotReach) {
  LoopRig rig = small({WrongStart{.shift = {0.3, 0, 0}}, WrongStart{}});
  rig.travel = 0.1;
  CalibrationBench bench(etalon_rig("method = \"etalon\"\n", rig));
  const LoopResult result = bench.calibrate();
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("horizontal positioning of camera front: at the limit of its range"));
  bench.expect_back();
}

TEST(EtalonLoop, StopsWhereTooManyPicturesAreNeeded) {
  TestRandom random(5);
  CalibrationBench many(
      etalon_rig("method = \"etalon\"\nimages = 3\n", small({wrong_start(random), wrong_start(random)})));
  EXPECT_THAT(many.calibrate().reason, HasSubstr("the limit of 3 pictures of camera front is reached"));
  many.expect_back();
}

TEST(EtalonLoop, LeavesALogASummaryAndAReportTheSameEachTime) {
  TestRandom random(7);
  const std::string text = etalon_rig("method = \"etalon\"\nname = \"cylinder\"\n",
                                      small({wrong_start(random, 0.3), wrong_start(random, 0.3)}));
  const Experiment experiment = parse_experiment(text, "x.toml");
  Runs runs;
  const RunResult result = runs.run(experiment);
  ASSERT_EQ(result.outcome, RunOutcome::done) << result.reasons.front();
  const Node& calibration = entry_of(result, "calibrations");
  EXPECT_TRUE(*calibration.find("done")->as<bool>());
  EXPECT_NE(calibration.find("remainder_in_truth"), nullptr);
  auto counts = logged_counts(result);
  const auto& pictures = *calibration.find("pictures")->as<Node::Array>();
  EXPECT_EQ(counts["/calibration/observations"],
            static_cast<std::size_t>(*pictures[0].as<std::int64_t>() + *pictures[1].as<std::int64_t>()));
  EXPECT_EQ(counts["/calibration/decisions"], calibration.find("steps")->as<Node::Array>()->size() + 1)
      << "the last one says how it ended";
  EXPECT_GE(counts["/calibration/moves"], 4U);
  EXPECT_THAT(text_of(result, report_file_name), HasSubstr("Calibration: cylinder"));
  const Experiment found = load_experiment(result.folder / rig_file_name);
  EXPECT_NE(found.cameras()[0].initial.pan, 0);
  const auto& seen = *calibration.find("principal_point_off_as_seen")->as<Node::Array>();
  EXPECT_DOUBLE_EQ(*found.cameras()[1].lens.cy, 119.5 + *seen[1].as<Node::Array>()->at(1).as<double>());
  EXPECT_EQ(files_in(runs.run(experiment).folder), files_in(result.folder));
}

// The printed method has no bearing and needs equally large cylinders; then all procedures must stop where
// they should.
TEST(EtalonPaperLoop, CentresTheCylinderWhereNothingElseIsWrong) {
  const WrongStart front{.pan = 0.05, .tilt = -0.03}, side{.pan = -0.04, .tilt = 0.05};
  CalibrationBench bench(etalon_rig("method = \"etalon-paper\"\n", small({front, side})));
  const LoopResult result = bench.calibrate();
  ASSERT_TRUE(result.is_done) << result.reason;
  const RigRemainder left = bench.truth(result);
  // The whites on the left and right differ by 3 px: 1.5 px, or 0.11 deg, for a camera that turns by 0.2.
  EXPECT_LT(std::abs(left.angle), 0.5 * degree);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_LT(left.aim[i].norm(), 0.02);
  EXPECT_FALSE(result.notes.empty());
}

TEST(EtalonPaperLoop, DoesNotSeeThatACameraStandsBesideTheLine) {
  const WrongStart front{.pan = 0.03, .shift = {0.05, 0, 0}};
  CalibrationBench bench(etalon_rig("method = \"etalon-paper\"\n", small({front, WrongStart{}})));
  const LoopResult result = bench.calibrate();
  ASSERT_TRUE(result.is_done) << result.reason;
  // 0.05 m at 1.5 m.
  EXPECT_NEAR(std::abs(bench.truth(result).angle), 1.91 * degree, 0.5 * degree);
}

TEST(EtalonPaperLoop, StopsWhereTwoAxesShowForEver) {
  const WrongStart front{.pan = 0.26, .shift = {0.4, 0, 0}};
  CalibrationBench bench(etalon_rig("method = \"etalon-paper\"\nloop.slide = 0.04\nloop.accepted = 25\n",
                                    small({front, WrongStart{}})));
  const LoopResult result = bench.calibrate();
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("two red axes"));
  bench.expect_back();
}

TEST(EtalonPaperLoop, StopsWhereTheZoomRunsAway) {
  const WrongStart front{.shift = {0, 0, -0.15}};
  CalibrationBench bench(etalon_rig("method = \"etalon-paper\"\n", small({front, WrongStart{}})));
  const LoopResult result = bench.calibrate();
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("zoom diverges: "));
  EXPECT_LT(result.pictures[0], 60U);
  bench.expect_back();
}

TEST(EtalonPaperLoop, StopsWhereItsStepIsTooLargeToStop) {
  const WrongStart front{.pan = 0.0436};  // Two and a half steps.
  CalibrationBench bench(etalon_rig("method = \"etalon-paper\"\nloop.accepted = 1\nloop.turn_deg = 1\n",
                                    small({front, WrongStart{}})));
  const LoopResult result = bench.calibrate();
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("horizontal orientation of camera front oscillates"));
  bench.expect_back();
}

TEST(ArcsLoop, SquaresTheAxesFromARandomStart) {
  for_random_cases(1, [](TestRandom& random) {
    const LoopRig rig = arcs_cameras({wrong_start(random), wrong_start(random)});
    CalibrationBench bench(arcs_rig("method = \"arcs\"\n", rig, {0.003, -0.003, 0.004}));
    RigPorts ports = bench.ports();
    WrongArm arm(*ports.arm, {1.006, 0.995, 1.008});
    ports.arm = &arm;
    const LoopResult result = bench.calibrate(ports);
    ASSERT_TRUE(result.is_done) << result.reason;
    const RigRemainder left = bench.truth(result);
    EXPECT_LT(std::abs(left.angle), 0.1 * degree);
    EXPECT_NEAR(left.angle, *result.angle, 0.1 * degree);
    EXPECT_NEAR(left.zoom_ratio, 1, 0.01);
    // Both lenses zoom and give their principal points. The precision of zooms by correlation must be
    // reported for each.
    const auto is_of_zoom = [](const std::string& note) { return note.starts_with("zoom of camera"); };
    EXPECT_EQ(result.notes.size(),
              1U + static_cast<std::size_t>(std::ranges::count_if(result.notes, is_of_zoom)));
    for (std::size_t i = 0; i < 2; ++i) {
      ASSERT_TRUE(result.principal_point[i]);
      const Eigen::Vector2d off(rig.wrong[i].cx, rig.wrong[i].cy);
      EXPECT_LT((*result.principal_point[i] - off).norm(), 1);
      EXPECT_LT(left.aim[i].norm(), 0.02);
      EXPECT_NEAR(*result.roll[i], left.roll[i], 0.3 * degree);
    }
  });
}

// A small slip can be compensated by more pictures from the head's new position.
TEST(ArcsLoop, EndsDoneOnlyWhereItIsRightWhenAHeadSlips) {
  for (const double slip : {0.8 * degree, 4 * degree}) {
    const LoopRig rig = arcs_cameras({WrongStart{.pan = 0.08}, WrongStart{.tilt = 0.05}});
    CalibrationBench bench(arcs_rig("method = \"arcs\"\n", rig));
    RigPorts ports = bench.ports();
    SlippedPan slipped(*ports.cameras[0].head, slip);
    ports.cameras[0].head = &slipped;
    const LoopResult result = bench.calibrate(ports);
    if (result.is_done) {
      EXPECT_LT(std::abs(bench.truth(result).angle), 0.5 * degree) << slip;
      EXPECT_LT(slip, degree);
    } else {
      EXPECT_THAT(result.reason, ::testing::AnyOf(HasSubstr("contradict the earlier ones"),
                                                  HasSubstr("the estimate does not explain"),
                                                  HasSubstr("no poses of the two cameras explain")));
    }
  }
}

// If zooms have to be closer than correlation can measure, this must be reported, and success not claimed.
TEST(ArcsLoop, TellsWhereZoomsAreNotAsCloseAsIsAccepted) {
  CalibrationBench bench(arcs_rig("method = \"arcs\"\nloop = { zoom_accepted = 1e-9 }\n",
                                  arcs_cameras({WrongStart{.pan = 0.01}, WrongStart{}})));
  const LoopResult result = bench.calibrate();
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_THAT(result.notes, ::testing::Contains(HasSubstr("zoom of camera front:")));
  EXPECT_THAT(result.notes, ::testing::Contains(HasSubstr("stopped after 3 observations")));
}

TEST(ArcsLoop, StopsWhereAStageDoesNotReach) {
  LoopRig rig = arcs_cameras({WrongStart{.shift = {0.3, 0, 0}}, WrongStart{}});
  rig.travel = 0.1;
  CalibrationBench bench(arcs_rig("method = \"arcs\"\n", rig));
  const LoopResult result = bench.calibrate();
  EXPECT_FALSE(result.is_done);
  EXPECT_THAT(result.reason, HasSubstr("camera front: at the limit of its range"));
  bench.expect_back();
}

TEST(ArcsPaperLoop, StopsAtACircleWhereverItLooksAndSaysWhatThatIsWorth) {
  const LoopRig rig =
      arcs_cameras({WrongStart{.pan = 0.03, .tilt = 0.02}, WrongStart{.shift = {0, 0, 0.05}}}, true);
  CalibrationBench bench(arcs_rig("method = \"arcs-paper\"\n", rig));
  const LoopResult result = bench.calibrate();
  ASSERT_TRUE(result.is_done) << result.reason;
  ASSERT_EQ(result.notes.size(), 2U);
  EXPECT_THAT(result.notes[0], HasSubstr("the circle's equation is verified. This proves only a tilt below"));
  EXPECT_NEAR(bench.truth(result).zoom_ratio, 1, 0.05);
}

// Returns the error of a file, without its place.
std::string problem_of(const std::string& text) {
  const std::string reported = error_of_file(text);
  return reported.substr(reported.find(": ") + 2);
}

TEST(EtalonLoop, RefusesWhatItCannotDo) {
  std::string text = etalon_rig("method = \"etalon\"\n", LoopRig{.size = 0.5});
  EXPECT_THAT(error_of_file(text + "[[task]]\nkind = \"calibrate\"\nmethod = \"etalons\"\n"),
              HasSubstr("etalons"));
  std::string with_arm = text;
  with_arm.replace(with_arm.find("arm = false"), 11, "arm = true ");
  EXPECT_THAT(error_of_file(with_arm), HasSubstr("expected stand.arm = false"));
  EXPECT_THAT(error_of_file(
                  etalon_rig("method = \"etalon\"\n", LoopRig{.size = 0.5}, "rotation = [0.8, 0.6, 0, 0]\n")),
              HasSubstr("needs an upright cylinder"));
  EXPECT_THAT(
      error_of_file(
          "[arm]\n[[arm.section]]\nlength = 1\n[[task]]\nkind = \"calibrate\"\nmethod = \"etalon\"\n"),
      HasSubstr("expected [stand.etalon]"));
  const LoopRig rig = {.size = 0.5};
  EXPECT_EQ(problem_of(etalon_rig("method = \"bundle-etalon\"\narm_prior.response_std = 0.1\n", rig)),
            "task[0].arm_prior: this key applies only to the method bundle: expected no such key");
  EXPECT_EQ(problem_of(etalon_rig("method = \"etalon\"\ncamera_prior.rotation_std_deg = 5\n", rig)),
            "task[0].camera_prior: this key applies only to the methods bundle, bundle-etalon and arcs: "
            "expected no "
            "such key");
  EXPECT_EQ(
      problem_of(etalon_rig("method = \"etalon\"\nrequired_std.angle_deg = 1\n", rig)),
      "task[0].required_std: this key applies only to the methods bundle and bundle-etalon: expected no "
      "such key");
  EXPECT_EQ(problem_of(etalon_rig("method = \"bundle-etalon\"\npose = [{ bends = [[0.1, 0]] }]\n", rig)),
            "task[0]: this method uses neither poses nor zooms: expected neither key pose nor key zooms");
  EXPECT_EQ(problem_of(etalon_rig("method = \"bundle-etalon\"\nloop.turn_deg = 1\n", rig)),
            "task[0].loop: this key applies only to the paper's methods: expected no such key");
  EXPECT_EQ(
      error_of_file(etalon_rig("method = \"bundle-etalon\"\nstages = false\nrequired_std.angle_deg = 1\n"
                               "target = [0, 0.4, 0]\ncamera_prior.zero_std_deg = 1\n",
                               rig)),
      "no error");
}

}  // namespace
}  // namespace flexura
