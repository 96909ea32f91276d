#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/equipment/device_server.h"
#include "flexura/equipment/grbl_codec.h"
#include "flexura/equipment/grbl_gcode.h"
#include "flexura/equipment/grbl_motion.h"

namespace flexura {

/// A simulated motion controller.
struct GrblDeviceConfig {
  std::size_t axes = 3;  ///< Number of axes, 1 to 8; Grbl 1.1 has 3.
  bool is_grblhal =
      false;  ///< Whether the device simulates grblHAL, which has larger buffers, instead of Grbl 1.1h.
  std::map<int, double> settings =
      {};  ///< Settings that differ from the defaults, by number ($100 and so on).
  /// Positions of the limit switches at both ends of each axis, microsteps of the motor; empty: no switches.
  std::vector<double> low = {}, high = {};
  double boot_time = 0;    ///< Time from restart() to the banner, s.
  double overrun = 0.002;  ///< Time for which a motor continues to turn if its pulses stop at full speed, s.
};

/// Simulated counterpart of GrblDrive: a stepper controller with Grbl 1.1 or grblHAL, and its motors.
///
/// Supported:
/// - the `$` commands except `$SD` files
/// - G0 G1 G4 G10 (L2 L20) G17-G21 G28 G30 G40 G49 G53-G59 G80 G90 G91 G92 G93 G94 and all M words
/// - feed hold, resume, reset, jog cancel
/// - soft and hard limits
/// - homing of all axes at once
///
/// The device answers arcs and probing with error:20, and ignores other realtime bytes.
class GrblDevice : public ServedDevice {
 public:
  /// Throws std::invalid_argument if a list does not have one value per axis.
  explicit GrblDevice(GrblDeviceConfig config = {});

  std::vector<std::string> receive(std::string_view bytes, double now) override;
  std::vector<std::string> advance(double now) override;

  /// Returns the true position of each motor at time `now`, s, in whole microsteps. `now` must not be before
  /// the time of the previous call. After lost steps or homing, the controller reports other positions.
  std::vector<double> positions(double now);

  /// Restarts the controller as a power cycle or the DTR line does. The positions that the controller reports
  /// restart at 0.
  void restart(double now);
  /// Raises an alarm. The motors stop without braking, and overrun a little. With alarm 2, the motors do not
  /// overrun.
  void raise_alarm(int code, double now);
  /// Turns a motor by a number of microsteps, without the controller's knowledge.
  void slip(std::size_t axis, double microsteps) { slips_.at(axis) += microsteps; }
  /// While true, the controller answers motions with ok but does not execute them.
  void set_ignores_motions(bool ignores) { ignores_motions_ = ignores; }
  /// Returns the number of bytes that did not fit into the receive buffer.
  [[nodiscard]] std::size_t lost_bytes() const { return lost_bytes_; }
  /// Returns the controller's state.
  [[nodiscard]] GrblState state() const;
  /// Returns a setting, or 0 if the controller does not have it.
  [[nodiscard]] double setting(int number) const;

 private:
  struct Homing {
    int phase = 0;
    std::vector<double> from, motors;  // Microsteps.
    std::vector<bool> is_done;
  };

  void hear(char byte);
  void act(char byte);
  void pass_to(double now);
  void after_tick();
  void read_lines();
  void say(std::string line) { said_.push_back(std::move(line) + "\r\n"); }
  void answer(int code);
  void report();
  void reset(bool is_power);
  void greet();
  void stop_motors();

  [[nodiscard]] bool is_blocked() const;
  // Returns the error code of a line, 0 for ok, or std::nullopt if it must wait.
  std::optional<int> run(const std::string& line);
  std::optional<int> run_command(const std::string& line);
  std::optional<int> run_jog(std::string_view words);
  std::optional<int> run_gcode(const std::string& line);
  std::optional<int> run_motion(const GrblBlock& block);
  std::optional<int> move_to(const std::vector<double>& target, double feed);
  int set(std::string_view assignment);
  int start_homing();
  void home_for_tick();
  void end_homing();
  [[nodiscard]] std::vector<double> target_of(const GrblBlock& block, bool is_absolute, bool is_machine,
                                              double unit) const;
  [[nodiscard]] bool is_outside(const std::vector<double>& target) const;
  [[nodiscard]] bool is_at_switch(std::size_t axis) const;
  [[nodiscard]] std::vector<double> motors() const;
  [[nodiscard]] std::vector<double> offset() const;
  [[nodiscard]] double per_mm(std::size_t axis) const { return setting(100 + static_cast<int>(axis)); }
  [[nodiscard]] GrblLimits limits() const;
  void print_settings();
  void print_places();
  void print_build();
  void print_modes();

  GrblDeviceConfig config_;
  std::map<int, double> settings_;
  GrblMotion motion_;
  std::vector<double> slips_;  // Motor minus counted position, microsteps.
  double time_ = 0;
  std::optional<double> boots_at_;
  std::string received_, line_;
  std::optional<std::string> waiting_;  // A line that is being executed.
  std::optional<double> dwell_end_;
  std::vector<std::string> said_;
  GrblState state_ = GrblState::idle;
  bool is_canceling_ = false, needs_reset_ = false, ignores_motions_ = false, is_line_too_long_ = false;
  bool is_homed_ = false;
  std::optional<Homing> homing_;
  GrblModes modes_;
  std::array<std::vector<double>, 6> systems_;
  std::vector<double> shift_;                  // G92
  std::array<std::vector<double>, 2> places_;  // G28, G30
  int until_offset_ = 0;                       // Status reports before the next with WCO.
  std::size_t lost_bytes_ = 0, receive_size_;
};

}  // namespace flexura
