#include "flexura/vision/axis_curve.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "flexura/vision/axis_end.h"

namespace flexura {
namespace {

using Eigen::Vector2d;

// Smoothing distances, px: initial, where the noise allows, and where the curve bends fast.
constexpr double first_reach = 1.8, wide_reach = 3.2, narrow_reach = 1.2;

double strength_of(double reach, double step) {
  const double squared = reach * reach / (step * step);
  return squared * squared * squared;
}

// Limits on the half width: relative to the bend's radius, and its change along the axis. (A tube at a
// distance of 20 widths widens by 0.06 if it points to within 25 degrees of the camera.)
constexpr double most_bend = 0.7, most_widening = 0.06;

// Samples within this distance of an invisible sample count as invisible, because smoothing spreads its
// error.
constexpr std::size_t spread = 2;

// Number of sections over which the residuals of smoothing must average out.
constexpr std::size_t stretch = 8;

double weight_of(const CrossSection& section) {
  if (section.is_whole()) return 1;
  return section.is_seen[0] || section.is_seen[1] ? 0.25 : 0;
}

}  // namespace

void AxisCurve::load(std::span<const CrossSection> sections) {
  smooth_.resize(sections.size()), weights_.resize(sections.size()), strengths_.resize(sections.size());
  for (std::size_t i = 0; i < sections.size(); ++i) {
    smooth_[i] << sections[i].center, sections[i].half_width;
    weights_[i] = weight_of(sections[i]);
  }
}

void AxisCurve::smooth_by_noise(std::span<const CrossSection> sections, double step, double sigma) {
  load(sections);
  std::ranges::fill(strengths_, strength_of(wide_reach, step));
  smoother_.smooth(smooth_, weights_, strengths_);
  // If a stretch's mean residual is larger than the noise explains, the curve bends faster than this
  // smoothing can follow.
  const double bound = 3.5 * sigma / std::sqrt(static_cast<double>(stretch));
  bool is_followed = true;
  for (std::size_t i = 0; i + stretch <= sections.size(); i += stretch / 2) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t j = i; j < i + stretch; ++j) {
      if (!sections[j].is_whole()) continue;
      sum += (sections[j].center - smooth_[j].head<2>()).dot(sections[j].normal), ++count;
    }
    if (2 * count < stretch || std::abs(sum) < bound * static_cast<double>(count)) continue;
    is_followed = false;
    const std::size_t first = i < 2 * stretch ? 0 : i - 2 * stretch;
    for (std::size_t j = first; j < std::min(i + 3 * stretch, sections.size()); ++j)
      strengths_[j] = strength_of(narrow_reach, step);
  }
  if (is_followed) return;
  load(sections);
  smoother_.smooth(smooth_, weights_, strengths_);
}

// Blur shifts a curved border towards its centre of curvature by half the squared blur times the curvature.
// This holds for both borders of a bend, and hence for the axis.
void AxisCurve::take(std::span<const CrossSection> sections, double step, double blur, double sigma,
                     std::vector<AxisSample>& axis) {
  const std::size_t n = sections.size();
  axis.resize(n);
  const std::size_t reach = std::min<std::size_t>(step < 1.5 ? 3 : 2, (n - 1) / 2);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = i - std::min(i, reach), after = std::min(n - 1, i + reach);
    const Vector2d here = smooth_[i].head<2>(), back = smooth_[before].head<2>(),
                   front = smooth_[after].head<2>();
    const Vector2d tangent = (front - back).normalized();
    const Vector2d normal(-tangent.y(), tangent.x());
    Vector2d toward = Vector2d::Zero();
    if (i >= reach && i + reach < n && reach > 0)
      toward = (front - 2 * here + back) / (0.25 * (front - back).squaredNorm());
    const double squared = std::min(blur * blur, 1.0);
    const double share = std::pow(strengths_[i], 1.0 / 6.0);
    // A tube that bends this tightly for its width, or widens this fast, points towards the camera. Its
    // borders then belong to other positions.
    const std::size_t span = std::max<std::size_t>(1, after - before);
    const double widening = (smooth_[after] - smooth_[before])[2] / (static_cast<double>(span) * step);
    const bool is_plain = toward.norm() * smooth_[i][2] < most_bend && std::abs(widening) < most_widening;
    axis[i] = {here - 0.5 * squared * toward, normal, 2 * smooth_[i][2],
               sigma * std::sqrt(0.45 / std::max(1.0, share)) / std::sqrt(std::max(weights_[i], 0.05)),
               sections[i].is_whole() && is_plain};
  }
}

void AxisCurve::flag_neighbours(std::vector<AxisSample>& axis) {
  unreliable_.clear();
  for (std::size_t i = 0; i < axis.size(); ++i)
    if (!axis[i].is_seen) unreliable_.push_back(i);
  for (const std::size_t i : unreliable_)
    for (std::size_t j = i - std::min(i, spread); j <= std::min(i + spread, axis.size() - 1); ++j)
      axis[j].is_seen = false;
}

template <typename Value>
bool AxisCurve::fit(TubeTracker<Value>& tracker, const std::array<TrackEnd, 2>& stops,
                    std::vector<CrossSection>& sections, ArmObservation& seen) {
  if (sections.size() < 8) return false;
  tracker.measure_blur(sections);
  load(sections);
  std::ranges::fill(strengths_, strength_of(first_reach, tracker.step()));
  smoother_.smooth(smooth_, weights_, strengths_);
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 1, sections.size() - 1);
    const Vector2d tangent = (smooth_[after] - smooth_[before]).head<2>().normalized();
    CrossSection& section = sections[i];
    section.center = smooth_[i].head<2>(), section.half_width = smooth_[i][2];
    section.normal = {-tangent.y(), tangent.x()};
    tracker.refine(section,
                   (smooth_[after] - smooth_[before])[2] /
                       (tracker.step() * static_cast<double>(std::max<std::size_t>(1, after - before))));
  }
  // Sections at the ends without both borders are beyond the arm's ends.
  std::size_t first = 0, last = sections.size();
  while (first < last && !sections[first].is_whole()) ++first;
  while (last > first && !sections[last - 1].is_whole()) --last;
  sections.erase(sections.begin() + static_cast<std::ptrdiff_t>(last), sections.end());
  sections.erase(sections.begin(), sections.begin() + static_cast<std::ptrdiff_t>(first));
  if (sections.size() < 8) return false;
  const double sigma = tracker.sigma() / std::numbers::sqrt2;
  smooth_by_noise(sections, tracker.step(), sigma);
  take(sections, tracker.step(), tracker.blur(), sigma, seen.axis);
  flag_neighbours(seen.axis);
  find_ends(tracker, stops, seen);
  return true;
}

template bool AxisCurve::fit(TubeTracker<std::uint8_t>&, const std::array<TrackEnd, 2>&,
                             std::vector<CrossSection>&, ArmObservation&);
template bool AxisCurve::fit(TubeTracker<std::uint16_t>&, const std::array<TrackEnd, 2>&,
                             std::vector<CrossSection>&, ArmObservation&);

}  // namespace flexura
