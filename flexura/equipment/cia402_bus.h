#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "flexura/equipment/cia402_codec.h"
#include "flexura/equipment/cia402_sdo.h"
#include "flexura/equipment/link.h"
#include "flexura/port/clock_port.h"
#include "flexura/port/outcome.h"

namespace flexura {

/// State of a node, as known from its messages.
struct CanopenNode {
  std::uint8_t number = 1;
  unsigned round = 0;                  ///< Number of the SYNC before the last TPDO 1 of the node.
  std::uint16_t statusword = 0;        ///< Statusword in the last TPDO 1.
  std::int32_t position = 0;           ///< Position in the last TPDO 1, in the drive's units.
  NmtState state = NmtState::boot_up;  ///< State in the last heartbeat.
  double heard = -1;                   ///< Time when the node's last heartbeat was read, s; below 0: never.
  bool has_restarted = false;          ///< Whether the node has booted since the flag was cleared.
  Emergency emergency = {};            ///< Last emergency; code 0: none.
};

/// The program's side of a CANopen bus, which sends frames and waits for answers with a timeout. Only one
/// thread may use a CanopenBus.
class CanopenBus {
 public:
  /// The bus waits for each answer for `timeout` s, and sends each request up to `tries` times. Link and
  /// clock must outlive this object.
  CanopenBus(Link& link, const ClockPort& clock, const std::vector<std::uint8_t>& nodes, double timeout,
             int tries);

  [[nodiscard]] CanopenNode& node(std::size_t i) { return nodes_[i]; }
  [[nodiscard]] const CanopenNode& node(std::size_t i) const { return nodes_[i]; }
  [[nodiscard]] double now() const { return clock_.now(); }

  /// While this function returns true, waiting functions return at once with a fault.
  void set_interrupt(std::function<bool()> interrupt) { interrupt_ = std::move(interrupt); }

  [[nodiscard]] CommandOutcome send(const CanFrame& frame) { return link_.write(bytes_of(frame)); }
  /// Processes the frames that have arrived.
  [[nodiscard]] CommandOutcome drain();
  /// Processes arriving frames for `duration` s.
  [[nodiscard]] CommandOutcome pause(double duration);
  /// Sends SYNC until TPDO 1 of each node has answered. Returns the time of the last SYNC, s.
  [[nodiscard]] Outcome<double> synchronise();

  /// Reads an object of the node with index `i`. Returns its bytes.
  [[nodiscard]] Outcome<SdoTransfer> read(std::size_t i, ObjectAddress object);
  /// Writes an object. An abort by the node is a fault.
  [[nodiscard]] CommandOutcome write(std::size_t i, ObjectAddress object, std::uint32_t value, int size);
  /// Runs a transfer. If the node aborts the transfer, the result is the aborted transfer, not a fault.
  [[nodiscard]] Outcome<SdoTransfer> run(std::size_t i, const SdoTransfer& transfer, ObjectAddress object);

  /// Returns a fault that names the node with index `i`.
  [[nodiscard]] PortFault fault(std::size_t i, FaultKind kind, const std::string& what) const;
  [[nodiscard]] PortFault fault(FaultKind kind, const std::string& what) const {
    return {kind, link_.name() + ": " + what};
  }

 private:
  void take(const CanFrame& frame);
  // Takes frames until `is_done` or time `end`. Returns whether it is done.
  Outcome<bool> wait(const std::function<bool()>& is_done, double end);
  [[nodiscard]] PortFault missing() const;

  Link& link_;
  const ClockPort& clock_;
  std::vector<CanopenNode> nodes_;
  double timeout_;
  int tries_;
  std::function<bool()> interrupt_ = [] { return false; };
  unsigned round_ = 0;
  SdoTransfer* transfer_ = nullptr;  // Takes frames too.
  bool has_advanced_ = false;        // Whether the transfer has taken one.
  std::string trouble_;              // Last error of the bus.
};

}  // namespace flexura
