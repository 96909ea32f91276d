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

// Transforms a matrix to unit masses, mass = L L^T.
MatrixXd by_unit_mass(const MatrixXd& L, const MatrixXd& A) {
  const MatrixXd half = L.triangularView<Eigen::Lower>().solve(A);
  return L.triangularView<Eigen::Lower>().solve(half.transpose()).transpose();
}

// Returns a rate close to that of the slower modes, 1/s.
double slow_rate(const MatrixXd& L, const MatrixXd& K) {
  const Eigen::VectorXd squares = symmetric_eigen(by_unit_mass(L, 0.5 * (K + K.transpose()))).values;
  std::vector<double> sizes;
  for (const double square : squares) sizes.push_back(std::abs(square));
  std::ranges::sort(sizes);
  const double square = sizes[sizes.size() / 4];
  return square > 0 && std::isfinite(square) ? std::sqrt(square) : 1;
}

// Returns the eigenvalues of (A - shift)^-1 for M x'' + D x' + K x = 0. The largest belong to the eigenvalues
// of A nearest to the shift. Time is in units of 1/shift.
VectorXcd eigenvalues_near(double shift, const MatrixXd& L, const MatrixXd& K, const MatrixXd& D) {
  const Index n = K.rows();
  const MatrixXd mass = L * L.transpose();
  const Eigen::PartialPivLU<MatrixXd> shifted(K + shift * D + shift * shift * mass);
  const MatrixXd speed = L.transpose() * shifted.solve(L) * (shift * shift);
  const MatrixXd damp = L.triangularView<Eigen::Lower>().solve(D.transpose()).transpose();
  const MatrixXd place = L.transpose() * shifted.solve(damp) * shift + speed;
  MatrixXd inverse(2 * n, 2 * n);
  inverse << -place, -speed, MatrixXd::Identity(n, n) - place, -speed;
  return shift * (1 + general_eigen(inverse).values.array().inverse());
}

}  // namespace

RodModes rod_modes(const RodDynamicsSlopes& at_rest) {
  RodModes modes;
  const Index n = at_rest.mass.rows();
  if (n == 0) return modes;
  const MatrixXd K = -at_rest.force_by_q, D = -at_rest.force_by_v;
  const Cholesky mass(at_rest.mass);
  // L^-1 of the unit matrix.
  const MatrixXd L = mass.solve_lower(MatrixXd::Identity(n, n))
                         .triangularView<Eigen::Lower>()
                         .solve(MatrixXd::Identity(n, n));
  modes.eigenvalues = eigenvalues_near(slow_rate(L, K), L, K, D);
  // Absolute values of conjugates may differ by rounding, so pairs are sorted together.
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
