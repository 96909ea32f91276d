#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/equipment/device_server.h"
#include "flexura/equipment/visca_codec.h"
#include "flexura/equipment/visca_config.h"

namespace flexura {

/// Motors of a simulated VISCA head. Positions are in counts of the head.
class ViscaMotors {
 public:
  /// An axis.
  enum Axis { pan, tilt, zoom };
  virtual ~ViscaMotors() = default;
  ViscaMotors() = default;
  ViscaMotors(const ViscaMotors&) = delete;
  ViscaMotors& operator=(const ViscaMotors&) = delete;

  /// Starts a motion to `count` at time `now`, s, which must not be before the time of earlier calls.
  /// `speed`: fraction of the highest speed.
  virtual void go(Axis axis, double count, double speed, double now) = 0;
  /// Ends a motion at time `now`.
  virtual void stop(Axis axis, double now) = 0;
  /// Returns the position at time `now`, counts.
  [[nodiscard]] virtual double count(Axis axis, double now) = 0;
  /// Returns whether a motion is in progress at time `now`.
  [[nodiscard]] virtual bool is_moving(Axis axis, double now) = 0;
};

/// Motors that move at constant speed.
class SteadyViscaMotors : public ViscaMotors {
 public:
  /// `rates`: highest speeds of pan, tilt and zoom, counts/s, > 0. `start`: initial positions.
  explicit SteadyViscaMotors(const std::array<double, 3>& rates = {1440, 1440, 8192},
                             const ViscaCounts& start = {});
  void go(Axis axis, double count, double speed, double now) override;
  void stop(Axis axis, double now) override;
  [[nodiscard]] double count(Axis axis, double now) override;
  [[nodiscard]] bool is_moving(Axis axis, double now) override;

  /// Blocks an axis at its present position, as an obstacle would, or releases it.
  void block(Axis axis, bool is_blocked, double now);

 private:
  struct Motion {
    double from = 0, to = 0, since = 0, rate = 0;
    bool is_blocked = false;
  };
  std::array<double, 3> rates_;
  std::array<Motion, 3> motions_{};
};

/// A simulated VISCA head.
struct ViscaHeadModel {
  ViscaDigits digits;
  ViscaCounts lowest = {-2448, -432, 0}, highest = {2448, 1296, 0x4000};  ///< Ends of travel.
  ViscaVersion version = {0x0020, 0x040E, 0x0100, 2};
  /// Reaction to a move that is sent during another move.
  enum class Overlap { replaces, is_refused };
  Overlap overlap = Overlap::replaces;
  bool reports_acceptance = true, reports_end = true;
  bool obeys = true;          ///< Whether the head executes the moves that it accepts.
  bool is_on = true;          ///< Whether the head is switched on. A head that is switched off refuses moves.
  double reply_delay = 0.01;  ///< Time from a request to the answer, s.
};

/// Simulated VISCA heads on one link: a chain of heads on a serial line, or one head at a network address.
class ViscaDevice : public ServedDevice {
 public:
  /// Makes a device without heads: see add().
  explicit ViscaDevice(ViscaFraming framing) : framing_(framing) {}

  /// Adds a head to the end of the chain, at most 7. Returns its index. A head that is connected by network
  /// has the VISCA address 1. Heads on a serial line have no address until they are numbered. `motors` null:
  /// SteadyViscaMotors.
  std::size_t add(const ViscaHeadModel& model, std::unique_ptr<ViscaMotors> motors = nullptr);

  std::vector<std::string> receive(std::string_view bytes, double now) override;
  std::vector<std::string> advance(double now) override;

  /// Returns the properties of the head with this index, which the caller may change.
  [[nodiscard]] ViscaHeadModel& model(std::size_t head) { return heads_[head].model; }
  /// Returns the motors of the head with this index.
  [[nodiscard]] ViscaMotors& motors(std::size_t head) { return *heads_[head].motors; }
  /// Returns the positions of a head's axes at time `now`, counts.
  [[nodiscard]] ViscaCounts counts(std::size_t head, double now);
  /// Returns whether an axis of a head moves at time `now`.
  [[nodiscard]] bool is_moving(std::size_t head, double now);
  /// Ends all commands of a head with an error, as an alarm of its motors would.
  void fail(std::size_t head, ViscaError code, double now);
  /// Stops all heads and clears addresses, commands and sequence numbers, as if they were switched off and
  /// on.
  void restart(double now);
  /// Returns the number of executed moves.
  [[nodiscard]] std::size_t moves() const { return moves_; }

 private:
  struct Running {
    int socket;
    bool is_zoom;
    std::uint32_t sequence;
  };
  struct Head {
    ViscaHeadModel model;
    std::unique_ptr<ViscaMotors> motors;
    int address;  // 0: none.
    std::vector<Running> running;
  };
  struct Outgoing {
    double at;
    std::string bytes;
  };

  void take_packet(std::string_view packet, std::uint32_t sequence, double now);
  void take_sony(std::string_view datagram, double now);
  void take_broadcast(const ViscaRequest& request, double now);
  void take_request(Head& head, const ViscaRequest& request, std::uint32_t sequence, double now);
  void execute(Head& head, const ViscaRequest& request, std::uint32_t sequence, double now);
  static void start(Head& head, const ViscaRequest& request, double now);
  void cancel(Head& head, int socket, std::uint32_t sequence, double now);
  static void stop(Head& head, bool is_zoom, double now);
  void end_finished(Head& head, double now);
  void answer(const Head& head, ViscaReply reply, std::uint32_t sequence, double now);
  void send(std::string packet, std::uint32_t sequence, double at);

  ViscaFraming framing_;
  std::vector<Head> heads_;
  ViscaSplitter splitter_;
  std::optional<std::uint32_t> last_sequence_;
  std::vector<Outgoing> outgoing_;
  std::size_t moves_ = 0;
};

}  // namespace flexura
