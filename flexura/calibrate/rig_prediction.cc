#include "flexura/calibrate/rig_prediction.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace flexura {

RigPrediction predict_image(const RigProblem& problem, const RigCalibration& found, const RigStance& stance,
                            const ArmState& pose, const RigImage& image, double least) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  RigObservations alone;
  alone.poses = {pose}, alone.stances = {stance}, alone.images = {image};
  alone.stances[0].turned_as.reset();
  alone.etalon = problem.observations().etalon;
  RigProblem fresh(problem.variables().guess(), problem.prior(), alone);
  const RigVariables& variables = fresh.variables();
  const Eigen::Index own = variables.globals();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(variables.count());
  x.head(own) = found.x.head(own);
  if (!fresh.linearise(x)) return {infinite, infinite};
  const RigRows& rows = fresh.rows().front();
  // The covariance of the rig is that of the estimate; the variables of this picture have their priors.
  const auto known = static_cast<Eigen::Index>(rows.columns.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(known, known);
  for (Eigen::Index a = 0; a < known; ++a) {
    const Eigen::Index i = rows.columns[static_cast<std::size_t>(a)];
    if (i >= own) covariance(a, a) = std::pow(variables.variable(i).sigma, 2);
    for (Eigen::Index b = 0; b < known && i < own; ++b)
      if (const Eigen::Index j = rows.columns[static_cast<std::size_t>(b)]; j < own)
        covariance(a, b) = found.covariance(i, j);
  }
  std::vector<double> sigmas;  // px, one per row.
  for (const SeenMarker& marker : image.markers) sigmas.insert(sigmas.end(), 2, marker.sigma);
  for (const CurvePoint& point : image.points) sigmas.push_back(point.sigma);
  for (const EtalonPoint& point : image.etalon) sigmas.push_back(point.sigma);
  double off = 0, relative = 0;
  for (Eigen::Index row = 0; row < rows.residuals.size(); ++row) {
    const double sigma = sigmas[static_cast<std::size_t>(row)];
    const Eigen::VectorXd slope = sigma * rows.derivatives.row(row).transpose();
    const double squared = std::pow(sigma * rows.residuals[row], 2);
    off += squared;
    relative += squared / (slope.dot(covariance * slope) + sigma * sigma + least * least);
  }
  const auto things = static_cast<double>(image.things()), count = static_cast<double>(sigmas.size());
  return count > 0 ? RigPrediction{std::sqrt(off / things), std::sqrt(relative / count)}
                   : RigPrediction{infinite, infinite};
}

}  // namespace flexura
