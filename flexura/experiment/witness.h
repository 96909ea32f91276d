#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "flexura/experiment/drive_commands.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/scene_log.h"
#include "flexura/experiment/schedule.h"
#include "flexura/log/run_log.h"
#include "flexura/report/report.h"
#include "flexura/rig/rig.h"

namespace flexura {

/// Where an arm touches something, as logs have it.
[[nodiscard]] std::vector<ContactMessage> contact_messages(const std::vector<PlantContact>& contacts);
/// The energy of an arm in motion at `time` s, likewise; none of another.
[[nodiscard]] std::optional<EnergyMessage> energy_message(double time,
                                                          const std::optional<RodEnergy>& energy);

/// What the report shows of a true arm that is an elastic rod.
struct RodRecord {
  std::vector<double> times;                  ///< s
  std::vector<std::vector<double>> tensions;  ///< N, one list a time.
  std::vector<double> off;                    ///< How far its tip is from the commanded one, m.
  std::vector<RodEnergy> energies;            ///< Of a rod in motion, one a time; of others none.
  std::vector<double> contact_forces;         ///< Of all contacts, the sum of their sizes, N; likewise.
  std::optional<Backbone> last;               ///< As it is at the last of these times.

  /// None of an arm that is no rod; with `commanded`, how `arm` was to stand at last.
  [[nodiscard]] std::optional<Chapter> chapter(const Arm& arm, const std::vector<ObstacleConfig>& obstacles,
                                               const Backbone& commanded) const;
};

/// Everything that a run leaves behind while it plays: the log, and what the report will show.
class Witness {
 public:
  /// `watcher` gets the events and the messages of tasks; may be null.
  Witness(const std::filesystem::path& folder, const ArmModel& model, RunWatcher* watcher = nullptr);

  /// Which step of the clock is the last one, as far as it is known: a task may take its own time.
  void expect(std::size_t last_step);
  /// What programs that draw logs are to draw.
  void draw_scene(const Experiment& experiment);
  void state(std::size_t step, double time, const ArmState& state);
  /// What the devices of the rig say of themselves, and how its arm truly stands where that is known, once
  /// for each time of its clock.
  void readings(Rig& rig);
  /// How events name the axes of a drive.
  void name_axes(const Drive& drive);
  void write_commands(const Drive& drive, const std::filesystem::path& file);
  /// Takes every step, logged or not: a command list has no gaps.
  void command(double time, const ArmState& state);
  /// Where the motors come to be sent as the arm goes through these states; none without a command list.
  [[nodiscard]] std::optional<std::vector<std::int64_t>> motors_after(std::span<const ArmState> way) const;
  /// What tasks tell, and what happens.
  [[nodiscard]] RunLog& log() { return log_; }
  void close();

  [[nodiscard]] ReportData report_data(const Experiment& experiment, const Schedule& schedule,
                                       const SafetyReport& safety) &&;

 private:
  [[nodiscard]] double contact_readings(RigTruth& truth, double now);
  void rod_readings(RigTruth& truth, double now, const Backbone& backbone);
  // What motors have lost since the last time.
  void tell_lost_steps(double time, const std::vector<double>& lost);

  RunLog log_;
  std::optional<DriveCommands> commands_;
  std::optional<ColorConfig> drawn_color_;  // none: the scene is not kept
  SceneTimes scene_times_;
  std::optional<std::int64_t> read_at_;  // when devices were read last, ns
  ArmModel model_;
  std::size_t last_step_ = 0;
  std::size_t kept_every_ = 1;
  std::size_t recorded_ = 0, readings_ = 0;
  std::string warned_;    // Of the arm, at the last of the readings.
  bool touched_ = false;  // At the last of the readings.
  std::vector<double> times_;
  std::vector<ArmState> states_;
  Eigen::Vector3d commanded_tip_ = Eigen::Vector3d::Zero();
  RodRecord rod_;
  std::vector<double> lost_;             // Microsteps of each axis, as events last said.
  std::vector<std::string> axis_names_;  // As the command list has them.
};

}  // namespace flexura
