#include "flexura/control/plane_errors.h"

#include <cmath>
#include <numbers>

#include "flexura/math/direction.h"

namespace flexura {
namespace {

double elevation_of(const PlaneView& view) { return elevation_of_planes(view.alpha_1, view.alpha_2); }

PlaneError measured_angles(const PlaneView& measured) {
  PlaneError error;
  error.theta = measured.alpha_1;
  error.q = elevation_of(measured);
  error.gain = -std::sin(error.q) * std::cos(error.q) * std::tan(error.theta);
  error.is_singular = is_singular_for_planes(error.theta);
  return error;
}

void add_spatial(PlaneError& error) {
  error.spatial = std::hypot(error.e_q, std::cos(error.q) * error.e_theta);
}

}  // namespace

PlaneView plane_view(double theta, double q) {
  return {theta, std::atan2(std::sin(q), std::cos(theta) * std::cos(q))};
}

bool planes_tell(const Eigen::Vector2d& measured, const Eigen::Vector2d& desired) {
  const auto is_told = [](const Eigen::Vector2d& angles) {
    return !is_singular_for_planes(angles[0]) && !is_singular_for_planes(angles[1]) &&
           std::cos(angles[1]) > 0;
  };
  return is_told(measured) && is_told(desired) && std::cos(measured[0]) * std::cos(desired[0]) > 0 &&
         std::abs(measured[0] - desired[0]) < std::numbers::pi;
}

bool planes_contradict(const PlaneView& seen) { return std::cos(seen.alpha_1) * std::cos(seen.alpha_2) < 0; }

PlaneError plane_error(const PlaneView& measured, const PlaneView& desired) {
  PlaneError error = measured_angles(measured);
  const double e_1 = measured.alpha_1 - desired.alpha_1, e_2 = measured.alpha_2 - desired.alpha_2;
  const double cosine = std::cos(error.q) / std::cos(measured.alpha_2);
  error.e_theta = e_1;
  error.e_q = std::cos(error.theta) * cosine * cosine * e_2 + error.gain * e_1;
  add_spatial(error);
  return error;
}

PlaneError exact_plane_error(const PlaneView& measured, const PlaneView& desired) {
  PlaneError error = measured_angles(measured);
  error.e_theta = measured.alpha_1 - desired.alpha_1;
  error.e_q = error.q - elevation_of(desired);
  error.is_singular = error.is_singular || is_singular_for_planes(desired.alpha_1);
  add_spatial(error);
  return error;
}

}  // namespace flexura
