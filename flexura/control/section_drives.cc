#include "flexura/control/section_drives.h"

#include <Eigen/Core>
#include <cstddef>

namespace flexura {
namespace {

// Returns G of drives; each has one column of numbers for an angle's nodes.
Eigen::MatrixXd drive_map(const DistributedArm& arm, const Eigen::MatrixXd& of_an_angle) {
  const Eigen::Index n = arm.nodes(), sections = of_an_angle.cols(), lengths = arm.size() - 2 * n;
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(arm.size(), 2 * sections + lengths);
  for (Eigen::Index k = 0; k < sections; ++k) {
    G.col(2 * k).head(n) = of_an_angle.col(k);
    G.col(2 * k + 1).segment(n, n) = of_an_angle.col(k);
  }
  G.bottomRightCorner(lengths, lengths).setIdentity();
  return G;
}

}  // namespace

Eigen::MatrixXd section_torques(const DistributedArm& arm) {
  const AngleShapes& shapes = arm.shapes();
  Eigen::MatrixXd numbers =
      Eigen::MatrixXd::Zero(arm.nodes(), static_cast<Eigen::Index>(shapes.lengths.size()));
  for (Eigen::Index j = 0; j < shapes.s.size(); ++j)
    numbers.col(static_cast<Eigen::Index>(shapes.section[static_cast<std::size_t>(j)])) +=
        shapes.weights[j] * shapes.values.row(j).transpose();
  return drive_map(arm, numbers);
}

Eigen::MatrixXd section_moments(const DistributedArm& arm) {
  const AngleShapes& shapes = arm.shapes();
  const Eigen::Index n = arm.nodes();
  Eigen::MatrixXd numbers(n, static_cast<Eigen::Index>(shapes.lengths.size()));
  double start = 0;
  for (std::size_t k = 0; k < shapes.lengths.size(); ++k) {
    const double end = start + shapes.lengths[k];
    // Keeps the last end from exceeding the length by rounding.
    numbers.col(static_cast<Eigen::Index>(k)) =
        (shapes.at(end).head(n) - shapes.at(start).head(n)).transpose();
    start = end;
  }
  return drive_map(arm, numbers);
}

Eigen::MatrixXd drives_of(const DistributedArm& arm, DriveKind kind) {
  if (kind == DriveKind::torques) return section_torques(arm);
  if (kind == DriveKind::moments) return section_moments(arm);
  return {};
}

}  // namespace flexura
