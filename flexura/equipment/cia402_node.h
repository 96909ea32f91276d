#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexura/equipment/cia402_codec.h"
#include "flexura/equipment/cia402_ramp.h"
#include "flexura/equipment/cia402_sdo.h"

namespace flexura {

/// Setup of a simulated drive. Positions are in the drive's own units.
struct Cia402NodeConfig {
  std::uint8_t node = 1;                           ///< Number of the node.
  std::string name = "Flexura simulated stepper";  ///< Object 0x1008.
  double position = 0;                             ///< Position at power-on.
  double home_switch = 0;  ///< Position of the home switch, in the coordinates valid at power-on.
  bool has_home_switch =
      true;  ///< Whether there is a home switch. Without a switch, homing methods other than 35 and 37 fail.
};

/// How a simulated drive misbehaves.
enum class Cia402Defect {
  none,
  ignores_targets,  ///< The drive acknowledges targets, but does not move.
  lies,             ///< The drive does not move, but reports that it has reached its targets.
  blocked,          ///< The motor is blocked: it stands still, and the following error grows.
  refuses_power,    ///< The drive does not leave the state "switched on".
  keeps_mapping     ///< The drive refuses changes of its PDO mapping.
};

/// A simulated drive of CiA 402 on a CAN bus. Supports the profile position mode, homing, RPDO 1 and 2,
/// TPDO 1 and 2 with changeable mapping, SYNC, heartbeats of its own and of the program, and emergencies.
class Cia402Node {
 public:
  explicit Cia402Node(const Cia402NodeConfig& config);
  Cia402Node(const Cia402Node&) = delete;
  Cia402Node& operator=(const Cia402Node&) = delete;

  /// Processes a frame of the bus at time `now`, s. Appends the frames that the node sends to `out`.
  void receive(const CanFrame& frame, double now, std::vector<CanFrame>& out);
  /// Appends to `out` the frames that the node sends on its own at time `now`, s, for example heartbeats.
  void advance(double now, std::vector<CanFrame>& out);

  /// Returns the position at `now`, in the drive's units.
  [[nodiscard]] double position(double now) const;
  [[nodiscard]] double velocity(double now) const;
  [[nodiscard]] bool is_moving(double now) const { return ramp_.is_moving(now); }
  [[nodiscard]] DriveState state() const { return state_; }
  [[nodiscard]] NmtState nmt_state() const { return nmt_; }
  [[nodiscard]] std::uint16_t statusword(double now) const;

  /// Makes the drive fail with an error code (object 0x603F).
  void fail(std::uint16_t code, double now);
  void set_defect(Cia402Defect defect, double now);
  /// Restarts the drive as after a loss of power. The drive loses its configuration, and its position is the
  /// initial position.
  void restart();

 private:
  struct Entry {
    std::uint32_t value = 0;
    int size = 4;
    bool is_writable = true;
  };
  enum class Mode { none = 0, position = 1, homing = 6 };

  // cia402_node_objects.cc
  void reset_objects();
  [[nodiscard]] const Entry* find(ObjectAddress object) const;
  [[nodiscard]] SdoServer::ReadResult read_object(ObjectAddress object) const;
  std::uint32_t write_object(ObjectAddress object, const std::string& bytes);
  [[nodiscard]] std::optional<std::uint32_t> live_value(ObjectAddress object) const;
  [[nodiscard]] std::uint32_t mapping_problem(ObjectAddress object, std::uint32_t mapped) const;
  [[nodiscard]] std::uint32_t value(std::uint16_t index, std::uint8_t sub = 0) const;
  [[nodiscard]] std::int32_t number(std::uint16_t index, std::uint8_t sub = 0) const;
  void apply_pdo(const CanFrame& frame, std::uint16_t mapping);
  [[nodiscard]] CanFrame tpdo(std::size_t i) const;

  // cia402_node.cc
  void take_nmt(const CanFrame& frame);
  void take_sync();
  void take_pdo(const CanFrame& frame);
  void take_controlword(std::uint16_t word);
  void step_state(std::uint16_t word);
  void take_setpoint(std::uint16_t word);
  void start_move(double target);
  void start_homing();
  void finish_motion();
  void quick_stop();
  void switch_off(DriveState state);
  void connection_lost();
  void send(const CanFrame& frame) { outbox_.push_back(frame); }
  [[nodiscard]] double rate(std::uint16_t index, std::uint8_t sub = 0) const;

  Cia402NodeConfig config_;
  double now_ = 0;
  NmtState nmt_ = NmtState::boot_up;
  DriveState state_ = DriveState::switch_on_disabled;
  std::vector<std::pair<std::uint32_t, Entry>> objects_;  // Sorted by index and sub-index.
  SdoServer server_;
  std::vector<CanFrame> outbox_;
  std::array<std::optional<CanFrame>, 2> waiting_;  // RPDOs until the next SYNC.
  unsigned syncs_ = 0;
  std::optional<double> next_heartbeat_, host_heard_;

  Cia402Ramp ramp_;                 // Demanded position.
  double offset_ = 0;               // Drive's position minus that counted from power-on.
  std::optional<double> stuck_at_;  // Actual position of a blocked or disobedient motor.
  Cia402Defect defect_ = Cia402Defect::none;
  std::uint16_t word_ = 0;             // Last controlword.
  std::optional<double> next_target_;  // Setpoint that waits for the end of the motion.
  std::optional<double> halted_target_;
  bool is_acknowledged_ = false, is_homing_ = false, is_homed_ = false, homing_failed_ = false,
       is_limited_ = false, has_target_ = false;
  std::uint16_t error_ = 0;
};

}  // namespace flexura
