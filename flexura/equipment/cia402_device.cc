#include "flexura/equipment/cia402_device.h"

#include <algorithm>
#include <iterator>

namespace flexura {

Cia402Device::Cia402Device(const std::vector<Cia402NodeConfig>& nodes) : is_connected_(nodes.size(), true) {
  for (const Cia402NodeConfig& node : nodes) nodes_.emplace_back(node);
}

std::vector<std::string> Cia402Device::receive(std::string_view bytes, double now) {
  const auto frame = parse_can_frame(bytes);
  std::vector<std::string> answers;
  if (!frame) return answers;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!is_connected_[i]) continue;
    std::vector<CanFrame> out;
    nodes_[i].receive(*frame, now, out);
    std::ranges::transform(out, std::back_inserter(answers), bytes_of);
  }
  return answers;
}

std::vector<std::string> Cia402Device::advance(double now) {
  std::vector<std::string> answers;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    std::vector<CanFrame> out;
    nodes_[i].advance(now, out);
    if (is_connected_[i]) std::ranges::transform(out, std::back_inserter(answers), bytes_of);
  }
  return answers;
}

std::vector<double> Cia402Device::positions(double now) const {
  std::vector<double> positions;
  std::ranges::transform(nodes_, std::back_inserter(positions),
                         [&](const Cia402Node& node) { return node.position(now); });
  return positions;
}

}  // namespace flexura
