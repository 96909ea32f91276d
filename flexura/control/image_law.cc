#include "flexura/control/image_law.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "flexura/math/dense.h"

namespace flexura {
namespace {

// Limit of the least over the greatest singular value; below it some motion changes no feature.
constexpr double singular_condition = 1e-6;

// Computes J^T J, its lower triangle.
void normal_matrix(const Eigen::MatrixXd& J, Eigen::MatrixXd& H) {
  H.resize(J.cols(), J.cols());
  for (Eigen::Index j = 0; j < J.cols(); ++j)
    for (Eigen::Index i = j; i < J.cols(); ++i) H(i, j) = J.col(i).dot(J.col(j));
}

// Computes the lower factor of a symmetric matrix, in its lower triangle; returns false if it is not
// definite.
bool cholesky(Eigen::MatrixXd& A) {
  const Eigen::Index n = A.cols();
  for (Eigen::Index j = 0; j < n; ++j) {
    double pivot = A(j, j);
    for (Eigen::Index k = 0; k < j; ++k) pivot -= A(j, k) * A(j, k);
    if (!(pivot > 0)) return false;
    pivot = std::sqrt(pivot);
    A(j, j) = pivot;
    for (Eigen::Index i = j + 1; i < n; ++i) {
      double sum = A(i, j);
      for (Eigen::Index k = 0; k < j; ++k) sum -= A(i, k) * A(j, k);
      A(i, j) = sum / pivot;
    }
  }
  return true;
}

// Replaces b by L^-1 b, with the first `first` elements 0.
void solve_lower(const Eigen::MatrixXd& L, Eigen::VectorXd& b, Eigen::Index first) {
  for (Eigen::Index i = first; i < L.cols(); ++i) {
    double sum = b[i];
    for (Eigen::Index k = first; k < i; ++k) sum -= L(i, k) * b[k];
    b[i] = sum / L(i, i);
  }
}

// Returns the sum of the eigenvalues of the inverse of J^T J = L L^T, which is that of the squares in L^-1.
double inverse_trace(ImageLaw::Work& work) {
  const Eigen::Index n = work.factor.cols();
  double sum = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    work.column.setZero(n);
    work.column[j] = 1;
    solve_lower(work.factor, work.column, j);
    sum += work.column.squaredNorm();
  }
  return sum;
}

// The normal matrix has the squares of the singular values, precise above 1e-16 of the greatest. If its
// traces prove that it is far from singular, that is certain; otherwise the singular values of J itself
// decide.
double reciprocal_condition(const Eigen::MatrixXd& J, double trace, ImageLaw::Work& work) {
  if (J.rows() < J.cols() || !(trace > 0)) return 0;
  constexpr double surely = 10 * singular_condition;
  work.factor = work.normal;
  if (cholesky(work.factor)) {
    const double bound = 1 / std::sqrt(trace * inverse_trace(work));
    if (bound >= surely) return bound;
  }
  const Eigen::VectorXd singular = singular_values(J);
  return singular.minCoeff() / singular.maxCoeff();
}

// Replaces the right side dx by the solution.
void solve_normal(ImageLaw::Work& work) {
  work.factor = work.normal;
  if (!cholesky(work.factor)) {
    // Singular up to rounding, and not damped: any finite solution suffices.
    PivotedCholesky(work.normal).solve_in_place(work.dx);
    return;
  }
  solve_lower(work.factor, work.dx, 0);
  for (Eigen::Index i = work.factor.cols(); i-- > 0;) {
    double sum = work.dx[i];
    for (Eigen::Index k = i + 1; k < work.factor.cols(); ++k) sum -= work.factor(k, i) * work.dx[k];
    work.dx[i] = sum / work.factor(i, i);
  }
}

}  // namespace

ImageLaw::ImageLaw(const Arm& arm, const ImageLawGains& gains) : variables_(arm), gains_(gains) {
  const auto is_positive = [](double value) { return value > 0 && std::isfinite(value); };
  if (!is_positive(gains.rate) || !is_positive(gains.most_step) || !(gains.damping >= 0) ||
      !std::isfinite(gains.damping))
    throw std::invalid_argument(
        "an image law needs a rate and a largest step above 0 and a damping of 0 or more");
}

Eigen::MatrixXd ImageLaw::by_variables(const Eigen::MatrixXd& by_state) const {
  Eigen::MatrixXd J;
  by_variables(by_state, J);
  return J;
}

void ImageLaw::by_variables(const Eigen::MatrixXd& by_state, Eigen::MatrixXd& J) const {
  if (by_state.cols() != 3 * static_cast<Eigen::Index>(variables_.parts().size()))
    throw std::invalid_argument(
        "a derivative with respect to an arm's state must have three columns per section");
  J.resize(by_state.rows(), variables_.size());
  Eigen::Index column = 0;
  for (const ArmVariables::Part& part : variables_.parts()) {
    J.col(part.at) = by_state.col(column);
    if (part.is_spatial) J.col(part.at + 1) = by_state.col(column + 1);
    if (part.is_stretchable) J.col(part.stretch_at()) = by_state.col(column + 2);
    column += 3;
  }
}

ImageStep ImageLaw::step(const ArmState& sent, const Eigen::VectorXd& error, const Eigen::MatrixXd& J,
                         double dt) const {
  Work work;
  ImageStep result;
  step(sent, error, J, dt, work, result);
  return result;
}

void ImageLaw::step(const ArmState& sent, const Eigen::VectorXd& error, const Eigen::MatrixXd& J, double dt,
                    Work& work, ImageStep& step) const {
  const Eigen::Index size = variables_.size();
  if (J.cols() != size || J.rows() != error.size() || error.size() == 0 || !(dt > 0))
    throw std::invalid_argument(
        "an image law needs errors, their Jacobian with respect to the arm's variables, and a step above 0");
  variables_.pack(sent, work.x);
  step.reciprocal_condition = 0;
  normal_matrix(J, work.normal);
  work.dx.resize(size);
  for (Eigen::Index i = 0; i < size; ++i) work.dx[i] = J.col(i).dot(error);
  const double trace = work.normal.trace();
  // If a number in J or in the error is not finite, these are not either.
  if (std::isfinite(trace) && work.dx.allFinite()) {
    step.reciprocal_condition = reciprocal_condition(J, trace, work);
    const double scale = trace / static_cast<double>(size);
    work.normal.diagonal().array() += gains_.damping * gains_.damping * scale + 1e-30;
    solve_normal(work);
    work.dx *= std::exp(-gains_.rate * dt) - 1;
    const double length = work.dx.norm();
    if (length > gains_.most_step) work.dx *= gains_.most_step / length;
  } else {
    work.dx.setConstant(std::nan(""));
  }
  step.is_singular = !(step.reciprocal_condition >= singular_condition);
  work.x += work.dx;
  if (work.x.allFinite()) project(variables_.bounds(), work.x);
  variables_.state(work.x, step.asked);
}

}  // namespace flexura
