#include "flexura/control/image_law.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace flexura {

ImageLaw::ImageLaw(const Arm& arm, const ImageLawGains& gains) : variables_(arm), gains_(gains) {
  const auto is_positive = [](double value) { return value > 0 && std::isfinite(value); };
  if (!is_positive(gains.rate) || !is_positive(gains.most_step) || !(gains.damping >= 0) ||
      !std::isfinite(gains.damping))
    throw std::invalid_argument(
        "a law of images needs a rate and a longest step above 0 and a damping of 0 or more");
}

Eigen::MatrixXd ImageLaw::by_variables(const Eigen::MatrixXd& by_state) const {
  if (by_state.cols() != 3 * static_cast<Eigen::Index>(variables_.parts().size()))
    throw std::invalid_argument("a derivative by an arm's state has three columns a section");
  Eigen::MatrixXd J(by_state.rows(), variables_.size());
  Eigen::Index column = 0;
  for (const ArmVariables::Part& part : variables_.parts()) {
    J.col(part.at) = by_state.col(column);
    if (part.is_spatial) J.col(part.at + 1) = by_state.col(column + 1);
    if (part.is_stretchable) J.col(part.stretch_at()) = by_state.col(column + 2);
    column += 3;
  }
  return J;
}

ImageStep ImageLaw::step(const ArmState& sent, const Eigen::VectorXd& error, const Eigen::MatrixXd& J,
                         double dt) const {
  if (J.cols() != variables_.size() || J.rows() != error.size() || error.size() == 0 || !(dt > 0))
    throw std::invalid_argument(
        "a law of images needs errors, their Jacobian by the arm's variables, and a time");
  ImageStep step;
  Eigen::VectorXd x = variables_.pack(sent), dx = Eigen::VectorXd::Constant(x.size(), std::nan(""));
  if (J.allFinite() && error.allFinite()) {
    Eigen::MatrixXd H = J.transpose() * J;
    const double scale = H.trace() / static_cast<double>(H.rows());
    const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(J).singularValues();
    const double greatest = singular.maxCoeff();
    const bool is_wide = J.rows() < J.cols();
    step.reciprocal_condition = greatest > 0 && !is_wide ? singular.minCoeff() / greatest : 0;
    H.diagonal().array() += gains_.damping * gains_.damping * scale + 1e-30;
    dx = (std::exp(-gains_.rate * dt) - 1) * H.ldlt().solve(J.transpose() * error);
    const double length = dx.norm();
    if (length > gains_.most_step) dx *= gains_.most_step / length;
  }
  constexpr double singular_condition = 1e-6;
  step.is_singular = !(step.reciprocal_condition >= singular_condition);
  x += dx;
  if (x.allFinite()) project(variables_.bounds(), x);
  step.asked = variables_.state(x);
  return step;
}

ArmState shape_step(const ArmState& sent, const ArmState& seen, const ArmState& desired, double rate,
                    double dt) {
  const std::size_t count = sent.bends.size();
  for (const ArmState* state : {&sent, &seen, &desired})
    if (state->bends.size() != count || state->stretches.size() != count)
      throw std::invalid_argument("the law on shapes needs states of one arm");
  const double share = 1 - std::exp(-rate * dt);
  ArmState asked = sent;
  for (std::size_t i = 0; i < count; ++i) {
    asked.bends[i] += share * (desired.bends[i] - seen.bends[i]);
    asked.stretches[i] += share * (desired.stretches[i] - seen.stretches[i]);
  }
  return asked;
}

}  // namespace flexura
