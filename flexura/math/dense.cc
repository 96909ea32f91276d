#include "flexura/math/dense.h"

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

Eigen::ColPivHouseholderQR<MatrixXd> pivoted(const MatrixXd& A, double threshold) {
  Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
  if (threshold > 0) qr.setThreshold(threshold);
  return qr;
}

}  // namespace

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
