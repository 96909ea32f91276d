#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flexura/equipment/cia402_bus.h"
#include "flexura/equipment/cia402_config.h"
#include "flexura/equipment/cia402_ramp.h"
#include "flexura/equipment/guard.h"
#include "flexura/port/drive_port.h"

namespace flexura {

/// Identity of a drive, read from its objects.
struct Cia402Identity {
  std::string name;                ///< Name of the device (object 0x1008), or "".
  std::uint32_t vendor = 0;        ///< Number of the vendor (object 0x1018:1).
  std::uint32_t product = 0;       ///< Number of the product (object 0x1018:2).
  std::vector<std::string> notes;  ///< Functions that the drive does not support, one sentence each.
};

/// CANopen drives of CiA 402 in profile position mode, one node per axis. All axes start a motion at the same
/// SYNC, and measure their positions at the same SYNC.
///
/// Call start() first, and again after a drive has restarted, failed or lost its power. All functions may be
/// called from several threads. halt() interrupts the other functions.
class Cia402Drive : public DrivePort {
 public:
  /// Link and clock must outlive this object. The times of readings are times of `clock`. Throws
  /// std::invalid_argument if the configuration cannot be used.
  Cia402Drive(Link& link, const ClockPort& clock, const Cia402Config& config);

  /// Configures the drives, resets faults and switches the motors on. The motors do not move; they hold their
  /// positions.
  [[nodiscard]] CommandOutcome start();
  /// Homes the axes that have a homing method, one after the other, and waits for the end. After a fault or a
  /// halt, start() must be called again.
  [[nodiscard]] CommandOutcome home();
  /// Switches the motors off. Axes under load may move.
  [[nodiscard]] CommandOutcome release();
  /// Sends the drives a heartbeat, if Cia402Config::host_timeout is not 0. Commands and readings also send a
  /// heartbeat. At least two heartbeats must be sent within `host_timeout`.
  void keep_alive();
  /// Returns the identities that start() has read from the drives.
  [[nodiscard]] std::vector<Cia402Identity> identities() const;

  [[nodiscard]] DriveQuantity quantity() const override { return DriveQuantity::motor_positions; }
  [[nodiscard]] std::size_t axes() const override { return config_.axes.size(); }
  CommandOutcome command(std::span<const double> targets, double duration) override;
  CommandOutcome halt() override;
  Outcome<DriveReading> read() override;

 private:
  struct Axis {
    Cia402AxisConfig config;
    Cia402Identity identity;
    std::int32_t target = 0;  // In the drive's units.
    bool has_target = false;
    Cia402Ramp ramp;  // Expected motion, in microsteps.
    std::uint16_t word = 0;
    std::optional<std::int32_t> last_position;  // In the drive's units, at last_time.
    double last_time = 0;
    double progress_time = 0;            // When it last moved,
    std::int32_t progress_position = 0;  // and to where.
  };
  struct Problem {
    PortFault fault;
    bool needs_start = false;
  };

  // cia402_setup.cc
  CommandOutcome set_up(std::size_t i);
  CommandOutcome end_motion(std::size_t i);
  CommandOutcome start_nodes();
  CommandOutcome identify(std::size_t i);
  CommandOutcome map_pdo(std::size_t i, std::uint16_t parameters, std::uint32_t id, std::uint8_t type,
                         const std::vector<std::uint32_t>& objects);
  CommandOutcome write_checked(std::size_t i, ObjectAddress object, std::int64_t value, int size);
  CommandOutcome write_optional(std::size_t i, ObjectAddress object, std::int64_t value, int size);
  CommandOutcome set_mode(std::size_t i, int mode);
  CommandOutcome enable(bool resets_faults);
  CommandOutcome home_axis(std::size_t i);
  CommandOutcome run_homing(std::size_t i);

  // cia402_drive.cc
  CommandOutcome begin(unsigned halts);
  Outcome<double> synchronise();
  Outcome<double> measure(bool checks_positions);
  CommandOutcome send_word(std::size_t i, std::uint16_t word);
  CommandOutcome start_targets(std::span<const double> targets, double duration, double now);
  CommandOutcome accept_targets();
  CommandOutcome clear_acknowledgements();
  // Returns what is wrong with an axis, or std::nullopt.
  std::optional<Problem> problem_with(std::size_t i);
  std::optional<Problem> doubt_about(std::size_t i, double now) const;
  void remember(double now);
  CommandOutcome send_quick_stop();
  PortFault unusable(const PortFault& fault);
  [[nodiscard]] double microsteps(std::size_t i, double units) const;
  std::string error_of(std::size_t i);

  Cia402Config config_;
  Link& link_;
  mutable std::mutex mutex_;  // For all that follows.
  CanopenBus bus_;
  std::vector<Axis> axes_;
  bool is_started_ = false;
  std::string why_not_started_ = "start() has not been called";
  unsigned halts_seen_ = 0;
  bool is_halting_ = false;
  bool has_pdos_ = false;  // Whether start() has got so far.
  std::atomic<unsigned> halts_ = 0;
};

/// Returns the frames that stop the drives. The first frames are a quick stop of every node by SDO and, if
/// there is space, also by RPDO 1 and SYNC. The NMT command "stop" to all nodes follows after `delay` s.
/// Drives that start() has configured then hold their positions. After such a stop, start() must be called
/// again.
[[nodiscard]] StopMessages cia402_stop(const Cia402Config& config, double delay = 0.2);

}  // namespace flexura
