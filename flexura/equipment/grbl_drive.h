#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flexura/equipment/grbl_config.h"
#include "flexura/equipment/grbl_path.h"
#include "flexura/equipment/grbl_session.h"
#include "flexura/equipment/link.h"
#include "flexura/port/clock_port.h"
#include "flexura/port/drive_port.h"

namespace flexura {

/// Properties of a controller, as it reports them.
struct GrblIdentity {
  std::string firmware =
      {};  ///< Version that `$I` reports, for example "1.1h.20190825"; "" if there is none.
  std::vector<double> rates = {};          ///< Highest speed of each of the drive's axes, microsteps/s.
  std::vector<double> accelerations = {};  ///< Acceleration of each axis, microsteps/s^2.
  std::vector<double> travel = {};         ///< Length of travel of each axis, microsteps ($130 and so on).
  bool has_soft_limits = false;            ///< Whether targets outside the travel are clamped ($20).
  bool has_homing = false;                 ///< Whether the controller can home ($22).
};

/// Stepper motors that are driven by a controller with Grbl 1.1 or grblHAL (docs/equipment/grbl.md).
///
/// Targets and readings are motor positions, microsteps. The zero of the controller's positions is unknown,
/// so home() or set_positions() must be called first. An alarm or a restart of the controller makes the
/// positions unknown again. Then this drive refuses to move and to read until home() or set_positions() is
/// called.
///
/// Functions may be called from several threads. halt() acts immediately, even while a command or homing of
/// another thread waits, and ends this wait.
class GrblDrive : public DrivePort {
 public:
  /// `clock` determines the times of readings and timeouts, and must outlive this object. Throws
  /// std::invalid_argument for a configuration that would be invalid in a file. The address of the link is
  /// not checked.
  GrblDrive(std::unique_ptr<Link> link, const ClockPort& clock, GrblConfig config);

  /// Resets the controller, which also stops its motors, and reads its settings. Fails if the controller does
  /// not answer, or if a setting is wrong (docs/equipment/grbl.md). After the reset, the positions are
  /// unknown.
  [[nodiscard]] CommandOutcome connect();
  /// Moves all axes to their limit switches. `positions`: motor positions at the switches, microsteps.
  [[nodiscard]] CommandOutcome home(std::span<const double> positions);
  /// Sets the positions of the motors, which must be at rest, microsteps.
  [[nodiscard]] CommandOutcome set_positions(std::span<const double> positions);
  /// Ends an alarm or a hold. If the alarm made the positions unknown, they remain unknown.
  [[nodiscard]] CommandOutcome unlock();
  /// Returns true if the position is known.
  [[nodiscard]] bool knows_position() const;
  /// Returns the properties that connect() has read from the controller.
  [[nodiscard]] GrblIdentity identity() const;
  /// Asks the connected controller for its status. The positions need not be known.
  [[nodiscard]] Outcome<GrblStatus> status();
  /// Returns the link, for Guard::protect() with grbl_stop().
  [[nodiscard]] const Link& link() const { return *link_; }

  [[nodiscard]] DriveQuantity quantity() const override { return DriveQuantity::motor_positions; }
  [[nodiscard]] std::size_t axes() const override { return config_.axes.size(); }
  CommandOutcome command(std::span<const double> targets, double duration) override;
  CommandOutcome halt() override;
  Outcome<DriveReading> read() override;

 private:
  static constexpr int unknown_alarm = 0;  // The state is Alarm, but its number was lost.
  struct Report {
    GrblState state = GrblState::idle;
    std::vector<std::int64_t> steps;  // Of this drive's axes, from the controller's zero.
    double asked = 0, received = 0;   // s
  };

  [[nodiscard]] CommandOutcome check_settings(const std::vector<GrblMessage>& said);
  [[nodiscard]] CommandOutcome check_axes();
  [[nodiscard]] CommandOutcome check_usable();
  [[nodiscard]] CommandOutcome check_state(GrblState state);
  [[nodiscard]] PortFault refuse(std::string_view what) const;
  // Makes the position unknown, for this reason.
  void lose_position(std::string reason);
  [[nodiscard]] PortFault unknown_position() const;
  [[nodiscard]] double setting(int number) const;
  // Returns a report whose position is on whole steps.
  [[nodiscard]] Outcome<Report> report();
  // Returns a report that can be true, or stops and says what is wrong.
  [[nodiscard]] Outcome<Report> checked_report();
  // Brakes, if it moves, and finds out where the motors are. The position is lost if they are not on the way
  // that was commanded, unless they may be anywhere.
  [[nodiscard]] CommandOutcome stop_and_locate(bool is_anywhere = false);
  [[nodiscard]] std::optional<std::vector<std::int64_t>> steps_of(const GrblStatus& status) const;
  [[nodiscard]] std::vector<std::int64_t> clamped(std::span<const double> targets) const;
  // Cancels all motion, and finds out where the motors are.
  [[nodiscard]] CommandOutcome brake();
  [[nodiscard]] CommandOutcome send_motion(const std::vector<std::int64_t>& target, double feed);

  std::unique_ptr<Link> link_;
  const ClockPort& clock_;
  GrblConfig config_;
  GrblSession session_;
  mutable std::mutex mutex_;
  std::vector<std::size_t> indices_;  // Place of each axis in a report.
  std::vector<std::pair<int, double>> settings_;
  GrblPath path_;
  GrblAxes can_;
  std::vector<std::int64_t> zero_;  // The controller's steps where the motor positions are 0.
  std::size_t reported_axes_ = 0;
  std::string firmware_;
  bool is_connected_ = false, is_known_ = false, is_zero_forced_ = false;
  double checked_at_ = 0;   // Time of the last report.
  double accepted_at_ = 0;  // Time of the last accepted motion.
  std::string why_unknown_;
  std::optional<int> alarm_;
  std::atomic<bool> is_homing_ = false;
};

}  // namespace flexura
