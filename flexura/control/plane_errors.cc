#include "flexura/control/plane_errors.h"

#include <cmath>
#include <numbers>

#include "flexura/math/direction.h"

namespace flexura {
PlaneView plane_view(double theta, double q) {
  return {theta, std::atan2(std::sin(q), std::cos(theta) * std::cos(q))};
}

bool planes_determine(const Eigen::Vector2d& measured, const Eigen::Vector2d& desired) {
  const auto is_determined = [](const Eigen::Vector2d& angles) {
    return !is_singular_for_planes(angles[0]) && !is_singular_for_planes(angles[1]) &&
           std::cos(angles[1]) > 0;
  };
  return is_determined(measured) && is_determined(desired) &&
         std::cos(measured[0]) * std::cos(desired[0]) > 0 &&
         std::abs(measured[0] - desired[0]) < std::numbers::pi;
}

bool planes_contradict(const PlaneView& seen) { return std::cos(seen.alpha_1) * std::cos(seen.alpha_2) < 0; }

PlaneError plane_error(const PlaneView& measured, const PlaneView& desired) {
  PlaneError error;
  error.theta = measured.alpha_1, error.q = elevation_of_planes(measured.alpha_1, measured.alpha_2);
  const double e_1 = measured.alpha_1 - desired.alpha_1, e_2 = measured.alpha_2 - desired.alpha_2;
  const double cosine = std::cos(error.q) / std::cos(measured.alpha_2);
  error.e_theta = e_1;
  error.e_q = std::cos(error.theta) * cosine * cosine * e_2 -
              std::sin(error.q) * std::cos(error.q) * std::tan(error.theta) * e_1;
  return error;
}

}  // namespace flexura
