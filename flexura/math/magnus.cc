#include "flexura/math/magnus.h"

#include <cmath>
#include <cstddef>

namespace flexura {

std::array<double, 3> magnus_points() {
  const double off = std::sqrt(0.15);
  return {0.5 - off, 0.5, 0.5 + off};
}

// With C = [a1, a2]: U = 20 a1 + a3 + C and V = a2 + [a1, 2 a3 - C] / 60. (In the reference X' = A X, so that
// brackets have the opposite sign.)
MagnusStep::MagnusStep(const Moments& moments)
    : a_(moments),
      C_(bracket(a_[0], a_[1])),
      U_(20 * a_[0] + a_[2] + C_),
      V_(a_[1] + bracket(a_[0], 2 * a_[2] - C_) / 60),
      twist_(a_[0] + a_[2] / 12 + bracket(U_, V_) / 240) {}

MagnusStep::Factors MagnusStep::factors() const {
  const Matrix6d ad_1 = ad(a_[0]), ad_2 = ad(a_[1]), one = Matrix6d::Identity();
  Factors by;
  by.U = {20 * one - ad_2, ad_1, one};
  by.V = {(ad_1 * ad_2 - ad(2 * a_[2] - C_)) / 60, one - ad_1 * ad_1 / 60, ad_1 / 30};
  return by;
}

MagnusStep::Slopes MagnusStep::slopes() const {
  const Factors by = factors();
  const Matrix6d ad_U = ad(U_) / 240, ad_V = ad(V_) / 240;
  Slopes slopes;
  for (std::size_t i = 0; i < 3; ++i) slopes[i] = ad_U * by.V[i] - ad_V * by.U[i];
  slopes[0].diagonal().array() += 1;
  slopes[2].diagonal().array() += 1.0 / 12;
  return slopes;
}

MagnusStep::Form MagnusStep::form(const Vector6d& W) const {
  const Factors by = factors();
  const Matrix6d B = bracket_form(W) / 240;
  Form form;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      form[i][j] = by.U[i].transpose() * B * by.V[j] + by.V[i].transpose() * B.transpose() * by.U[j];
      if (j < i) form[j][i] = form[i][j].transpose();
    }
  }
  // W . [U'', V] and W . [U, V''].
  const Vector6d with_V = B * V_, with_U = B.transpose() * U_ / 60;
  const Matrix6d turned = bracket_form(with_U);
  const Matrix6d twice = turned * ad(a_[1]);
  const Matrix6d mixed = bracket_form(with_V - turned.transpose() * a_[0]) - turned * ad(a_[0]);
  form[0][0] += twice + twice.transpose();
  form[0][1] += mixed;
  form[1][0] += mixed.transpose();
  form[0][2] += 2 * turned;
  form[2][0] += 2 * turned.transpose();
  return form;
}

}  // namespace flexura
