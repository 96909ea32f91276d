#include "flexura/calibrate/rig_problem.h"

#include <cmath>
#include <utility>

#include "flexura/calibrate/etalon_figure.h"

namespace flexura {

RigProblem::RigProblem(const RigModel& guess, const RigPrior& prior, RigObservations seen)
    : prior_(prior), variables_(guess, prior, seen), seen_(std::move(seen)), rows_(seen_.images.size()) {
  for (const RigImage& image : seen_.images) is_outlier_.emplace_back(image.things(), false);
}

bool RigProblem::choose_rims(const Eigen::VectorXd& x) {
  if (!seen_.etalon || !variables_.is_rig(x)) return false;
  const EtalonFigure figure(*seen_.etalon);
  const RigProjector projector(variables_, x);
  bool is_changed = false;
  for (RigImage& image : seen_.images) {
    if (image.etalon.empty()) continue;
    const Eigen::Vector3d p_WC = projector.view(image.stance).X_WC.position;
    for (EtalonPoint& point : image.etalon) {
      const RimHalf half = figure.half_seen(point.part, p_WC);
      is_changed |= half != point.half;
      point.half = half;
    }
  }
  return is_changed;
}

bool RigProblem::linearise(const Eigen::VectorXd& x) {
  if (!variables_.is_rig(x)) return false;
  x_ = x;
  RigProjector projector(variables_, x, seen_.etalon);
  for (std::size_t i = 0; i < rows_.size(); ++i)
    if (!projector.rows(seen_.images[i], rows_[i]) || !rows_[i].derivatives.allFinite()) return false;
  return true;
}

// Calls visit(image, first row, rows, size of the residual) for each observation that is not excluded.
template <class Visit>
void RigProblem::for_each_thing(const Visit& visit) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Eigen::Index first = 0;
    for (std::size_t j = 0; j < rows_[i].sizes.size(); ++j) {
      const Eigen::Index count = rows_[i].sizes[j];
      if (!is_outlier_[i][j]) visit(i, first, count, rows_[i].residuals.segment(first, count).norm());
      first += count;
    }
  }
}

double RigProblem::cost(double bound) const {
  double sum = 0;
  for_each_thing([&](std::size_t, Eigen::Index, Eigen::Index, double size) {
    sum += size <= bound ? 0.5 * size * size : bound * (size - 0.5 * bound);
  });
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    const double off = x_[i] / variables_.variable(i).sigma;
    sum += 0.5 * off * off;
  }
  return sum;
}

void RigProblem::normal(double bound, Eigen::VectorXd& gradient, Eigen::MatrixXd& matrix) const {
  gradient.setZero(x_.size()), matrix.setZero(x_.size(), x_.size());
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    const double sigma = variables_.variable(i).sigma;
    gradient[i] = x_[i] / (sigma * sigma), matrix(i, i) = 1 / (sigma * sigma);
  }
  std::vector<Eigen::VectorXd> weights;
  weights.reserve(rows_.size());
  for (const RigRows& rows : rows_) weights.emplace_back(Eigen::VectorXd::Zero(rows.residuals.size()));
  for_each_thing([&](std::size_t image, Eigen::Index first, Eigen::Index count, double size) {
    weights[image].segment(first, count).setConstant(size <= bound ? 1 : bound / size);
  });
  Eigen::MatrixXd part;
  Eigen::VectorXd slope;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const RigRows& rows = rows_[i];
    const auto weight = weights[i].asDiagonal();
    part.noalias() = rows.derivatives.transpose() * (weight * rows.derivatives);
    slope.noalias() = rows.derivatives.transpose() * (weight * rows.residuals);
    for (Eigen::Index a = 0; a < part.cols(); ++a) {
      const Eigen::Index column = rows.columns[static_cast<std::size_t>(a)];
      gradient[column] += slope[a];
      // Columns are in ascending order, so this fills the lower triangle.
      for (Eigen::Index b = a; b < part.rows(); ++b)
        matrix(rows.columns[static_cast<std::size_t>(b)], column) += part(b, a);
    }
  }
}

std::vector<double> RigProblem::sizes() const {
  std::vector<double> sizes;
  for_each_thing([&](std::size_t, Eigen::Index, Eigen::Index, double size) { sizes.push_back(size); });
  return sizes;
}

double RigProblem::rms() const {
  double sum = 0;
  for_each_thing([&](std::size_t, Eigen::Index, Eigen::Index, double size) { sum += size * size; });
  const std::size_t count = entries();
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

std::size_t RigProblem::entries() const {
  Eigen::Index sum = 0;
  for_each_thing([&](std::size_t, Eigen::Index, Eigen::Index count, double) { sum += count; });
  return static_cast<std::size_t>(sum);
}

bool RigProblem::exclude_beyond(double bound) {
  bool is_changed = false;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Eigen::Index first = 0;
    for (std::size_t j = 0; j < rows_[i].sizes.size(); ++j) {
      const Eigen::Index count = rows_[i].sizes[j];
      const bool is_off = rows_[i].residuals.segment(first, count).norm() > bound;
      is_changed |= is_off != is_outlier_[i][j];
      is_outlier_[i][j] = is_off;
      first += count;
    }
  }
  return is_changed;
}

void RigProblem::include_all() {
  for (std::vector<bool>& image : is_outlier_) image.assign(image.size(), false);
}

std::vector<RigOutlier> RigProblem::outliers() const {
  std::vector<RigOutlier> outliers;
  for (std::size_t i = 0; i < is_outlier_.size(); ++i)
    for (std::size_t j = 0; j < is_outlier_[i].size(); ++j)
      if (is_outlier_[i][j]) outliers.push_back({i, j});
  return outliers;
}

}  // namespace flexura
