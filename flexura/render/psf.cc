#include "flexura/render/psf.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace flexura {
namespace {

// Returns one side of a Gaussian kernel of unit sum.
std::vector<double> sampled(double deviation, int radius) {
  std::vector<double> weights;
  double sum = 0;
  for (int i = 0; i <= radius; ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (deviation * deviation)));
    sum += i == 0 ? weights.back() : 2 * weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

double variance_of(const std::vector<double>& weights) {
  double variance = 0;
  for (std::size_t i = 1; i < weights.size(); ++i)
    variance += 2 * weights[i] * static_cast<double>(i) * static_cast<double>(i);
  return variance;
}

}  // namespace

std::vector<float> psf_weights(double deviation) {
  if (deviation == 0) return {1};
  const int radius = static_cast<int>(std::ceil(3.5 * deviation));
  // Uses bisection, because the variance of the kernel increases with that of the Gaussian.
  double low = 0.01, high = 2 * deviation + 1;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (variance_of(sampled(middle, radius)) < deviation * deviation ? low : high) = middle;
  }
  const std::vector<double> weights = sampled(0.5 * (low + high), radius);
  return {weights.begin(), weights.end()};
}

}  // namespace flexura
