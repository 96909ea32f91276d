#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/base/progress.h"
#include "flexura/calibrate/etalon_observer.h"
#include "flexura/experiment/run.h"
#include "flexura/log/results.h"
#include "flexura/store/text_file.h"
#include "flexura/tasks/calibrate/calibrate_results.h"
#include "flexura/vision/eight_bits.h"
#include "flexura/vision/etalon_finder.h"
#include "flexura/vision/picture_file.h"
#include "tests/support/calibration_bench.h"
#include "tests/support/calibration_files.h"
#include "tests/support/calibration_trials.h"
#include "tests/support/checkout.h"
#include "tests/support/loop_files.h"
#include "tests/support/quiet.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

double number_at(const Node& node, const char* key) { return *node.find(key)->as<double>(); }

TEST(CalibrateTaskFully, BringsTheExamplesWrongCamerasToOrthogonalAxesWithinTheirHeadsSteps) {
  const std::filesystem::path file = checkout_file("examples/05_calibration/experiment.toml");
  const TemporaryFolder folder, again;
  Quiet quiet;
  const RunResult result = run_experiment(load_experiment(file), folder.path(), quiet);
  ASSERT_EQ(result.outcome, RunOutcome::done) << result.reasons.front();
  const Node& calibration = result.summary.find("calibrations")->as<Node::Array>()->front();
  const double sigma = number_at(*calibration.find("sigma"), "angle");
  EXPECT_LT(sigma, 0.06 * degree);
  const Node &found = *calibration.find("remainder"), &truth = *calibration.find("remainder_in_truth");
  // Half a step of each axis of two heads, plus the remaining uncertainty.
  EXPECT_LT(std::abs(number_at(truth, "angle_from_square")), 0.1 * degree);
  EXPECT_LT(std::abs(number_at(truth, "angle_from_square") - number_at(found, "angle_from_square")),
            5 * sigma);
  EXPECT_NEAR(number_at(truth, "zoom_ratio"), 1, 0.01);
  // Equal bytes when repeated.
  (void)run_experiment(load_experiment(file), again.path(), quiet);
  for (const char* name : {"log.mcap", "summary.json", "rig.toml", "report.html"})
    EXPECT_EQ(read_text_file(folder.path() / name, 1U << 30), read_text_file(again.path() / name, 1U << 30))
        << name;
}

// Rough guesses with which markers are easily confused: of where the arm leaves the pictures, or in the first
// looks, all of one camera's shifted by one.
TEST(CalibrateTaskFully, IsNotMisledByMarkersThatOnePictureTakesForOthers) {
  for (const std::uint64_t seed : {7000036U, 7000053U}) {
    const testing::ScopedTrace trace(__FILE__, __LINE__, seed);
    TestRandom random(seed);
    const WrongRig wrong = wrong_rig(random);
    CalibrationBench bench(
        arcs_rig("method = \"bundle\"\n", arcs_cameras({wrong.front, wrong.side}), wrong.longer));
    RigPorts ports = bench.ports();
    WrongArm arm(*ports.arm, wrong.gains);
    ports.arm = &arm;
    const RigSessionResult result = bench.calibrate_bundle(ports);
    ASSERT_TRUE(result.is_done) << result.reason;
    const RigRemainder left = bench.truth(result.target);
    EXPECT_LT(std::abs(left.angle), 0.2 * degree);
    EXPECT_NEAR(left.zoom_ratio, 1, 0.005);
    for (const Eigen::Vector2d& aim : left.aim) EXPECT_LT(aim.norm(), 0.01);
  }
}

// With all errors of a guess together, including focal lengths off by a tenth.
TEST(CalibrateTaskFully, FindsFocalLengthsThatAreATenthOff) {
  for_random_cases(2, [](TestRandom& random) {
    WrongRig wrong = wrong_rig(random);
    for (WrongStart* start : {&wrong.front, &wrong.side})
      start->focal = random.integer(0, 1) == 1 ? 1.1 : 1 / 1.1;
    CalibrationBench bench(
        arcs_rig("method = \"bundle\"\n", arcs_cameras({wrong.front, wrong.side}), wrong.longer));
    RigPorts ports = bench.ports();
    WrongArm arm(*ports.arm, wrong.gains);
    ports.arm = &arm;
    const RigSessionResult result = bench.calibrate_bundle(ports);
    ASSERT_TRUE(result.is_done) << result.reason;
    const RigSigmas& sigmas = result.steps.back().sigmas;
    const RigModel truth = bench.true_model();
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LE(sigmas.focal[i], 0.005);
      EXPECT_LE(std::abs(std::log(result.found.model.cameras[i].lens.fx / truth.cameras[i].lens.fx)),
                4 * sigmas.focal[i]);
    }
    const RigRemainder left = bench.truth(result.target);
    EXPECT_LT(std::abs(left.angle), 0.2 * degree);
    EXPECT_NEAR(left.zoom_ratio, 1, 0.005);
  });
}

const std::string three_poses =
    "pose = [{ bends = [[0.5, 0], [0.5, 0], [0.5, 0]] }, { bends = [[0, 0.5], [0, 0.5], [0, 0.5]] }, "
    "{ bends = [[-0.6, 0.3], [0.7, 0.1], [0.5, -0.8]] }]\n";

// Records the stage commands of each camera, m.
class StageMoves : public NobodyWatches {
 public:
  void camera_sent(double, const RigStance& stance) override {
    places[stance.camera].insert(stance.stage.offset.x());
  }
  std::array<std::set<double>, 2> places;
};

// With the cylinder, from random starts of the study: principal points and zeros of heads are wrong as well.
TEST(CalibrateTaskFully, FindsWrongCamerasBeforeTheCylinder) {
  for (std::size_t start = 0; start < 2; ++start) {
    const CalibrationTrial trial = run_trial("bundle-etalon", 1, start);
    ASSERT_TRUE(trial.is_done) << trial.reason;
    EXPECT_LE(trial.pictures, 14);
    EXPECT_LE(std::abs(trial.angle), 0.1 * degree);
    EXPECT_LE(trial.aim, 0.005);
    EXPECT_LE(std::abs(trial.zoom), 0.002);
  }
}

// Compares measurements of the cylinder in pictures with its true position.
class TruePoints : public NobodyWatches {
 public:
  explicit TruePoints(const Experiment& experiment)
      : figure_(*experiment.stand.etalon),
        truth_(rig_model(experiment.arm.arm(), experiment.true_rig().cameras)) {}
  void seen(const CameraObservation& observed) override {
    if (!observed.seen.reason.empty()) return;
    const Image<std::uint8_t> picture = eight_bits(*observed.frame.picture, 255);
    const View view = view_of(truth_, observed.stance);
    for (const EtalonPoint& point :
         etalon_points(find_etalon(picture, gray_picture(picture)), figure_, view)) {
      const Eigen::Vector2d off = *view.project(*figure_.nearest(point, view)) - point.pixel;
      off_[point.part].push_back(
          point.part == EtalonPart::upper_rim || point.part == EtalonPart::lower_rim ? off.y() : off.x());
    }
  }
  // Mean and root mean square, px.
  [[nodiscard]] std::array<double, 2> off(EtalonPart part) const {
    double sum = 0, squares = 0;
    for (const double one : off_.at(part)) sum += one, squares += one * one;
    const auto count = static_cast<double>(off_.at(part).size());
    return {sum / count, std::sqrt(squares / count)};
  }

 private:
  EtalonFigure figure_;
  RigModel truth_;
  std::map<EtalonPart, std::vector<double>> off_;
};

// The second rig is higher, sees the upper end's face, and has its red lines off centre.
TEST(CalibrateTaskFully, SeesTheCylindersPartsWhereTheyAre) {
  for (const double up : {0.0, 0.35}) {
    LoopRig rig;
    for (auto& at : rig.at) at[1] += up;
    for (WrongStart& start : rig.wrong) start.zoom = 1;
    CalibrationBench bench(etalon_rig("method = \"bundle-etalon\"\n", rig));
    TruePoints points(bench.experiment());
    const RigSessionResult result = bench.calibrate_bundle(bench.ports(), points);
    EXPECT_TRUE(result.is_done) << result.reason;
    EXPECT_EQ(result.found.outliers.size(), 0U);
    for (const EtalonPart part : {EtalonPart::left_side, EtalonPart::right_side}) {
      EXPECT_LE(std::abs(points.off(part)[0]), 0.02) << up;
      EXPECT_LE(points.off(part)[1], 0.04) << up;
    }
    for (const EtalonPart part : {EtalonPart::upper_rim, EtalonPart::lower_rim, EtalonPart::red_line}) {
      EXPECT_LE(std::abs(points.off(part)[0]), 0.08) << static_cast<int>(part) << " " << up;
      EXPECT_LE(points.off(part)[1], 0.1) << static_cast<int>(part) << " " << up;
    }
  }
}

// Pushes a head before the move.
class PushesBeforeTheMove : public NobodyWatches {
 public:
  explicit PushesBeforeTheMove(SlippedPan& pan) : pan_(pan) {}
  void known(const RigStep& step) override {
    if (step.next.starts_with("the move")) pan_.push();
  }

 private:
  SlippedPan& pan_;
};

TEST(CalibrateTaskFully, StopsWhereTheCylinderIsSeenElsewhereAfterTheMove) {
  CalibrationBench bench(etalon_rig("method = \"bundle-etalon\"\n", {}));
  RigPorts ports = bench.ports();
  // By whole steps of the head.
  SlippedPan pan(*ports.cameras[0].head, 7 * 0.075 * degree, SlippedPan::Since::push);
  ports.cameras[0].head = &pan;
  PushesBeforeTheMove watcher(pan);
  const RigSessionResult result = bench.calibrate_bundle(ports, watcher);
  EXPECT_FALSE(result.is_done);
  EXPECT_NE(result.reason.find("from its predicted position"), std::string::npos) << result.reason;
  EXPECT_GT(result.verified[0], 4);  // Half a degree at 800 px is 7 px.
  CalibrationBench::expect_back(ports);
}

// The effect of backlash depends on the side from which heads arrive: affected pictures must be left out.
TEST(CalibrateTaskFully, EndsDoneOnlyWhereItIsRightWhenHeadsHavePlay) {
  int refused = 0;
  for (const double backlash : {0.2, 0.5, 1.0, 1.4}) {
    std::string file = etalon_rig("method = \"bundle-etalon\"\n", {});
    const std::string exact = "pan = { zero = 0 }";
    for (std::size_t at = file.find(exact); at != std::string::npos; at = file.find(exact, at + 1))
      file.replace(at, exact.size(), fmt::format("pan = {{ backlash_deg = {} }}", backlash));
    CalibrationBench bench(file);
    const RigSessionResult result = bench.calibrate_bundle(bench.ports());
    if (!result.is_done) {
      ++refused;
      continue;
    }
    const RigRemainder left = bench.truth(result.target);
    EXPECT_LT(std::abs(left.angle), 0.3 * degree) << backlash;
    for (const Eigen::Vector2d& aim : left.aim) EXPECT_LT(aim.norm(), 0.01) << backlash;
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, 4);
}

// Without stages, there are too few positions to determine a focal length to the required precision. The
// result must state its uncertainty.
TEST(CalibrateTaskFully, KnowsHowWellItKnowsCamerasBeforeTheCylinderWithoutStages) {
  LoopRig rig;
  rig.travel = 0;
  rig.wrong[0] = {.pan = 0.05, .tilt = -0.03, .cx = 8};
  rig.wrong[1] = {.pan = -0.04, .tilt = 0.04, .cy = -6};
  CalibrationBench bench(etalon_rig("method = \"bundle-etalon\"\nstages = false\n", rig));
  const RigSessionResult result = bench.calibrate_bundle(bench.ports());
  ASSERT_TRUE(result.is_done) << result.reason;
  EXPECT_LE(std::abs(bench.truth(result.target).angle), 4 * result.steps.back().sigmas.angle + 0.04 * degree);
  EXPECT_LE(result.steps.back().sigmas.angle, 0.3 * degree);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_LE(std::abs(result.found.model.cameras[i].lens.fx / 800 - 1),
              4 * result.steps.back().sigmas.focal[i] + 1e-3);
}

TEST(CalibrateTaskFully, TellsOfTheCylinderInSummaryAndReport) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "cylinder.toml";
  write_new_file(file, etalon_rig("method = \"bundle-etalon\"\nimages = 6\n", {}));
  Quiet quiet;
  const TemporaryFolder out;
  const RunResult result = run_experiment(load_experiment(file), out.path(), quiet);
  ASSERT_EQ(result.outcome, RunOutcome::done) << result.reasons.front();
  const Node& calibration = result.summary.find("calibrations")->as<Node::Array>()->front();
  EXPECT_GE(*calibration.find("etalon_points")->as<std::int64_t>(), 60);
  EXPECT_LE(std::abs(number_at(*calibration.find("remainder_in_truth"), "angle_from_square")), 0.2 * degree);
  const std::string report = read_text_file(result.folder / "report.html", 1 << 24);
  EXPECT_NE(report.find("points of its borders and red lines"), std::string::npos);
  EXPECT_NE(report.find("silhouette"), std::string::npos);
  EXPECT_NO_THROW((void)load_experiment(result.folder / "experiment.toml"));
}

TEST(CalibrateTaskFully, LeavesStagesAloneWhereItIsTold) {
  for (const bool may : {false, true}) {
    CalibrationBench bench(
        small_calibration(fmt::format("images = 6\nstages = {}\n", may) + three_poses,
                          "[[truth.camera]]\nname = \"side\"\nmount = { position = [-2.5, 0.5, 0], "
                          "look_at = [0, 0.5, 0.05] }\n"));
    StageMoves moves;
    const RigSessionResult result = bench.calibrate_bundle(bench.ports(), moves);
    EXPECT_TRUE(result.is_done) << result.reason;
    for (const std::set<double>& places : moves.places) {
      if (may) {
        EXPECT_GT(places.size(), 1U);
      } else {
        EXPECT_EQ(places, std::set<double>{0});
      }
    }
  }
}

TEST(CalibrateTaskFully, SavesARigBesideWhatIsNone) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "wrong.toml";
  const std::string text =
      small_calibration("images = 4\nsave = \"wrong.toml\"\n" + three_poses, wrong_cameras);
  write_new_file(file, text);
  Quiet quiet;
  for (const char* results : {"one", "two"}) {
    const RunResult result =
        run_experiment(load_experiment(file), make_new_folder(folder.path() / results), quiet);
    ASSERT_EQ(result.outcome, RunOutcome::done) << result.reasons.front();
  }
  EXPECT_EQ(read_text_file(file, 1 << 20), text) << "an experiment keeps its name";
  const std::string rig = read_text_file(folder.path() / "one" / rig_file_name, 1 << 20);
  EXPECT_EQ(read_text_file(folder.path() / "wrong-1.toml", 1 << 20), rig);
  EXPECT_EQ(read_text_file(folder.path() / "wrong-2.toml", 1 << 20), rig);
}

// A new rig must preserve the previous ones under other names, the oldest with the first number.
TEST(CalibrateTaskFully, KeepsOlderRigs) {
  const TemporaryFolder folder;
  Quiet quiet;
  std::vector<std::string> found;
  for (const int seed : {1, 2, 3}) {
    const std::filesystem::path file = folder.path() / fmt::format("seed{}.toml", seed);
    write_new_file(file,
                   fmt::format("seed = {}\n", seed) +
                       small_calibration("images = 4\nsave = \"rig.toml\"\n" + three_poses, wrong_cameras));
    const std::filesystem::path results = make_new_folder(folder.path() / fmt::format("out{}", seed));
    const RunResult result = run_experiment(load_experiment(file), results, quiet);
    ASSERT_EQ(result.outcome, RunOutcome::done) << result.reasons.front();
    found.push_back(read_text_file(results / rig_file_name, 1 << 20));
  }
  ASSERT_NE(found[0], found[1]);
  EXPECT_EQ(read_text_file(folder.path() / "rig-1.toml", 1 << 20), found[0]);
  EXPECT_EQ(read_text_file(folder.path() / "rig-2.toml", 1 << 20), found[1]);
  EXPECT_EQ(read_text_file(folder.path() / "rig.toml", 1 << 20), found[2]);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "rig-3.toml"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "rig.toml.new"));
}

// Declared backlash is expected: the axis positions get a prior of that size, so the angle is less certain.
TEST(CalibrateTaskFully, ExpectsThePlayThatHeadsAreKnownToHave) {
  std::array<double, 2> sigma{};
  for (const bool is_declared : {false, true}) {
    std::string file = small_calibration("images = 8\n" + three_poses, wrong_cameras);
    const std::string known = "pan = { limits_deg = [-90, 90],";
    for (std::size_t at = file.find(known); is_declared && at != std::string::npos;
         at = file.find(known, at + known.size()))
      file.insert(at + 8, "backlash_deg = 0.5, ");
    CalibrationBench bench(file);
    const RigSessionResult result = bench.calibrate_bundle(bench.ports());
    ASSERT_TRUE(result.is_done) << result.reason;
    sigma[is_declared ? 1 : 0] = result.steps.back().sigmas.angle;
    EXPECT_LT(std::abs(bench.truth(result.target).angle),
              3 * result.steps.back().sigmas.angle + 0.04 * degree);
  }
  EXPECT_GT(sigma[1], 1.5 * sigma[0]);
}

// Results less certain than required must be reported.
TEST(CalibrateTaskFully, TellsWhatItDoesNotKnowAsWellAsIsWanted) {
  CalibrationBench bench(small_calibration(
      "images = 4\nrequired_std = { angle_deg = 0.001, focal = 0.5 }\n" + three_poses, wrong_cameras));
  const RigSessionResult result = bench.calibrate_bundle(bench.ports());
  ASSERT_TRUE(result.is_done) << result.reason;
  const auto determines = [&](const std::string& part) {
    return std::ranges::any_of(result.desired.notes,
                               [&](const std::string& note) { return note.find(part) != std::string::npos; });
  };
  EXPECT_TRUE(determines("standard deviation of the angle between the axes"));
  EXPECT_TRUE(determines("degrees, required 0.001"));
  EXPECT_FALSE(determines("focal length"));
}

// White is visible to the left and to the right, but not above and below, and the printed method does not
// check that.
TEST(EtalonPaperLoopFully, IsNotDoneWhereTheBorderCutsTheCylinder) {
  LoopRig rig;
  rig.size = 0.5;
  CalibrationBench bench(etalon_rig("method = \"etalon-paper\"\n", rig, "radius = 0.1\nheight = 2.6\n"));
  const LoopResult result = bench.calibrate();
  EXPECT_FALSE(result.is_done);
  EXPECT_NE(result.reason.find("touches the border"), std::string::npos) << result.reason;
  bench.expect_back();
}

// From so near that it is cut off above and below: missing white on both sides does not prove a level camera.
TEST(EtalonPaperLoopFully, StopsWhereTheCylinderIsCutAboveAndBelow) {
  LoopRig rig;
  rig.size = 0.5, rig.wrong[0].shift = {0, 0, -0.88};
  CalibrationBench bench(etalon_rig("method = \"etalon-paper\"\n", rig));
  const LoopResult result = bench.calibrate();
  EXPECT_FALSE(result.is_done);
  EXPECT_NE(result.reason.find("touches the upper and the lower border"), std::string::npos) << result.reason;
  bench.expect_back();
}

// Starts from which one picture alone confuses markers. Formerly such calibrations ended degrees off, or lost
// the arm.
TEST(ArcsLoopFully, IsNotMisledByMarkersThatOnePictureTakesForOthers) {
  for (const std::size_t start : {0U, 20U, 850U}) {
    const testing::ScopedTrace trace(__FILE__, __LINE__, start);
    const CalibrationTrial trial = run_trial("arcs", 1, start);
    ASSERT_TRUE(trial.is_done) << trial.reason;
    EXPECT_LT(std::abs(trial.angle), 0.3 * degree);
    EXPECT_LT(trial.aim, 0.01);
    EXPECT_LT(std::abs(trial.zoom), 0.02);
  }
}

}  // namespace
}  // namespace flexura
