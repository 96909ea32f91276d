#include "flexura/rig/rehearsal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "flexura/equipment/wall_clock.h"
#include "flexura/model/backbone.h"
#include "flexura/rig/rig.h"
#include "tests/support/laboratory.h"
#include "tests/support/rehearsals.h"

namespace flexura {
namespace {

constexpr double longest_wait = 60;  // s; only a test that hangs needs it.

// Bends the arm, turns the head, and waits until both stand. Returns a picture taken since.
std::optional<Picture> picture_after_moves(const RigPorts& ports, const ArmState& state,
                                           const HeadState& head) {
  EXPECT_TRUE(ports.arm->command(state, 0.3));
  EXPECT_TRUE(ports.cameras[0].head->command(head));
  const double begun = ports.clock->now();
  bool is_moving = true;
  while (is_moving && ports.clock->now() < begun + longest_wait) {
    ports.clock->wait_until(ports.clock->now() + 0.02);
    is_moving = ports.arm->read().value().moving || ports.cameras[0].head->read().value().moving;
  }
  EXPECT_FALSE(is_moving);
  // Times of pictures may be wrong by the link's delay.
  const double stands = ports.clock->now() + 1;
  while (ports.clock->now() < stands + longest_wait) {
    const auto frame = ports.cameras[0].camera->wait(longest_wait);
    if (frame && frame.value() && frame.value()->time > stands) return *frame.value()->picture;
  }
  return std::nullopt;
}

// The same commands move a simulated rig, and the same rig behind its protocols. Both then stand at the same
// microsteps and counts, so the pictures are equal to the bit.
TEST(Rehearsal, ShowsThePicturesOfTheSimulatedRig) {
  if (!has_video_server()) GTEST_SKIP() << "built without a video server";
  Experiment experiment = parse_experiment(lab_file("/dev/ttyUSB0", 1), "lab.toml");
  experiment.camera[0].head.pan.resolution = experiment.camera[0].head.tilt.resolution = 0.001;
  experiment.camera[0].head.zoom.resolution = 9.0 / 0x4000;
  experiment.truth.emplace().camera = experiment.camera;
  experiment.truth->camera[0].lens.fx = 420;
  experiment.truth->camera[0].head.pan.zero = 0.02;
  Rehearsal rehearsal(experiment);
  ArmState state = ArmState::straight(1);
  state.bends[0] = {0.7, -0.4};
  const HeadState head{0.05, -0.03, 9.0 / 0x4000 * 2000};

  const Experiment in_laboratory = on_devices_of(rehearsal, experiment);
  const std::unique_ptr<Rig> real = rig_of(in_laboratory);
  EXPECT_EQ(real->truth(), nullptr);
  const auto seen = picture_after_moves(real->ports(), state, head);
  ASSERT_TRUE(seen);

  Experiment simulated = experiment;
  simulated.equipment.reset();
  const std::unique_ptr<Rig> rig = rig_of(simulated);
  const auto expected = picture_after_moves(rig->ports(), state, head);
  ASSERT_TRUE(expected);
  EXPECT_EQ(*seen, *expected);
  const Backbone bent = rehearsal.backbone();
  EXPECT_LT((bent.tip().position - rig->truth()->backbone(rig->ports().clock->now()).tip().position).norm(),
            1e-9);
  EXPECT_NEAR(rehearsal.stance(0).head.pan, head.pan, 1e-9);
  EXPECT_NEAR(rehearsal.stance(0).head.zoom, head.zoom, 1e-9);
  EXPECT_GT(rehearsal.pictures(0).sent, 0);
  EXPECT_EQ(rehearsal.failure(), "");
}

// The file's model of a head may be finer than the head's counts.
TEST(Rehearsal, HeadsOfTheModelStandAtCounts) {
  if (!has_video_server()) GTEST_SKIP() << "built without a video server";
  const Experiment experiment = parse_experiment(lab_file("/dev/ttyUSB0", 1), "lab.toml");
  EXPECT_EQ(experiment.cameras()[0].head.pan.resolution, 0);
  Rehearsal rehearsal(experiment);
  const Experiment in_laboratory = on_devices_of(rehearsal, experiment);
  const HeadConfig head = in_laboratory.cameras()[0].head;
  const ViscaConfig& device = in_laboratory.equipment->camera[0].visca.value();
  for (const double angle : {0.1234567, -0.3}) {
    const double pan = commandable(head.pan, angle);
    const ViscaCounts counts = visca_counts(device, {pan, 0, 1});
    EXPECT_NEAR(visca_state(device, counts).pan, pan, 1e-9);
  }
}

TEST(Rehearsal, NeedsADrive) {
  if (!has_video_server()) GTEST_SKIP() << "built without a video server";
  Experiment experiment = parse_experiment(lab_file("/dev/ttyUSB0", 1), "lab.toml");
  experiment.drive.reset();
  EXPECT_THROW(Rehearsal{experiment}, std::invalid_argument);
}

}  // namespace
}  // namespace flexura
