#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/experiment/drive_commands.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/recorder.h"
#include "flexura/experiment/scene_log.h"
#include "flexura/experiment/schedule.h"
#include "flexura/port/rig_ports.h"
#include "flexura/report/report.h"

namespace flexura {

class RunWatcher;

/// Everything that a run leaves behind while it plays: the log, and what the report will show.
class Witness {
 public:
  /// `watcher` is told what happens and what calibrations and servos do; may be null.
  Witness(const std::filesystem::path& folder, const ArmModel& model, RunWatcher* watcher = nullptr);

  /// Which step of the clock is the last one, as far as it is known: a task may take its own time.
  void expect(std::size_t last_step);
  void event(double time, Recorder::Level level, const std::string& name, const std::string& text);
  /// What programs that draw logs are to draw.
  void draw_scene(const Experiment& experiment);
  void state(std::size_t step, double time, const ArmState& state);
  void image(const std::string& camera, const Frame& frame, std::string_view message);
  /// What the devices of the rig say of themselves, and how its arm truly stands, once for each time of its
  /// clock.
  void readings(const RigPorts& rig, const Backbone& truth);
  /// What a calibration does, has the simulator work out, sees in a picture that came at `received` s, and
  /// decides.
  void calibration(const CalibrationMoveMessage& message);
  void calibration(const CalibrationArcMessage& message, const Image<std::uint8_t>& ideal);
  void calibration(const CalibrationSightingMessage& message, double received);
  void calibration(const CalibrationDecisionMessage& message);
  /// What a servo sends, what it sees in a picture that came at `received` s, and that it has ended.
  void servo(const ServoStep& step);
  void servo(const ServoSightingMessage& message, double received);
  void servo_ended();
  /// What a distributed arm does.
  void dynamics(const DynamicsSampleMessage& message) { recorder_.dynamics(message); }
  /// Of each camera that gave any.
  [[nodiscard]] const std::map<std::string, std::int64_t>& frames() const { return frames_; }
  void write_commands(const Drive& drive, const std::filesystem::path& file);
  /// Takes every step, logged or not: a command list has no gaps.
  void command(double time, const ArmState& state);
  /// Where the motors come to be sent as the arm goes through these states; none without a command list.
  [[nodiscard]] std::optional<std::vector<std::int64_t>> motors_after(std::span<const ArmState> way) const;
  [[nodiscard]] Recorder& recorder() { return recorder_; }
  void close();

  [[nodiscard]] ReportData report_data(const Experiment& experiment, const Schedule& schedule,
                                       const SafetyReport& safety) &&;

 private:
  Recorder recorder_;
  RunWatcher* watcher_;
  std::optional<DriveCommands> commands_;
  std::optional<ColorConfig> drawn_color_;  // none: the scene is not kept
  SceneTimes scene_times_;
  std::map<std::string, std::int64_t> frames_;  // by camera
  std::optional<std::int64_t> read_at_;         // when devices were read last, ns
  ArmModel model_;
  std::size_t last_step_ = 0;
  std::size_t kept_every_ = 1;
  std::size_t recorded_ = 0;
  std::vector<double> times_;
  std::vector<ArmState> states_;
  std::vector<ReportData::Mark> marks_;
};

}  // namespace flexura
