#include "flexura/math/dense.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <limits>

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

Eigen::ColPivHouseholderQR<MatrixXd> pivoted(const MatrixXd& A, double threshold) {
  Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
  if (threshold > 0) qr.setThreshold(threshold);
  return qr;
}

}  // namespace

SymmetricEigen symmetric_eigen(const MatrixXd& A) {
  const Eigen::Index n = A.rows();
  if (!A.allFinite()) return {unknown(n, 1), unknown(n, n)};
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(A);
  if (solver.info() != Eigen::Success) return {unknown(n, 1), unknown(n, n)};
  return {solver.eigenvalues(), solver.eigenvectors()};
}

double least_eigenvalue(const MatrixXd& symmetric) {
  if (!symmetric.allFinite()) return nan;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(symmetric, Eigen::EigenvaluesOnly);
  return solver.info() == Eigen::Success ? solver.eigenvalues()[0] : nan;
}

GeneralEigen general_eigen(const MatrixXd& A) {
  const Eigen::Index n = A.rows();
  if (!A.allFinite()) return {unknown(n, 1), unknown(n, n)};
  const Eigen::EigenSolver<MatrixXd> solver(A);
  if (solver.info() != Eigen::Success) return {unknown(n, 1), unknown(n, n)};
  return {solver.eigenvalues(), solver.eigenvectors()};
}

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

VectorXd singular_values(const MatrixXd& A) {
  if (!A.allFinite()) return unknown(std::min(A.rows(), A.cols()), 1);
  return Eigen::JacobiSVD<MatrixXd>(A).singularValues();
}

VectorXd least_norm_solution(const MatrixXd& A, const VectorXd& b) {
  if (!A.allFinite()) return unknown(A.cols(), 1);
  return A.completeOrthogonalDecomposition().solve(b);
}

MatrixXd pseudo_inverse(const MatrixXd& A) {
  if (!A.allFinite()) return unknown(A.cols(), A.rows());
  return A.completeOrthogonalDecomposition().pseudoInverse();
}

Eigen::Index rank_of(const MatrixXd& A, double threshold) {
  return A.allFinite() ? pivoted(A, threshold).rank() : 0;
}

MatrixXd orthogonal_complement(const MatrixXd& A, double threshold) {
  if (!A.allFinite()) return unknown(A.rows(), A.rows());
  const auto qr = pivoted(A, threshold);
  const MatrixXd q = qr.householderQ();
  return q.rightCols(A.rows() - qr.rank());
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& A) {
  if (!A.allFinite()) return Eigen::Matrix3d::Constant(nan);
  const Eigen::JacobiSVD<MatrixXd> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d left = svd.matrixU();
  const Eigen::Matrix3d right = svd.matrixV();
  if ((left * right.transpose()).determinant() < 0) left.col(2) *= -1;
  return left * right.transpose();
}

}  // namespace flexura
