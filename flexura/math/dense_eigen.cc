#include <Eigen/Eigenvalues>
#include <limits>

#include "flexura/math/dense.h"

namespace flexura {
namespace {

using Eigen::MatrixXd;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

MatrixXd unknown(Eigen::Index rows, Eigen::Index columns) { return MatrixXd::Constant(rows, columns, nan); }

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

}  // namespace flexura
