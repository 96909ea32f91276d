#pragma once

#include <deque>
#include <vector>

#include "flexura/equipment/cia402_node.h"
#include "flexura/equipment/device_server.h"

namespace flexura {

/// A CAN bus with simulated drives of CiA 402. Each message is a frame as SocketCAN has it (cia402_codec.h).
class Cia402Device : public ServedDevice {
 public:
  /// Drives at rest and switched off, one per node.
  explicit Cia402Device(const std::vector<Cia402NodeConfig>& nodes);

  std::vector<std::string> receive(std::string_view bytes, double now) override;
  std::vector<std::string> advance(double now) override;

  /// Returns the positions at `now`, not before the last call, in the drives' units, one per node.
  [[nodiscard]] std::vector<double> positions(double now) const;
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  /// Returns a drive, in the order of the constructor. Throws std::out_of_range.
  [[nodiscard]] Cia402Node& node(std::size_t i) { return nodes_.at(i); }
  /// Disconnects a drive from the bus, or connects it again. It goes on with what it does.
  void set_connected(std::size_t i, bool is_connected) { is_connected_.at(i) = is_connected; }

 private:
  std::deque<Cia402Node> nodes_;  // Nodes do not move.
  std::vector<bool> is_connected_;
};

}  // namespace flexura
