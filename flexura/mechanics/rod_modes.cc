#include "flexura/mechanics/rod_modes.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "flexura/math/dense.h"

namespace flexura {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXcd;

// Of M x'' + D x' + K x = 0 by the inverse of the linear system, whose greatest eigenvalues are the slowest;
// time in units in which that is about 1. Not finite where K has no inverse.
VectorXcd eigenvalues_by_inverse(const MatrixXd& L, const MatrixXd& K, const MatrixXd& D) {
  const Index n = K.rows();
  const Eigen::PartialPivLU<MatrixXd> stiffness(K);
  // By unit masses: L^T K^-1 L and L^T K^-1 D L^-T.
  const MatrixXd give = L.transpose() * stiffness.solve(L);
  const MatrixXd damp =
      L.transpose() * stiffness.solve(L.triangularView<Eigen::Lower>().solve(D.transpose()).transpose());
  const double unit = std::sqrt(give.norm());
  MatrixXd inverse = MatrixXd::Zero(2 * n, 2 * n);
  inverse.topLeftCorner(n, n) = -damp / unit;
  inverse.topRightCorner(n, n) = -give / (unit * unit);
  inverse.bottomLeftCorner(n, n).setIdentity();
  return (unit * general_eigen(inverse).values).cwiseInverse();
}

VectorXcd eigenvalues_directly(const MatrixXd& L, const MatrixXd& K, const MatrixXd& D) {
  const Index n = K.rows();
  const auto by_mass = [&](const MatrixXd& A) {
    const MatrixXd half = L.triangularView<Eigen::Lower>().solve(A);
    return MatrixXd(L.triangularView<Eigen::Lower>().solve(half.transpose()).transpose());
  };
  const MatrixXd stiff = by_mass(K);
  const double norm = stiff.norm(), unit = norm > 0 ? std::sqrt(norm) : 1;
  MatrixXd A = MatrixXd::Zero(2 * n, 2 * n);
  A.topRightCorner(n, n).setIdentity();
  A.topRightCorner(n, n) *= unit;
  A.bottomLeftCorner(n, n) = -stiff / unit;
  A.bottomRightCorner(n, n) = -by_mass(D);
  return general_eigen(A).values;
}

}  // namespace

RodModes rod_modes(const RodDynamicsSlopes& at_rest) {
  RodModes modes;
  const Index n = at_rest.mass.rows();
  if (n == 0) return modes;
  const MatrixXd K = -at_rest.force_by_q, D = -at_rest.force_by_v;
  const Cholesky mass(at_rest.mass);
  // L^-1 of ones is L's inverse.
  const MatrixXd L = mass.solve_lower(MatrixXd::Identity(n, n))
                         .triangularView<Eigen::Lower>()
                         .solve(MatrixXd::Identity(n, n));
  modes.eigenvalues = eigenvalues_by_inverse(L, K, D);
  if (!modes.eigenvalues.allFinite()) modes.eigenvalues = eigenvalues_directly(L, K, D);
  // Of conjugates the amounts are the same but for rounding, or not: by pairs.
  using Number = std::complex<double>;
  std::vector<Number> upper;
  for (const Number& value : modes.eigenvalues)
    if (value.imag() >= 0) upper.push_back(value);
  std::ranges::sort(upper, [](const Number& a, const Number& b) {
    return std::abs(a) != std::abs(b) ? std::abs(a) < std::abs(b) : a.real() < b.real();
  });
  Index at = 0;
  for (const Number& value : upper) {
    if (value.imag() > 0 && at < 2 * n) modes.eigenvalues[at++] = std::conj(value);
    if (at < 2 * n) modes.eigenvalues[at++] = value;
    if (!(value.imag() > 0)) continue;
    modes.frequencies.push_back(std::abs(value) / (2 * std::numbers::pi));
    modes.damping_ratios.push_back(-value.real() / std::abs(value));
  }
  return modes;
}

}  // namespace flexura
