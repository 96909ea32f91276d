#include "flexura/sim/rod_tube.h"

#include <span>

namespace flexura {
namespace {

// Number of backbone samples per section.
constexpr std::size_t samples_a_section = 12;

double part_of(std::size_t sample) {
  return static_cast<double>(sample) / static_cast<double>(samples_a_section);
}

std::vector<RodPlace> sampled_places(const Rod& rod) {
  std::vector<RodPlace> places;
  for (std::size_t i = 0; i < rod.sections.size(); ++i)
    for (std::size_t k = 0; k <= samples_a_section; ++k) places.push_back({i, part_of(k)});
  return places;
}

}  // namespace

std::vector<RodPlace> tube_places(const Rod& rod) {
  std::vector<RodPlace> places;
  for (std::size_t i = 0; i < rod.sections.size(); ++i)
    for (std::size_t k = 0; k < samples_a_section; ++k) places.push_back({i, part_of(k)});
  places.push_back({rod.sections.size() - 1, 1});
  return places;
}

RodTube::RodTube(const Arm& arm, const Rod& rod) : arm_(arm), chain_(rod, sampled_places(rod)) {
  for (std::size_t i = 0; i < rod.sections.size(); ++i) {
    std::vector<RodNode>& nodes = nodes_.emplace_back();
    for (std::size_t k = 0; k <= samples_a_section; ++k) nodes.push_back(chain_.node_of({i, part_of(k)}));
  }
}

Backbone RodTube::backbone(const Eigen::VectorXd& q, const std::vector<double>& rest_stretches) const {
  std::vector<BackboneSample> samples;
  {
    const std::lock_guard lock(mutex_);
    chain_.stretch_rest(rest_stretches);
    chain_.place(q);
    double s_rest = 0;
    const std::vector<RodSection>& sections = chain_.rod().sections;
    for (std::size_t i = 0; i < sections.size(); ++i) {
      const auto& radius = arm_.sections[i].radius;
      // A section's end is the next one's base.
      const std::size_t count = samples_a_section + (i + 1 == sections.size() ? 1 : 0);
      for (std::size_t k = 0; k < count; ++k) {
        const double t = part_of(k);
        samples.push_back({.X_WS = arm_.X_WB * chain_.pose(nodes_[i][k]),
                           .s_rest = s_rest + t * sections[i].length,
                           .radius = radius[0] + t * (radius[1] - radius[0]),
                           .section = i});
      }
      s_rest += sections[i].length;
    }
  }
  return Backbone::through(samples);
}

}  // namespace flexura
