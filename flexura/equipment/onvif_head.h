#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "flexura/equipment/onvif_client.h"
#include "flexura/equipment/onvif_config.h"
#include "flexura/port/clock_port.h"
#include "flexura/port/motion_ports.h"

namespace flexura {

/// The pan/tilt/zoom head of an ONVIF camera, moved by absolute moves.
///
/// Every move is verified: a reading is `moving` until the head has reported the target's position. If the
/// head rests elsewhere for `stall_time`, the command is repeated. If the repetition has no effect, read()
/// returns a fault until the next command or halt.
///
/// command() and read() may be called from several threads. halt() may be called at any time, because it uses
/// a separate connection. A command that is interrupted by a halt returns a fault.
class OnvifHead : public HeadPort {
 public:
  /// Throws std::invalid_argument for an invalid configuration. `password`: the user's password, which
  /// messages do not contain.
  OnvifHead(OnvifPorts ports, const OnvifConfig& config, std::string password);

  /// Asks the camera for its time, services, profiles, ranges and the head's position. The head does not
  /// move.
  [[nodiscard]] CommandOutcome start();
  /// Sets a function `take` that is called at the start and before every move. The argument of `take` is a
  /// request with a new signature that stops the head (for Guard). The camera refuses this request later if
  /// the signature is too old. If `take` returns a fault, the head is not moved.
  void share_stop(std::function<CommandOutcome(const std::string& request)> take) {
    share_stop_ = std::move(take);
  }
  /// Returns a request that stops the head, to be sent over a new connection. start() must have been called.
  [[nodiscard]] std::string stop_request() const;

  CommandOutcome command(const HeadState& state) override;
  CommandOutcome halt() override;
  Outcome<HeadReading> read() override;

 private:
  struct Sample {
    double time = 0;
    OnvifPlace place;
    std::optional<bool> is_moving;
    std::string error;
  };
  struct Goal {
    OnvifPlace place;
    std::int64_t repeats = 0;
    bool is_reached = false;
    std::string failure;
  };
  // A connection and its user.
  struct Channel {
    std::mutex mutex;
    std::optional<OnvifClient> client;
  };

  [[nodiscard]] CommandOutcome find_services();
  [[nodiscard]] CommandOutcome find_profile();
  [[nodiscard]] CommandOutcome find_ranges();
  [[nodiscard]] CommandOutcome find_range(const OnvifRange& own, const OnvifTurnConfig& axis,
                                          const char* name, OnvifRange& range) const;
  [[nodiscard]] Outcome<Sample> sample();
  [[nodiscard]] CommandOutcome send(std::uint64_t order, const OnvifPlace& place);
  [[nodiscard]] CommandOutcome stop(const std::function<bool()>& is_wanted);
  void judge(const Sample& now);
  [[nodiscard]] PortFault refusal(std::string_view what) const;
  [[nodiscard]] std::string text_of_place(const OnvifPlace& place) const;

  OnvifPorts ports_;
  OnvifConfig config_;
  std::shared_ptr<OnvifLogin> login_;
  std::function<CommandOutcome(const std::string& request)> share_stop_;
  std::string name_, node_, profile_;
  OnvifServices services_;
  OnvifRanges ranges_;
  Channel working_, halting_;  // command() and read(); halt().

  std::atomic<std::uint64_t> order_ = 0;  // Of the newest command or halt; older ones send nothing more.
  std::atomic<std::uint64_t> move_ = 0;   // Of the newest command.

  std::mutex state_mutex_;
  std::optional<Goal> goal_;
  std::optional<Sample> last_;
  std::optional<OnvifPlace> standing_;  // Where the head stands or moves slowly.
  double standing_since_ = 0;
  bool is_moving_ = false;
  bool is_newly_ordered_ = true;  // No reading since the newest command or halt.
  std::optional<double> halted_;  // Time of a halt that is not verified yet.
};

/// Connects to a head and calls OnvifHead::start(). Reads the password from `password_file`. `share_stop`:
/// see OnvifHead::share_stop(). `connect` opens a connection to the camera; default: over the network.
/// `clock` determines the times of readings and must outlive the head.
[[nodiscard]] Outcome<std::unique_ptr<OnvifHead>> open_onvif_head(
    const OnvifConfig& config, const ClockPort& clock,
    std::function<CommandOutcome(const std::string& request)> share_stop = {},
    std::function<Outcome<std::unique_ptr<Link>>()> connect = {});

}  // namespace flexura
