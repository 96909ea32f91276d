#include "flexura/estimate/space_curve.h"

#include <algorithm>

#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/spatial.h"

namespace flexura {

std::size_t intervals_a_section(const ShapePrior& prior) {
  constexpr std::size_t fewest = 2, most = 10, in_all = 30;
  return std::clamp(in_all / prior.arm.sections.size(), fewest, most);
}

void SpaceCurve::set(const Shape& shape) {
  const BackboneJacobian jacobian(shape.arm, shape.state);
  const std::size_t sections = shape.arm.sections.size();
  knots_.resize(sections * intervals_ + 1);
  lengths_.resize(sections);
  by_state_.resize(6, 3 * static_cast<Eigen::Index>(sections));
  for (std::size_t i = 0; i < sections; ++i)
    lengths_[i] = shape.arm.sections[i].length * shape.state.stretches[i] / static_cast<double>(intervals_);
  for (std::size_t k = 0; k < knots_.size(); ++k) {
    MaterialPoint point{k / intervals_,
                        static_cast<double>(k % intervals_) / static_cast<double>(intervals_)};
    if (point.section == sections) point = {sections - 1, 1.0};
    const Pose X_WS = jacobian.pose(point);
    jacobian.at(point, by_state_);
    Knot& knot = knots_[k];
    knot.position = X_WS.position;
    knot.tangent = X_WS.rotation.col(2);
    knot.unknowns.resize(3, variables_.of_shape());
    variables_.by_unknowns(shape, knot.position, by_state_, knot.unknowns);
  }
}

double SpaceCurve::place_of(const Arm& arm, double s) const {
  const MaterialPoint point = material_point(arm, s);
  return (static_cast<double>(point.section) + point.fraction) * static_cast<double>(intervals_);
}

double SpaceCurve::s_of(const Arm& arm, double place) const {
  double s = 0, left = place / static_cast<double>(intervals_);
  for (const Section& section : arm.sections) {
    s += std::clamp(left, 0.0, 1.0) * section.length;
    left -= 1;
  }
  return s;
}

}  // namespace flexura
