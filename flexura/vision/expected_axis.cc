#include "flexura/vision/expected_axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "flexura/vision/axis_lengths.h"

namespace flexura {
namespace {

using Eigen::Vector2d;

// The figure may be this far from the prediction, px.
constexpr int prediction_reach = 12;

// Points outside the picture matter for the curve's length, but not these, px.
constexpr double far_outside = 1e6;

bool is_in_figure(const Components& components, const Vector2d& place) {
  return place.x() >= 0 && place.y() >= 0 &&
         components.run_at(static_cast<int>(std::lround(place.x())),
                           static_cast<int>(std::lround(place.y()))) != nullptr;
}

// Returns the place of a figure next to a point of the prediction, on a line across it.
std::optional<Vector2d> place_near(const Components& components, const Vector2d& point,
                                   const Vector2d& normal) {
  for (int i = 0; i <= 2 * prediction_reach; ++i) {
    Vector2d place = point + (i % 2 == 0 ? i / 2 : -(i + 1) / 2) * normal;
    if (is_in_figure(components, place)) return place;
  }
  return std::nullopt;
}

// Returns the length of the chord of a figure through a place, px, up to a limit.
double chord_length(const Components& components, const Vector2d& place, const Vector2d& normal) {
  constexpr int longest = 200;
  int count = 1;
  for (const int sign : {-1, 1})
    for (int i = 1; i < longest && is_in_figure(components, place + sign * i * normal); ++i) ++count;
  return count;
}

}  // namespace

void ExpectedAxis::set(std::span<const Vector2d> pixels, const Vector2d& origin) {
  points_.clear(), lengths_.clear();
  for (const Vector2d& pixel : pixels) {
    const Vector2d point = pixel - origin;
    if (!(point.cwiseAbs().maxCoeff() < far_outside)) continue;  // Also NaN.
    const double step = points_.empty() ? 0 : (point - points_.back()).norm();
    lengths_.push_back(points_.empty() ? 0 : lengths_.back() + step);
    points_.push_back(point);
  }
}

// Returns whether another part of the centerline covers a point of it, at least in part.
bool ExpectedAxis::is_beside_itself(std::size_t point, double width) const {
  constexpr double far = 3, near = 1.5;  // Widths along and across the centerline.
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (std::abs(lengths_[i] - lengths_[point]) > far * width &&
        (points_[i] - points_[point]).squaredNorm() < near * near * width * width)
      return true;
  return false;
}

Vector2d ExpectedAxis::tangent(std::size_t point) const {
  return (points_[std::min(point + 1, points_.size() - 1)] - points_[point == 0 ? 0 : point - 1])
      .normalized();
}

// Returns the median length of some chords across the prediction, px; 0 if it is on no figure.
double ExpectedAxis::usual_width(const Components& components) {
  constexpr std::size_t chords = 9;
  widths_.clear();
  for (std::size_t k = 0; k < chords; ++k) {
    const std::size_t i = (2 * k + 1) * points_.size() / (2 * chords);
    const Vector2d along = tangent(i), normal(-along.y(), along.x());
    const auto place = place_near(components, points_[i], normal);
    if (place) widths_.push_back(chord_length(components, *place, normal));
  }
  return widths_.empty() ? 0 : median(std::span(widths_));
}

// Finds the longest run of points at which an arm of this width is visible.
void ExpectedAxis::find_stretch(double width, const Vector2d& corner) {
  constexpr double beyond = 3;  // Pixels outside the arm from which its borders are measured.
  const double margin = 0.5 * width + beyond;
  first_ = last_ = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vector2d& point = points_[i];
    const bool is_visible =
        point.minCoeff() > margin && (corner - point).minCoeff() > margin && !is_beside_itself(i, width);
    if (!is_visible)
      begin = i + 1;
    else if (lengths_[i] - lengths_[begin] > lengths_[last_] - lengths_[first_])
      first_ = begin, last_ = i;
  }
}

void ExpectedAxis::seeds(const Components& components, int width, int height, std::vector<TubeSeed>& seeds) {
  constexpr std::array<double, 3> fractions = {0.5, 0.3, 0.7};
  constexpr double across = 0.5;  // Greatest cosine of the angle between a chord and the centerline.
  seeds.clear();
  first_ = last_ = 0;
  const double usual = usual_width(components);
  if (!(usual > 0)) return;
  find_stretch(usual, {width - 1, height - 1});
  for (const double fraction : fractions) {
    if (first_ == last_) return;
    const double at = std::lerp(lengths_[first_], lengths_[last_], fraction);
    const auto i = static_cast<std::size_t>(std::ranges::lower_bound(lengths_, at) - lengths_.begin());
    const Vector2d along = tangent(i);
    const auto place = place_near(components, points_[i], {-along.y(), along.x()});
    if (!place) continue;
    const TubeSeed seed = shortest_chord(components, *place, 2 * usual);
    if (seed.width < 2 * usual && std::abs(seed.normal.dot(along)) < across) seeds.push_back(seed);
  }
}

// Returns the length along the prediction from its base to the place next to a pixel.
double ExpectedAxis::from_base(const Vector2d& pixel, double& distance) const {
  double nearest = std::numeric_limits<double>::infinity(), result = 0;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const Vector2d along = points_[i] - points_[i - 1];
    const double squared = along.squaredNorm();
    const double share =
        squared > 0 ? std::clamp((pixel - points_[i - 1]).dot(along) / squared, 0.0, 1.0) : 0;
    const double off = (pixel - points_[i - 1] - share * along).squaredNorm();
    if (off < nearest) nearest = off, result = lengths_[i - 1] + share * std::sqrt(squared);
  }
  distance = std::sqrt(nearest);
  return result;
}

bool ExpectedAxis::agrees(std::span<const AxisSample> axis) {
  constexpr double grace = 8;  // px
  constexpr double least_share = 0.85;
  constexpr std::size_t every = 4;  // Samples are one or two pixels apart.
  if (axis.empty() || first_ == last_) return false;
  widths_.clear();
  for (const AxisSample& sample : axis) widths_.push_back(sample.width);
  const double usual = median(std::span(widths_));
  for (std::size_t i = 0; i < axis.size(); i += every) {
    double distance = 0;
    (void)from_base(axis[i].pixel, distance);
    if (distance > usual + grace) return false;
  }
  return length_of(axis) > least_share * (lengths_[last_] - lengths_[first_]);
}

bool ExpectedAxis::is_reversed(std::span<const AxisSample> axis) const {
  double distance = 0;
  const std::size_t quarter = axis.size() / 4;
  return from_base(axis[quarter].pixel, distance) >
         from_base(axis[axis.size() - 1 - quarter].pixel, distance);
}

}  // namespace flexura
