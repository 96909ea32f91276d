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

/// What a drive says about itself.
struct Cia402Identity {
  std::string name;                ///< Object 0x1008, or "".
  std::uint32_t vendor = 0;        ///< Object 0x1018:1.
  std::uint32_t product = 0;       ///< Object 0x1018:2.
  std::vector<std::string> notes;  ///< What it does not support, one sentence each.
};

/// CANopen drives of CiA 402 in profile position mode, one node per axis. Targets start on a SYNC, and
/// positions are measured at a SYNC, so that all axes are in step.
///
/// start() must come first, and again after a drive has restarted, failed or lost its power. All functions
/// may be called from several threads. halt() interrupts the others.
class Cia402Drive : public DrivePort {
 public:
  /// Link and clock must outlive this object. The clock gives the times of readings. Throws
  /// std::invalid_argument if the configuration cannot be used.
  Cia402Drive(Link& link, const ClockPort& clock, const Cia402Config& config);

  /// Sets the drives up, resets faults and switches the motors on. Nothing moves, but motors take hold.
  [[nodiscard]] CommandOutcome start();
  /// Homes the axes that have a homing method, one after the other in their order. Waits for the end. After a
  /// fault or a halt, start() must be called again.
  [[nodiscard]] CommandOutcome home();
  /// Switches the motors off. Axes under load may move.
  [[nodiscard]] CommandOutcome release();
  /// Sends the drives a sign of life, if Cia402Config::host_timeout is not 0. Commands and readings
  /// do so too. Must be called at least twice in that time.
  void keep_alive();
  /// Returns what start() has learned of the drives.
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

/// Returns the frames that stop the drives. The first are a quick stop of every node by SDO and, as far as
/// there is place, by RPDO 1 and SYNC. Then, after `delay` s, follows the NMT command "stop" to all nodes.
/// The drives hold their positions if start() has set them up. After that, start() must be called again.
[[nodiscard]] StopMessages cia402_stop(const Cia402Config& config, double delay = 0.2);

}  // namespace flexura
