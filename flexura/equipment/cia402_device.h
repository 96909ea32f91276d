#pragma once

#include <deque>
#include <vector>

#include "flexura/equipment/cia402_node.h"
#include "flexura/equipment/device_server.h"

namespace flexura {

/// A CAN bus with simulated CiA 402 drives. Each message is one frame in the format of SocketCAN
/// (cia402_codec.h).
class Cia402Device : public ServedDevice {
 public:
  /// Makes one drive per node, at rest and switched off.
  explicit Cia402Device(const std::vector<Cia402NodeConfig>& nodes);

  std::vector<std::string> receive(std::string_view bytes, double now) override;
  std::vector<std::string> advance(double now) override;

  /// Returns the positions at time `now`, s, in the drives' units, one per node. `now` must not be before the
  /// last call.
  [[nodiscard]] std::vector<double> positions(double now) const;
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  /// Returns a drive, in the order of the constructor. Throws std::out_of_range.
  [[nodiscard]] Cia402Node& node(std::size_t i) { return nodes_.at(i); }
  /// Disconnects a drive from the bus, or connects it again. The drive continues its present motion.
  void set_connected(std::size_t i, bool is_connected) { is_connected_.at(i) = is_connected; }

 private:
  std::deque<Cia402Node> nodes_;  // Nodes do not move.
  std::vector<bool> is_connected_;
};

}  // namespace flexura
