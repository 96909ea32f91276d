#include "flexura/render/gamma_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexura {
namespace {

// Returns the smallest float that gives `level`.
float threshold_of(double level, double gamma, double top) {
  const auto reaches = [&](float x) {
    return std::floor(top * std::pow(static_cast<double>(x), 1 / gamma) + 0.5) >= level;
  };
  auto x = static_cast<float>(std::pow((level - 0.5) / top, gamma));
  while (x > 0 && reaches(x)) x = std::nextafter(x, 0.0f);
  while (!reaches(x)) x = std::nextafter(x, 2.0f);
  return x;
}

}  // namespace

// For usual gammas, pieces of 2^-8 (2^-12) of an octave contain one or two (twenty) thresholds.
GammaTable::GammaTable(double gamma, int top) : shift_(top < 256 ? 15 : 11) {
  for (int level = 1; level <= top; ++level) thresholds_.push_back(threshold_of(level, gamma, top));
  thresholds_.push_back(std::numeric_limits<float>::infinity());
  first_piece_ = std::bit_cast<std::uint32_t>(thresholds_.front()) >> shift_;
  const std::uint32_t last_piece = std::bit_cast<std::uint32_t>(1.0f) >> shift_;
  for (std::uint32_t piece = first_piece_; piece <= last_piece; ++piece) {
    const auto begin = std::bit_cast<float>(piece << shift_);
    starts_.push_back(
        static_cast<std::uint16_t>(std::ranges::upper_bound(thresholds_, begin) - thresholds_.begin()));
  }
}

}  // namespace flexura
