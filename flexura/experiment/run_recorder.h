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
#include "flexura/experiment/space_record.h"
#include "flexura/log/run_log.h"
#include "flexura/report/report.h"
#include "flexura/rig/rig.h"

namespace flexura {

/// Returns the contacts of an arm as messages for the log.
[[nodiscard]] std::vector<ContactMessage> contact_messages(const std::vector<PlantContact>& contacts);
/// Returns the energies of an arm at `time` (s) as a message for the log; std::nullopt without energies.
[[nodiscard]] std::optional<EnergyMessage> energy_message(double time,
                                                          const std::optional<RodEnergy>& energy);

/// Data for the report of a true arm that is an elastic rod.
struct RodRecord {
  std::vector<double> times;                  ///< In s.
  std::vector<std::vector<double>> tensions;  ///< Tensions of the tendons at each time, N.
  std::vector<double> off;             ///< Distance of the true tip from the commanded tip at each time, m.
  std::vector<RodEnergy> energies;     ///< Energies at each time; empty for a rod without inertia.
  std::vector<double> contact_forces;  ///< Sum of the magnitudes of all contact forces at each time, N.
  std::optional<Backbone> last;        ///< Backbone at the last time.

  /// Returns the report's chapter on the true arm; std::nullopt for an arm that is not a rod. `commanded`:
  /// the last commanded shape of `arm`.
  [[nodiscard]] std::optional<Chapter> chapter(const Arm& arm, const std::vector<ObstacleConfig>& obstacles,
                                               const Backbone& commanded) const;
};

/// Records a run while it is played: writes the log and collects data for the report.
class RunRecorder {
 public:
  /// `watcher` receives the events and the messages of tasks; may be null.
  RunRecorder(const std::filesystem::path& folder, const ArmModel& model, RunWatcher* watcher = nullptr);

  /// Sets the number of the clock step that is expected to be the last. The run may take more steps.
  void expect(std::size_t last_step);
  /// Logs the scene, for programs that display logs.
  void draw_scene(const Experiment& experiment);
  /// Adds the experiment's cameras to the report's 3D view.
  void add_cameras(const Experiment& experiment) { space_.add_cameras(experiment); }
  void state(std::size_t step, double time, const ArmState& state);
  /// Logs the readings of the rig's devices, and the true arm if it is known. Logs nothing if the rig's time
  /// has not changed since the last call.
  void readings(Rig& rig);
  /// Sets the axis names of a drive for events.
  void name_axes(const Drive& drive);
  void write_commands(const Drive& drive, const std::filesystem::path& file);
  /// Adds a clock step to the command list. The caller must add every clock step.
  void command(double time, const ArmState& state);
  /// Returns the motor positions after the arm has moved through these states; std::nullopt without a command
  /// list.
  [[nodiscard]] std::optional<std::vector<std::int64_t>> motors_after(std::span<const ArmState> way) const;
  /// Returns the log of tasks' messages and events.
  [[nodiscard]] RunLog& log() { return log_; }
  void close();
  /// Returns the distance of the true tip from the commanded tip at the last readings, m; std::nullopt if the
  /// truth is unknown.
  [[nodiscard]] std::optional<double> true_tip_off() const { return true_tip_off_; }
  /// Returns the first warning about the simulation of the true arm, with its time; "" without warnings.
  [[nodiscard]] const std::string& first_warning() const { return first_warning_; }

  [[nodiscard]] ReportData report_data(const Experiment& experiment, const Schedule& schedule,
                                       const SafetyReport& safety) &&;

 private:
  [[nodiscard]] double contact_readings(RigTruth& truth, double now);
  void rod_readings(RigTruth& truth, double now, const Backbone& backbone);
  // Reports steps that motors have lost since the last report.
  void report_lost_steps(double time, const std::vector<double>& lost);

  RunLog log_;
  std::optional<DriveCommands> commands_;
  std::optional<ColorConfig> drawn_color_;  // Missing: the scene is not logged.
  SceneTimes scene_times_;
  std::vector<CameraDrawing> camera_drawings_;  // Empty if the scene is not logged.
  std::optional<std::int64_t> read_at_;         // Time of the last readings, ns.
  ArmModel model_;
  std::size_t last_step_ = 0;
  std::size_t kept_every_ = 1;
  std::size_t recorded_ = 0, readings_ = 0;
  std::string warned_;  // Last warning about the arm.
  std::string first_warning_;
  bool touched_ = false;  // Whether the arm had a contact at the last readings.
  std::vector<double> times_;
  std::vector<ArmState> states_;
  std::optional<Backbone> commanded_;  // At the last state.
  SpaceRecord space_;
  std::optional<double> true_tip_off_;
  RodRecord rod_;
  std::vector<double> lost_;             // Lost microsteps of each axis, as last reported by an event.
  std::vector<std::string> axis_names_;  // Names of the axes in the command list.
};

}  // namespace flexura
