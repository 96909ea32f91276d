#include "flexura/estimate/section_groups.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace flexura {
namespace {

std::size_t group_of(std::size_t section, std::size_t sections, std::size_t groups) {
  return section * groups / sections;
}

}  // namespace

ShapePrior with_grouped_sections(const ShapePrior& prior, std::size_t most) {
  const std::vector<Section>& sections = prior.arm.sections;
  const std::size_t groups = std::min(most, sections.size());
  ShapePrior result = prior;
  result.arm.sections.clear();
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Section& section = sections[i];
    if (group_of(i, sections.size(), groups) == result.arm.sections.size()) {
      Section& first = result.arm.sections.emplace_back(section);
      first.bend_profile.reset(), first.material.reset();
      continue;
    }
    Section& group = result.arm.sections.back();
    group.length += section.length;
    group.radius[1] = section.radius[1];
    group.max_bend += section.max_bend;
  }
  // The change of curvature between groups is the sum of the changes between their sections.
  result.curvature_step *= std::sqrt(static_cast<double>(sections.size()) / static_cast<double>(groups));
  return result;
}

Shape without_groups(const ShapePrior& prior, const Shape& grouped, std::size_t most) {
  const std::vector<Section>& sections = prior.arm.sections;
  const std::size_t groups = std::min(most, sections.size());
  Shape shape{grouped.arm, ArmState::straight(sections.size()), grouped.views};
  shape.arm.sections = sections;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const std::size_t group = group_of(i, sections.size(), groups);
    shape.state.bends[i] =
        sections[i].length / grouped.arm.sections[group].length * grouped.state.bends[group];
    shape.state.stretches[i] = grouped.state.stretches[group];
  }
  return shape;
}

}  // namespace flexura
