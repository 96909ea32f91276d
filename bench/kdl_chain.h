#pragma once

#include <cstddef>
#include <kdl/chain.hpp>
#include <kdl/jntarray.hpp>
#include <vector>

#include "flexura/model/arm.h"

// Represents an arm for Orocos KDL, as a chain of rigid links.
namespace flexura {

/// Returns the number of links of a section, such that there are 72 revolute joints. Each of 8 planar
/// sections has 9 links; each of 3 spatial ones has 12, with universal joints.
[[nodiscard]] inline unsigned kdl_links(const Arm& arm) {
  const std::size_t axes = arm.kind == ArmKind::planar ? 1 : 2;
  return static_cast<unsigned>(72 / (axes * arm.sections.size()));
}

/// Returns each section as equal rigid links with a joint in the middle of each, in the base's frame. The two
/// axes of universal joints alternate from one to the next; otherwise the arm would twist.
[[nodiscard]] inline KDL::Chain kdl_chain(const Arm& arm) {
  const std::vector<Section>& sections = arm.sections;
  const unsigned links = kdl_links(arm);
  const auto link = [](double length) { return KDL::Frame(KDL::Vector(0.0, 0.0, length)); };
  KDL::Chain chain;
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), link(sections[0].length / (2 * links))));
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const double own = sections[i].length / links;
    const double next = i + 1 < sections.size() ? sections[i + 1].length / links : 0.0;
    for (unsigned k = 0; k < links; ++k) {
      const double length = k + 1 < links ? own : 0.5 * (own + next);
      const KDL::Joint about_x(KDL::Joint::RotX), about_y(KDL::Joint::RotY);
      if (arm.kind == ArmKind::planar) {
        chain.addSegment(KDL::Segment(about_y, link(length)));
        continue;
      }
      const bool is_x_first = k % 2 == 1;
      chain.addSegment(KDL::Segment(is_x_first ? about_x : about_y));
      chain.addSegment(KDL::Segment(is_x_first ? about_y : about_x, link(length)));
    }
  }
  return chain;
}

/// Returns the chain's joint angles in a state of the arm (without stretch), rad.
[[nodiscard]] inline KDL::JntArray kdl_joints(const Arm& arm, const ArmState& state) {
  const unsigned links = kdl_links(arm);
  const unsigned axes = arm.kind == ArmKind::planar ? 1 : 2;
  KDL::JntArray q(static_cast<unsigned>(arm.sections.size()) * axes * links);
  for (unsigned joint = 0; joint < q.rows(); joint += axes) {
    const Eigen::Vector2d& bend = state.bends[joint / (axes * links)];
    if (axes == 1) {
      q(joint) = bend.x() / links;
      continue;
    }
    const unsigned x_first = joint / 2 % 2;
    q(joint + x_first) = bend.x() / links;
    q(joint + 1 - x_first) = -bend.y() / links;
  }
  return q;
}

}  // namespace flexura
