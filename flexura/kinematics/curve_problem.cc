#include "flexura/kinematics/curve_problem.h"

#include <algorithm>
#include <cmath>

#include "flexura/kinematics/arc_motion.h"

namespace flexura {
namespace {

// Number of compared points: enough that no section falls between two, few enough for long arms.
std::size_t point_count(std::size_t sections) { return std::clamp<std::size_t>(6 * sections, 24, 300); }

}  // namespace

CurveProblem::CurveProblem(const ArmVariables& variables, const std::vector<Eigen::Vector3d>& points,
                           double length)
    : variables_(variables), points_(points), parts_(points.size(), 0.0), placed_(variables.parts().size()) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    parts_[i] = parts_[i - 1] + (points[i] - points[i - 1]).norm();
  }
  for (double& part : parts_) part /= parts_.back();
  parts_.back() = 1.0;
  const std::size_t count = point_count(placed_.size());
  for (std::size_t k = 1; k <= count; ++k) {
    desired_.push_back(at(static_cast<double>(k) / static_cast<double>(count)));
  }
  scale_ = 1.0 / (length * std::sqrt(static_cast<double>(count)));
}

Eigen::Vector3d CurveProblem::at(double fraction) const {
  const auto next = std::upper_bound(parts_.begin(), parts_.end() - 1, fraction);
  const auto i = static_cast<std::size_t>(next - parts_.begin());
  const double piece = parts_[i] - parts_[i - 1];
  const double f = piece > 0.0 ? (fraction - parts_[i - 1]) / piece : 0.0;
  return points_[i - 1] + f * (points_[i] - points_[i - 1]);
}

// Returns the direction from the chord between nearby points on either side: a polyline's own direction jumps
// at its corners.
Eigen::Vector3d CurveProblem::tangent_at(double fraction) const {
  constexpr double nearby = 0.02;
  const double before = std::max(0.0, fraction - nearby);
  const double after = std::min(1.0, fraction + nearby);
  const Eigen::Vector3d here = at(std::clamp(fraction, 0.0, 1.0));
  // At an end: from the parabola through three points.
  if (fraction <= 0.0) return 4.0 * at(nearby) - 3.0 * here - at(2 * nearby);
  if (fraction >= 1.0) return 3.0 * here - 4.0 * at(1 - nearby) + at(1 - 2 * nearby);
  return at(after) - at(before);
}

Eigen::VectorXd CurveProblem::start_along_tangents() const {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(variables_.size());
  double length = 0.0;
  for (const ArmVariables::Part& part : variables_.parts()) length += part.length;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double s = 0.0;
  for (const ArmVariables::Part& part : variables_.parts()) {
    s += part.length;
    const Eigen::Vector3d d = rotation.transpose() * tangent_at(s / length);
    const double across = std::hypot(d.x(), d.y());
    Eigen::Vector2d bend = Eigen::Vector2d::Zero();
    if (across > 0.0) bend = d.head<2>() * (std::atan2(across, d.z()) / across);
    x[part.at] = bend.x();
    if (part.is_spatial) x[part.at + 1] = bend.y();
    if (part.is_stretchable) x[part.stretch_at()] = 1.0;
    rotation *= arc_motion(part.bend(x), 1.0).rotation;
  }
  project(variables_.bounds(), x);
  return x;
}

void CurveProblem::place(const Eigen::VectorXd& x) {
  Pose X_BS;
  double s = 0.0;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const ArmVariables::Part& part = variables_.parts()[i];
    const double stretch = part.stretch(x);
    const double length = part.length * stretch;
    const ArcMotion motion = arc_motion(part.bend(x), length);
    const Pose end = X_BS * Pose{motion.rotation, motion.position};
    placed_[i] = {X_BS,
                  part.bend(x),
                  stretch,
                  s,
                  length,
                  end.position,
                  X_BS.rotation * motion.linear,
                  X_BS.rotation * motion.angular};
    s += length;
    X_BS = end;
  }
}

void CurveProblem::linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) {
  place(x);
  const double total = placed_.back().s + placed_.back().length;
  std::size_t section = 0;
  for (std::size_t k = 0; k < desired_.size(); ++k) {
    const double fraction = static_cast<double>(k + 1) / static_cast<double>(desired_.size());
    while (section + 1 < placed_.size() && fraction * total > placed_[section + 1].s) ++section;
    point_rows(fraction, section, 3 * static_cast<Eigen::Index>(k), desired_[k], r, J);
  }
  r *= scale_;
  J *= scale_;
}

// A stretch moves the point at a fixed share of the arc length in two ways. It moves the material, and it
// moves the point through the material along the tangent.
void CurveProblem::point_rows(double fraction, std::size_t section, Eigen::Index row,
                              const Eigen::Vector3d& desired, Eigen::VectorXd& r, Eigen::MatrixXd& J) const {
  const Placed& own = placed_[section];
  const double total = placed_.back().s + placed_.back().length;
  const double own_part = std::clamp((fraction * total - own.s) / own.length, 0.0, 1.0);
  const ArcMotion motion = arc_motion(own_part * own.bend, own_part * own.length);
  const Eigen::Vector3d along = own.X_BS.rotation * motion.position;
  const Eigen::Vector3d p = own.X_BS.position + along;
  const Eigen::Vector3d tangent = own.X_BS.rotation * motion.rotation.col(2);
  r.segment<3>(row) = p - desired;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const ArmVariables::Part& part = variables_.parts()[i];
    const Placed& placed = placed_[i];
    const bool is_before = i < section;
    for (Eigen::Index k = 0; k < (part.is_spatial ? 2 : 1); ++k) {
      auto column = J.block<3, 1>(row, part.at + k);
      if (is_before) {
        column = placed.linear.col(k) + Eigen::Vector3d(placed.angular.col(k)).cross(p - placed.end);
      } else if (i == section) {
        column = own_part * (own.X_BS.rotation * motion.linear.col(k));
      } else {
        column.setZero();
      }
    }
    if (!part.is_stretchable) continue;
    auto column = J.block<3, 1>(row, part.stretch_at());
    double material = 0.0;
    if (is_before) material = 1.0;
    if (i == section) material = own_part;
    column = tangent * (part.length * (fraction - material));
    if (is_before) column += (placed.end - placed.X_BS.position) / placed.stretch;
    if (i == section) column += along / placed.stretch;
  }
}

double CurveProblem::largest_distance(const Eigen::VectorXd& x) {
  constexpr std::size_t finer = 32;
  const std::size_t count = finer * desired_.size();
  std::vector<double> fractions = parts_;
  for (std::size_t k = 1; k < count; ++k)
    fractions.push_back(static_cast<double>(k) / static_cast<double>(count));
  std::ranges::sort(fractions);
  place(x);
  const double total = placed_.back().s + placed_.back().length;
  std::size_t section = 0;
  double largest = 0.0;
  for (const double fraction : fractions) {
    while (section + 1 < placed_.size() && fraction * total > placed_[section + 1].s) ++section;
    const Placed& own = placed_[section];
    const double part = std::clamp((fraction * total - own.s) / own.length, 0.0, 1.0);
    const Eigen::Vector3d p = own.X_BS * arc_motion(part * own.bend, part * own.length).position;
    largest = std::max(largest, (p - at(fraction)).norm());
  }
  return largest;
}

}  // namespace flexura
