// The whole example of a rehearsal: cameras are calibrated with the arm, and a servo steers it, on the
// simulated rig and through the protocols of equipment.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "flexura/base/table.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/kinematics/shape.h"
#include "flexura/rig/rehearsal.h"
#include "flexura/tasks/calibrate/calibration_messages.h"
#include "tests/support/checkout.h"
#include "tests/support/quiet.h"
#include "tests/support/rehearsals.h"
#include "tests/support/runs.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

// A rig that calls a function at its end, when the arm stands where the run has left it.
class FarewellRig : public Rig {
 public:
  FarewellRig(std::unique_ptr<Rig> rig, std::function<void(Rig&)> at_the_end)
      : rig_(std::move(rig)), at_the_end_(std::move(at_the_end)) {}
  ~FarewellRig() override {
    const RigPorts ports = rig_->ports();
    constexpr double longest = 60;  // s
    const double until = ports.clock->now() + longest;
    for (auto arm = ports.arm->read(); arm && arm.value().moving && ports.clock->now() < until;
         arm = ports.arm->read())
      ports.clock->wait_until(ports.clock->now() + 0.05);
    at_the_end_(*rig_);
  }
  RigPorts ports() override { return rig_->ports(); }
  RigTruth* truth() override { return rig_->truth(); }
  [[nodiscard]] bool is_simulated() const override { return rig_->is_simulated(); }
  void play_to(double time, const ArmState& state, const TakeFrame& take) override {
    rig_->play_to(time, state, take);
  }
  void pass_to(double time, const ArmState& state) override { rig_->pass_to(time, state); }
  void skip_to_now() override { rig_->skip_to_now(); }

 private:
  std::unique_ptr<Rig> rig_;
  std::function<void(Rig&)> at_the_end_;
};

// The example without noise: then pictures of the same scene are equal, and so is all that follows from them.
Experiment quiet_example() {
  Experiment experiment =
      load_experiment(checkout_file("examples/17_rehearsal/experiment.toml"), {{"task.0.images=6"}, {}});
  for (std::vector<CameraConfig>* cameras : {&experiment.camera, &experiment.truth->camera})
    for (CameraConfig& camera : *cameras) camera.sensor.read_noise = 0;
  experiment.record.report = experiment.record.scene = false;
  return experiment;
}

// What came of a run.
struct Rehearsed {
  std::string text;  // Of the outcomes.
  RunOutcome outcome = RunOutcome::failed;
  std::vector<CalibrationObservationMessage> seen;
  double rms = 0;  // Distance of the true arm from the target along its length, share of the length.
};

double distance_from_target(const Experiment& experiment, const Backbone& arm) {
  const ShapeConfig& target = std::get<ServoTask>(experiment.task.back()).target.front();
  const Arm model = experiment.arm.arm();
  const Backbone desired(model, arm_state(model, target));
  constexpr int places = 50;
  double sum = 0;
  for (int i = 1; i <= places; ++i) {
    const double share = static_cast<double>(i) / places;
    sum += (arm.pose(share * arm.length()).position - desired.pose(share * desired.length()).position)
               .squaredNorm();
  }
  return std::sqrt(sum / places) / desired.length();
}

Rehearsed run(const Experiment& experiment, const std::function<Backbone(Rig&)>& true_arm) {
  const TemporaryFolder folder;
  Quiet quiet;
  Rehearsed result;
  const RunResult ran = run_experiment(
      experiment, make_new_folder(folder.path() / "results"), quiet, nullptr, [&](const Setup& setup) {
        return std::make_unique<FarewellRig>(
            rig_of(setup), [&](Rig& rig) { result.rms = distance_from_target(experiment, true_arm(rig)); });
      });
  result.outcome = ran.outcome;
  for (const TaskOutcome& outcome : ran.outcomes) result.text += outcome.line() + "\n";
  for (const std::string& reason : ran.reasons) result.text += reason + "\n";
  result.seen = logged<CalibrationObservationMessage>(ran, calibration_observations_topic);
  return result;
}

Rehearsed run_simulated(const Experiment& experiment) {
  Rehearsed result =
      run(experiment, [](Rig& rig) { return rig.truth()->backbone(rig.ports().clock->now()); });
  EXPECT_EQ(result.outcome, RunOutcome::done) << result.text;
  return result;
}

Rehearsed run_rehearsed(const Experiment& experiment, const VideoServerConfig& video) {
  Rehearsal rehearsal(experiment, video);
  Rehearsed result = run(on_devices_of(rehearsal, experiment), [&](Rig&) { return rehearsal.backbone(); });
  EXPECT_EQ(rehearsal.failure(), "");
  EXPECT_EQ(result.outcome, RunOutcome::done) << result.text;
  for (std::size_t i = 0; i < experiment.camera.size(); ++i)
    std::printf("%s: %ld pictures sent, %ld skipped\n", experiment.camera[i].name.c_str(),
                static_cast<long>(rehearsal.pictures(i).sent),
                static_cast<long>(rehearsal.pictures(i).skipped));
  return result;
}

// Equal but for rounding: devices report counts.
bool is_same(double a, double b) { return std::abs(a - b) < 1e-12; }

bool is_from_same_place(const CalibrationObservationMessage& one,
                        const CalibrationObservationMessage& other) {
  return one.camera == other.camera && is_same(one.pan, other.pan) && is_same(one.tilt, other.tilt) &&
         is_same(one.zoom, other.zoom) && one.bends == other.bends;
}

// Root mean square distance of the markers in the looks that both runs took from the same places, px. A busy
// machine may repeat a look.
double marker_distance(const Rehearsed& a, const Rehearsed& b, std::size_t& looks) {
  double sum = 0;
  std::size_t count = 0;
  looks = 0;
  for (const CalibrationObservationMessage& one : a.seen) {
    const auto other = std::ranges::find_if(
        b.seen, [&](const CalibrationObservationMessage& each) { return is_from_same_place(one, each); });
    if (other == b.seen.end()) continue;
    ++looks;
    for (const MarkerMessage& marker : one.markers)
      for (const MarkerMessage& same : other->markers)
        if (marker.s == same.s)
          sum += std::pow(marker.u - same.u, 2) + std::pow(marker.v - same.v, 2), ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : -1;
}

TEST(RehearsedExample, EqualsTheSimulatedRigUncompressed) {
  if (!has_video_server()) GTEST_SKIP() << "built without a video server";
  const Experiment experiment = quiet_example();
  const Rehearsed simulated = run_simulated(experiment);
  const Rehearsed raw = run_rehearsed(experiment, {});
  std::size_t looks = 0;
  const double distance = marker_distance(simulated, raw, looks);
  std::printf("simulated:\n%sraw:\n%s%zu of %zu pictures from the same places, markers %.2g px apart\n",
              simulated.text.c_str(), raw.text.c_str(), looks, raw.seen.size(), distance);
  std::printf("true arm off its target: simulated %.4f %%, raw %.4f %% of the length\n", 100 * simulated.rms,
              100 * raw.rms);
  // A calibration takes pictures at rest, so that the links' delay changes nothing: all is equal to the bit.
  EXPECT_EQ(looks, 12U);
  EXPECT_EQ(raw.seen.size(), 12U);
  EXPECT_EQ(distance, 0);
  EXPECT_THAT(simulated.text, ::testing::StartsWith(raw.text.substr(0, raw.text.find('\n'))));
  // Both servos have equal calibrations. The one through the links takes longer, and ends elsewhere within
  // the tolerance around the shape that looks like the target.
  constexpr double tolerance = 0.003;
  EXPECT_NEAR(raw.rms, simulated.rms, tolerance);
}

// Runs the example over compressed video. Its pictures differ, so that the runs part after some looks.
void expect_small_errors(VideoEncoding encoding, const char* name) {
  const Experiment experiment = quiet_example();
  const Rehearsed simulated = run_simulated(experiment);
  const Rehearsed compressed = run_rehearsed(experiment, {.encoding = encoding});
  std::size_t looks = 0;
  const double distance = marker_distance(simulated, compressed, looks);
  std::printf("simulated:\n%s%s:\n%s%zu of %zu pictures from the same places, markers %.2g px apart\n",
              simulated.text.c_str(), name, compressed.text.c_str(), looks, compressed.seen.size(), distance);
  std::printf("true arm off its target: simulated %.4f %%, %s %.4f %% of the length\n", 100 * simulated.rms,
              name, 100 * compressed.rms);
  // The first three looks of both cameras do not depend on pictures.
  EXPECT_GE(looks, 6U);
  EXPECT_GT(distance, 0);
  EXPECT_LT(distance, 2);
  EXPECT_LT(compressed.rms, 0.01);
}

TEST(RehearsedExample, HasTheErrorOfJpegPictures) {
  if (!has_video_server()) GTEST_SKIP() << "built without a video server";
  expect_small_errors(VideoEncoding::jpeg, "JPEG");
}

TEST(RehearsedExample, HasTheErrorOfH264Pictures) {
  if (!has_video_server()) GTEST_SKIP() << "built without a video server";
  expect_small_errors(VideoEncoding::h264, "H.264");
}

}  // namespace
}  // namespace flexura
