#include <limits>

#include "flexura/math/dense.h"

namespace flexura {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

MatrixXd unknown(Eigen::Index rows, Eigen::Index columns) { return MatrixXd::Constant(rows, columns, nan); }

bool is_lower_finite(const MatrixXd& A) {
  for (Eigen::Index j = 0; j < A.cols(); ++j)
    if (!A.col(j).tail(A.rows() - j).allFinite()) return false;
  return true;
}

}  // namespace

bool Cholesky::compute(const MatrixXd& A) {
  factors_.compute(A);
  is_definite_ = is_lower_finite(A) && factors_.info() == Eigen::Success;
  return is_definite_;
}

double Cholesky::rcond() const { return is_definite_ ? factors_.rcond() : 0; }

double Cholesky::log_determinant() const {
  return is_definite_ ? 2 * factors_.matrixLLT().diagonal().array().log().sum() : nan;
}

MatrixXd Cholesky::solve(const MatrixXd& B) const {
  if (!is_definite_) return unknown(B.rows(), B.cols());
  return factors_.solve(B);
}

void Cholesky::solve_in_place(VectorXd& b) const {
  if (is_definite_)
    factors_.solveInPlace(b);
  else
    b.setConstant(nan);
}

MatrixXd Cholesky::solve_lower(const MatrixXd& B) const {
  if (!is_definite_) return unknown(B.rows(), B.cols());
  return factors_.matrixL().solve(B);
}

MatrixXd Cholesky::inverse() const { return solve(MatrixXd::Identity(factors_.rows(), factors_.cols())); }

void PivotedCholesky::compute(const MatrixXd& A) {
  factors_.compute(A);
  is_finite_ = is_lower_finite(A);
}

bool PivotedCholesky::is_definite(double rounding) const {
  if (!is_finite_ || factors_.info() != Eigen::Success) return false;
  const auto pivots = factors_.vectorD();
  return pivots.minCoeff() > rounding * pivots.maxCoeff() && factors_.rcond() > rounding;
}

MatrixXd PivotedCholesky::solve(const MatrixXd& B) const {
  if (!is_finite_) return unknown(B.rows(), B.cols());
  return factors_.solve(B);
}

void PivotedCholesky::solve_in_place(VectorXd& b) const {
  if (is_finite_)
    factors_.solveInPlace(b);
  else
    b.setConstant(nan);
}

MatrixXd PivotedCholesky::inverse() const {
  return solve(MatrixXd::Identity(factors_.rows(), factors_.cols()));
}

}  // namespace flexura
