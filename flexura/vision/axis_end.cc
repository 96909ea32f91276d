#include "flexura/vision/axis_end.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "flexura/math/small_cholesky.h"

namespace flexura {
namespace {

using Eigen::Vector2d;

// Lines beside the axis along which an end is searched, in half widths.
constexpr std::array<double, 9> end_lines = {-0.8, -0.6, -0.4, -0.2, 0, 0.2, 0.4, 0.6, 0.8};

// In half widths. An end with a larger bulge is round, or seen from the front or from behind.
constexpr double bulging = 0.6;

// Relative to the half width, and px: a silhouette that deviates more from the end of a tube is rejected.
constexpr double rough_share = 0.06, rough = 0.25;

// The axis near an end: a point before it, the outward direction there, and its curvature.
struct Way {
  Vector2d from, tangent, normal;
  double curvature = 0, half_width = 0, widening = 0;

  [[nodiscard]] double half_width_at(double x) const { return half_width + widening * x; }

  // Direction after x px along the arc.
  [[nodiscard]] Vector2d tangent_at(double x) const {
    return std::cos(curvature * x) * tangent + std::sin(curvature * x) * normal;
  }
  // The point after x px along the arc and y px to the side.
  [[nodiscard]] Vector2d at(double x, double y) const {
    const double half = 0.5 * curvature * x, chord = std::abs(half) < 1e-8 ? x : x * std::sin(half) / half;
    const Vector2d turned = tangent_at(x);
    return from + chord * tangent_at(0.5 * x) + y * Vector2d(-turned.y(), turned.x());
  }
};

// Starts far enough back that the end does not affect the borders there; fits a parabola to the axis behind.
// Needs at least 8 samples.
Way way_out(const std::vector<AxisSample>& axis, bool is_last) {
  const auto at = [&](std::size_t i) -> const AxisSample& { return axis[is_last ? axis.size() - 1 - i : i]; };
  const double spacing = (at(axis.size() / 2).pixel - at(axis.size() / 2 - 1).pixel).norm();
  const auto back_off = static_cast<std::size_t>(std::ceil((0.6 * at(0).width + 3) / spacing));
  const std::size_t start = std::min(back_off, axis.size() / 3);
  const auto reach = std::min(static_cast<std::size_t>(std::ceil(14 / spacing)), axis.size() - 1 - start);
  const AxisSample& end = at(start);
  const Vector2d normal = is_last ? end.normal : Vector2d(-end.normal);
  const Vector2d back = at(start + reach).pixel - end.pixel, half = at(start + reach / 2).pixel - end.pixel;
  Way way{end.pixel, {normal.y(), -normal.x()}, normal, 0, 0.5 * end.width, 0};
  const double xb = -back.dot(way.tangent), xh = -half.dot(way.tangent);
  const double yb = back.dot(normal), yh = half.dot(normal);
  if (xb <= 0 || xh <= 0 || xb - xh < 1) return way;
  constexpr double steepest = 0.1;
  way.widening = std::clamp(0.5 * (end.width - at(start + reach).width) / xb, -steepest, steepest);
  way.curvature = 2 * (yb / xb - yh / xh) / (xb - xh);
  const double slope = -(yb / xb - 0.5 * way.curvature * xb);
  way.tangent = (way.tangent + slope * normal).normalized();
  way.normal = {-way.tangent.y(), way.tangent.x()};
  return way;
}

// The end of a silhouette along a way. `slant`: correction of the way's direction.
struct Shape {
  double x = 0, slant = 0, bulge = 0;

  // Extent along the line y half widths beside the way, and the outward normal there.
  [[nodiscard]] double reach(double y) const { return x + slant * y + bulge * std::sqrt(1 - y * y); }
  [[nodiscard]] Vector2d normal(const Way& way, double y) const {
    const double slope = (bulge * y / std::sqrt(1 - y * y) - slant) / way.half_width_at(x);
    const Vector2d tangent = way.tangent_at(reach(y));
    return (tangent + slope * Vector2d(-tangent.y(), tangent.x())).normalized();
  }
};

// Returns the first background position along a line of the way, to a pixel.
template <typename Value>
std::optional<double> first_ground(const TubeTracker<Value>& tracker, const Way& way, double y) {
  const EdgeFinder<Value>& picture = tracker.edges();
  for (double x = 0; x < 4 * way.half_width + 8; x += 1) {
    const Vector2d here = way.at(x, y * way.half_width_at(x));
    if (!picture.holds(here)) return std::nullopt;
    if (picture.sign() * (tracker.level() - picture.at(here)) <= 0) return x - 0.5;
  }
  return std::nullopt;
}

// Returns the end of the foreground along a line of the way with subpixel accuracy.
template <typename Value>
std::optional<double> reach_of(const TubeTracker<Value>& tracker, const Way& way, double y, double x,
                               const Vector2d& normal) {
  for (int i = 0; i < 5; ++i) {
    const double half_width = way.half_width_at(x);
    const auto fit = tracker.edges().look(way.at(x, y * half_width), normal, tracker.blur(), half_width);
    if (!fit || fit->contrast < 0.5 * tracker.contrast()) return std::nullopt;
    x += std::clamp(fit->offset, -1.0, 1.0) / std::max(0.2, normal.dot(way.tangent_at(x)));
    if (std::abs(fit->offset) < 0.05) break;
  }
  return x;
}

using Reaches = std::array<std::optional<double>, end_lines.size()>;

// Least-squares fit over the lines found, some of which must be on either side. A bulge is from 0 (a flat end
// seen from the side) to the half width (a round one, or a disc that faces the camera).
bool fit_shape(const Reaches& reaches, double half_width, Shape& shape) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::array<int, 2> found{};
  for (std::size_t i = 0; i < end_lines.size(); ++i) {
    if (!reaches[i]) continue;
    const Eigen::Vector3d row(1, end_lines[i], std::sqrt(1 - end_lines[i] * end_lines[i]));
    normal += row * row.transpose(), sum += *reaches[i] * row;
    if (end_lines[i] != 0) ++found[end_lines[i] < 0 ? 0 : 1];
  }
  if (found[0] < 2 || found[1] < 2) return false;
  const Eigen::Vector3d free = solve_definite(normal, sum);
  const double bulge = std::clamp(free.z(), 0.0, half_width);
  const Eigen::Vector2d rest =
      solve_definite<2>(normal.topLeftCorner<2, 2>(), sum.head<2>() - bulge * normal.topRightCorner<2, 1>());
  shape = {rest.x(), rest.y(), bulge};
  return free.allFinite() && rest.allFinite();
}

// Root mean square of the residuals, px.
double roughness(const Reaches& reaches, const Shape& shape) {
  double squares = 0;
  int count = 0;
  for (std::size_t i = 0; i < end_lines.size(); ++i) {
    if (!reaches[i]) continue;
    const double left = *reaches[i] - shape.reach(end_lines[i]);
    squares += left * left, ++count;
  }
  return std::sqrt(squares / std::max(count, 1));
}

// Returns whether there is no foreground just outside the front of an end. A tube that turns sharply, or
// meets another one, looks like an end along the way but continues beside it.
template <typename Value>
bool is_clear_ahead(const TubeTracker<Value>& tracker, const Way& way, const Shape& shape) {
  constexpr int directions = 9;
  constexpr double widest = 1.3;  // rad to either side
  const EdgeFinder<Value>& picture = tracker.edges();
  const Vector2d end = way.at(shape.x, 0), out = way.tangent_at(shape.x), aside(-out.y(), out.x());
  const double distance = way.half_width_at(shape.x) + 2 * tracker.blur() + 1.5;
  for (int i = 0; i < directions; ++i) {
    const double angle = widest * (2.0 * i / (directions - 1) - 1);
    const Vector2d here = end + distance * (std::cos(angle) * out + std::sin(angle) * aside);
    if (picture.holds(here) && picture.sign() * (tracker.level() - picture.at(here)) > 0) return false;
  }
  return true;
}

template <typename Value>
std::optional<Shape> shape_of_end(const TubeTracker<Value>& tracker, const Way& way) {
  Reaches reaches;
  for (std::size_t i = 0; i < end_lines.size(); ++i) reaches[i] = first_ground(tracker, way, end_lines[i]);
  Shape shape;
  for (int round = 0; round < 3; ++round) {
    if (!fit_shape(reaches, way.half_width_at(shape.x), shape)) return std::nullopt;
    for (std::size_t i = 0; i < end_lines.size(); ++i)
      if (reaches[i])
        reaches[i] =
            reach_of(tracker, way, end_lines[i], shape.reach(end_lines[i]), shape.normal(way, end_lines[i]));
  }
  if (!fit_shape(reaches, way.half_width_at(shape.x), shape) || shape.x < 0) return std::nullopt;
  if (roughness(reaches, shape) > rough + rough_share * way.half_width) return std::nullopt;
  if (!is_clear_ahead(tracker, way, shape)) return std::nullopt;
  return shape;
}

// Removes samples beyond the end, or so near to the end that its blur reaches the borders. Then extends the
// axis to the end.
void end_axis_at(const Way& way, const Shape& shape, double margin, bool is_last,
                 std::vector<AxisSample>& axis) {
  const double x = shape.x;
  const Vector2d end = way.at(x, 0), out = way.tangent_at(x);
  const auto is_beyond = [&](const AxisSample& sample) {
    const Vector2d to = sample.pixel - end;
    return to.dot(out) > -margin && to.norm() < 4 * way.half_width + 8;
  };
  if (!is_last) std::ranges::reverse(axis);
  while (axis.size() > 3 && is_beyond(axis.back())) axis.pop_back();
  // A bulging end may belong to an arm that turns towards the camera at its end. The borders near the end are
  // then not those of the sides.
  for (std::size_t i = axis.size(); shape.bulge > bulging * way.half_width && i-- > 0;) {
    if ((axis[i].pixel - end).norm() > way.half_width) break;
    axis[i].is_seen = false;
  }
  const AxisSample from = axis.back();
  double here = x + (from.pixel - end).dot(out);
  while (here < x) {
    here = x - here < 1.5 ? x : here + 1;
    const Vector2d tangent = way.tangent_at(here);
    const Vector2d normal = (is_last ? 1 : -1) * Vector2d(-tangent.y(), tangent.x());
    axis.push_back({way.at(here, 0), normal, from.width, 2 * from.sigma, false});
  }
  if (!is_last) std::ranges::reverse(axis);
}

// Standard deviation of the end's position along the axis, px, measured on random arms
// (docs/studies/seeing.md). The more an end turns towards the camera, the less it resembles an ellipse.
double end_sigma(const Shape& shape, double half_width, double blur) {
  constexpr double from_the_side = 0.12, from_before = 0.25, usual_blur = 0.8;
  const double turned = shape.bulge / half_width;
  return (from_the_side + from_before * turned * turned) * std::max(1.0, blur / usual_blur);
}

// The last samples before a lost end may already belong to another border.
void flag_end(bool is_last, std::vector<AxisSample>& axis) {
  const auto at = [&](std::size_t i) -> AxisSample& { return axis[is_last ? axis.size() - 1 - i : i]; };
  const Vector2d end = at(0).pixel;
  for (std::size_t i = 0; i < axis.size() && (at(i).pixel - end).norm() <= 0.5 * at(0).width; ++i)
    at(i).is_seen = false;
}

}  // namespace

template <typename Value>
void find_ends(const TubeTracker<Value>& tracker, const std::array<TrackEnd, 2>& stops,
               ArmObservation& seen) {
  for (std::size_t i = 0; i < 2; ++i) {
    const bool is_last = i == 1;
    AxisEnd& end = seen.ends[i];
    end = {};
    end.pixel = is_last ? seen.axis.back().pixel : seen.axis.front().pixel;
    end.kind = stops[i] == TrackEnd::border ? AxisEndKind::border : AxisEndKind::lost;
    if (stops[i] == TrackEnd::closed) continue;
    const Way way = way_out(seen.axis, is_last);
    // Near the picture's border the sides may become invisible before the end does.
    std::optional<Shape> shape;
    if (stops[i] != TrackEnd::lost) shape = shape_of_end(tracker, way);
    if (!shape) {
      if (end.kind == AxisEndKind::lost) flag_end(is_last, seen.axis);
      continue;
    }
    end = {AxisEndKind::free, way.at(shape->x, 0), shape->bulge,
           end_sigma(*shape, way.half_width_at(shape->x), tracker.blur())};
    end_axis_at(way, *shape, 3 * tracker.blur() + 0.5, is_last, seen.axis);
  }
}

template void find_ends(const TubeTracker<std::uint8_t>&, const std::array<TrackEnd, 2>&, ArmObservation&);
template void find_ends(const TubeTracker<std::uint16_t>&, const std::array<TrackEnd, 2>&, ArmObservation&);

}  // namespace flexura
