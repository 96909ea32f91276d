#include "flexura/control/angle_measurement.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>

#include "flexura/math/hash.h"

namespace flexura {
namespace {

// Returns a number in (0, 1], a function of the arguments only.
double uniform(std::uint64_t seed, std::uint64_t time, std::uint64_t node, std::uint64_t which) {
  return static_cast<double>((hash(seed, time, node, which) >> 11) + 1) * 0x1p-53;
}

// Returns a normally distributed number of variance 1 (G. Box, M. Muller).
double normal_deviate(std::uint64_t seed, std::uint64_t time, std::uint64_t node) {
  const double radius = std::sqrt(-2 * std::log(uniform(seed, time, node, 0)));
  return radius * std::cos(2 * std::numbers::pi * uniform(seed, time, node, 1));
}

}  // namespace

MeasuredCoordinates::MeasuredCoordinates(const AngleMeasurement& measurement, Eigen::Index nodes)
    : measurement_(measurement), nodes_(nodes) {
  const auto is_amount = [](double value) { return value >= 0 && std::isfinite(value); };
  if (!(measurement.step > 0) || !std::isfinite(measurement.step) || !is_amount(measurement.delay) ||
      !is_amount(measurement.noise[0]) || !is_amount(measurement.noise[1]))
    throw std::invalid_argument(
        "a measurement's step must be above 0, its delay and noise must be 0 or more, and all must be "
        "finite");
}

void MeasuredCoordinates::take(const Eigen::VectorXd& x, const Eigen::VectorXd& v) {
  const double now = next();
  moments_.push_back({now, x, v});
  while (moments_.size() > 1 && moments_[1].time <= now - measurement_.delay) moments_.pop_front();
  seen_ = at(now - measurement_.delay);
  ++count_;
  if (measurement_.reading == AngleReading::planes) return;
  for (Eigen::Index i = 0; i < 2 * nodes_; ++i)
    seen_[i] +=
        measurement_.noise[static_cast<std::size_t>(i / nodes_)] * deviate(static_cast<std::uint64_t>(i));
}

double MeasuredCoordinates::deviate(std::uint64_t which) const {
  return normal_deviate(measurement_.seed, count_ - 1, which);
}

// Between two moments, interpolates by the cubic with their positions and rates.
Eigen::VectorXd MeasuredCoordinates::at(double time) const {
  const Moment& first = moments_.front();
  if (time <= first.time || moments_.size() == 1) return first.x;
  const Moment& second = moments_[1];
  const double h = second.time - first.time, u = (time - first.time) / h;
  const double w = u * u * (3 - 2 * u);
  return (1 - w) * first.x + w * second.x + h * u * (1 - u) * ((1 - u) * first.v - u * second.v);
}

}  // namespace flexura
