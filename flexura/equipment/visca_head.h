#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "flexura/equipment/visca_bus.h"
#include "flexura/equipment/visca_config.h"
#include "flexura/port/motion_ports.h"

namespace flexura {

/// A pan/tilt/zoom head that is moved by VISCA commands.
///
/// Every move is verified: a reading is `moving` until the head has reported the target's position. If the
/// head rests elsewhere for `stall_time`, the command is repeated. If the repetition has no effect, read()
/// returns a fault until the next command or halt.
///
/// command() and read() may be called from several threads, and halt() at any time. A command that is
/// interrupted by a halt returns a fault.
class ViscaHead : public HeadPort {
 public:
  /// Throws std::invalid_argument for an invalid configuration. Heads of a chain share `bus`.
  ViscaHead(std::shared_ptr<ViscaBus> bus, const ViscaConfig& config);

  /// Checks that the head reports positions with the configured numbers of digits. The head does not move.
  /// Returns the version of the head, or zeros if the head does not report a version.
  [[nodiscard]] Outcome<ViscaVersion> start();

  CommandOutcome command(const HeadState& state) override;
  CommandOutcome halt() override;
  Outcome<HeadReading> read() override;

  /// Returns the last measured positions, counts; std::nullopt before the first reading.
  [[nodiscard]] std::optional<ViscaCounts> counts() const;

 private:
  struct Sample {
    double time = 0;
    ViscaCounts counts;
    bool is_changing = false;  // Differs from the samples before and after.
  };
  struct Goal {
    ViscaCounts counts;
    std::uint64_t turn = 0, zoom = 0;  // Numbers of the accepted commands; 0: not accepted yet.
    int repeats = 0;
    int code = 0;  // Of an error that ended a command; 0: none.
    bool is_reached = false;
    std::string failure;
  };

  [[nodiscard]] Outcome<Sample> sample() const;
  [[nodiscard]] Outcome<Sample> confirmed_sample(const std::optional<Sample>& last) const;
  // Sends both commands of a goal, or those that are not accepted yet.
  [[nodiscard]] CommandOutcome send(std::uint64_t order, const Goal& goal);
  [[nodiscard]] Outcome<std::uint64_t> send_command(std::uint64_t order, const std::string& body,
                                                    std::uint64_t previous, bool is_zoom);
  void make_room(std::uint64_t order, int code, std::uint64_t previous, bool is_zoom);
  // Stop the head, unless it was commanded after the command `move`.
  [[nodiscard]] std::optional<PortFault> stop(std::uint64_t move);
  [[nodiscard]] std::optional<PortFault> stop_by(std::uint64_t move, const std::string& body);
  // Judge a reading. Under state_mutex_.
  [[nodiscard]] bool is_at(const ViscaCounts& counts, const ViscaCounts& goal) const;
  void judge(const Sample& now);
  [[nodiscard]] PortFault refusal(std::string_view what) const;
  [[nodiscard]] std::string place(const ViscaCounts& counts) const;

  std::shared_ptr<ViscaBus> bus_;
  ViscaConfig config_;
  int address_;
  bool confirms_;

  std::mutex working_;                    // Held by command() and read(), not by halt().
  std::atomic<std::uint64_t> order_ = 0;  // Of the newest command or halt; older ones send nothing more.

  std::atomic<std::uint64_t> move_ = 0;  // Of the newest command.

  mutable std::mutex state_mutex_;
  std::optional<Goal> goal_;
  std::optional<Goal> previous_;  // Replaced by the current goal.
  std::optional<Sample> last_;
  bool is_moving_ = false;
  double standing_since_ = 0;     // Time of the first reading at the last position.
  bool is_newly_ordered_ = true;  // No reading since the newest command or halt.
  std::optional<double> halted_;  // Time of a halt that is not verified yet.
};

}  // namespace flexura
