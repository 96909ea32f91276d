#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/experiment/messages.h"
#include "flexura/experiment/results.h"
#include "flexura/experiment/run.h"
#include "flexura/picture/image_file.h"
#include "flexura/store/json.h"
#include "flexura/store/mcap_reader.h"
#include "flexura/store/text_file.h"
#include "tests/support/experiment_files.h"
#include "tests/support/loop_files.h"
#include "tests/support/quiet.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// Tendons at three angles around each section, each on a spool of its own.
const char* const tendon_drive =
    "[drive]\nradius_mm = 14\ntendon = [\n"
    "{ section = 1, angle_deg = 0 }, { section = 1, angle_deg = 120 }, { section = 1, angle_deg = 240 },\n"
    "{ section = 2, angle_deg = 40 }, { section = 2, angle_deg = 160 }, { section = 2, angle_deg = 280 },\n"
    "{ section = 3, angle_deg = 80 }, { section = 3, angle_deg = 200 }, { section = 3, angle_deg = 320 }]\n"
    "[drive.motor]\nphases = 3\nsteps = 600\nmicrosteps = 10\nmax_speed_deg = 3600\n"
    "max_acceleration = 3000\nmax_step_rate = 100e3\n"
    "[drive.spool]\nradius_mm = 10\ngear = 10\nbacklash_deg = 0.1\n";

TEST(ArcsCalibration, LogsAndReportsItsArcsDriveCommandsAndIdealImages) {
  const LoopRig rig =
      arcs_cameras({WrongStart{.pan = 0.03, .tilt = 0.02}, WrongStart{.shift = {0, 0, 0.05}}}, true);
  const Experiment experiment =
      parse_experiment(tendon_drive + arcs_rig("method = \"arcs-paper\"\n", rig), "x.toml");
  const TemporaryFolder folder;
  Quiet quiet;
  const RunResult result = run_experiment(experiment, folder.path(), quiet);
  ASSERT_EQ(result.outcome, RunOutcome::done) << result.reasons.front();
  McapReader log(folder.path() / log_file_name);
  std::vector<CalibrationArcMessage> arcs;
  std::map<std::string, CalibrationSightingMessage> first;  // by camera
  std::map<std::string, Picture> ideal;                     // by topic
  std::vector<DriveCommandsMessage> commands;
  CalibrationDecisionMessage last;
  for (const McapMessage& message : log.messages()) {
    const std::string& topic = message.channel->topic;
    const auto node = [&] { return parse_json(message.text(), "log"); };
    if (topic == calibration_arcs_topic) arcs.push_back(read_as<CalibrationArcMessage>(node()));
    if (topic == drive_commands_topic) commands.push_back(read_as<DriveCommandsMessage>(node()));
    if (topic == calibration_decisions_topic) last = read_as<CalibrationDecisionMessage>(node());
    if (topic.starts_with("/calibration/ideal/"))
      ideal.emplace(topic, read_png(read_as<ImageMessage>(node()).data.data));
    if (topic != calibration_sightings_topic) continue;
    const auto sighting = read_as<CalibrationSightingMessage>(node());
    first.emplace(sighting.camera, sighting);
  }
  ASSERT_EQ(arcs.size(), 2U);
  EXPECT_EQ(arcs[0].camera + " " + arcs[0].plane, "front XOY");
  EXPECT_EQ(arcs[1].camera + " " + arcs[1].plane, "side ZOY");
  for (const CalibrationArcMessage& arc : arcs) {
    const CalibrationSightingMessage& sighting = first.at(arc.camera);
    double bend = 0;
    for (std::size_t i = 0; i < arc.bends.size(); ++i) {
      bend += std::hypot(arc.bends[i][0], arc.bends[i][1]);
      EXPECT_NEAR(std::atan2(arc.bends[i][1], arc.bends[i][0]), arc.rotations.at(i), 1e-12);
    }
    EXPECT_NEAR(bend, 2 * std::numbers::pi / 3, 1e-9);
    // What the motors were truly sent when the camera looked.
    const auto after = std::ranges::upper_bound(commands, sighting.time, {}, &DriveCommandsMessage::time);
    EXPECT_EQ(arc.positions, std::prev(after)->positions) << arc.camera;
    // The ideal axis lies along the ideal picture's arm, and in the real picture a circle is fitted.
    const auto& picture = std::get<Image<std::uint8_t>>(ideal.at(ideal_image_topic(arc.camera)));
    ASSERT_TRUE(sighting.ideal && sighting.circle);
    const auto& [u, v] = (*sighting.ideal)[sighting.ideal->size() / 2];
    EXPECT_LT(picture.at(static_cast<int>(std::lround(u)), static_cast<int>(std::lround(v))) + 50,
              picture.at(2, 2));
    EXPECT_NEAR(arc.focal / 2.5 / (2 * std::numbers::pi / 3), sighting.circle->radius, 20);
  }
  EXPECT_TRUE(last.ended.value_or(false));
  EXPECT_EQ(last.next, "calibrated");
  const std::string report = read_text_file(folder.path() / report_file_name, 1 << 26);
  for (const char* part : {"The arc in XOY, for camera front: sections bend by 42.00, 42.00, 36.00 deg, "
                           "rotated by 0.00, 0.00, 0.00 deg",
                           "; motors at ", "camera side, ideal: the arc in ZOY"})
    EXPECT_THAT(report, HasSubstr(part));
}

}  // namespace
}  // namespace flexura
