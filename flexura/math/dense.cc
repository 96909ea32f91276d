#include "flexura/math/dense.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace flexura {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

Eigen::ColPivHouseholderQR<MatrixXd> pivoted(const MatrixXd& A, double threshold) {
  Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
  if (threshold > 0) qr.setThreshold(threshold);
  return qr;
}

}  // namespace

SymmetricEigen symmetric_eigen(const MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

double least_eigenvalue(const MatrixXd& symmetric) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

GeneralEigen general_eigen(const MatrixXd& A) {
  const Eigen::EigenSolver<MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

VectorXd singular_values(const MatrixXd& A) { return Eigen::JacobiSVD<MatrixXd>(A).singularValues(); }

VectorXd least_norm_solution(const MatrixXd& A, const VectorXd& b) {
  return A.completeOrthogonalDecomposition().solve(b);
}

MatrixXd pseudo_inverse(const MatrixXd& A) { return A.completeOrthogonalDecomposition().pseudoInverse(); }

Eigen::Index rank_of(const MatrixXd& A, double threshold) { return pivoted(A, threshold).rank(); }

MatrixXd orthogonal_complement(const MatrixXd& A, double threshold) {
  const auto qr = pivoted(A, threshold);
  const MatrixXd q = qr.householderQ();
  return q.rightCols(A.rows() - qr.rank());
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& A) {
  const Eigen::JacobiSVD<MatrixXd> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d left = svd.matrixU();
  const Eigen::Matrix3d right = svd.matrixV();
  if ((left * right.transpose()).determinant() < 0) left.col(2) *= -1;
  return left * right.transpose();
}

}  // namespace flexura
