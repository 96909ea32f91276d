#include "flexura/servo/measured_places.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "flexura/kinematics/spatial.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

// Returns the fraction of the segment from `a` to `b` at which it crosses the line through `at` across
// `heading`; std::nullopt if it does not.
std::optional<double> meeting(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& at,
                              const Eigen::Vector2d& heading) {
  const double from = heading.dot(a - at), to = heading.dot(b - at);
  if ((from < 0) == (to < 0)) return std::nullopt;
  return from / (from - to);
}

// Image of a point of the shape, and the offset of the measured curve across it.
struct Place {
  Eigen::Vector2d pixel = {0, 0}, across = {0, 0};
  std::optional<double> offset;  // In px; empty where no curve was measured.
};

// Returns the largest distance from the shape's image, px, at which a measurement counts as the arm. It is
// smaller if view errors are estimated.
double farthest_in(const Observation& seen) { return seen.view_prior.is_any() ? 3 : 20; }

// A measured curve in short pieces, so that a point searches only the pieces near it.
class CurveStretches {
 public:
  // `right`: for an edge, 1 if the arm is left of the curve's direction in the picture, -1 if right of it. 0
  // for a centerline, which has no sides.
  CurveStretches(const std::vector<CurvePoint>& points, double farthest, double right)
      : points_(points), farthest_(farthest), right_(right) {
    for (std::size_t first = 0; first + 1 < points.size(); first += length) {
      Eigen::AlignedBox2d& box = boxes_.emplace_back();
      for (std::size_t i = first; i <= std::min(first + length, points.size() - 1); ++i)
        box.extend(points[i].pixel);
    }
  }

  // Returns the offset of the curve across the point; std::nullopt if the curve does not pass there.
  [[nodiscard]] std::optional<double> offset(const Place& place) const {
    const Eigen::Vector2d heading(place.across.y(), -place.across.x());
    std::optional<double> nearest;
    for (std::size_t k = 0; k < boxes_.size(); ++k) {
      if (boxes_[k].squaredExteriorDistance(place.pixel) > farthest_ * farthest_) continue;
      for (std::size_t i = k * length + 1; i <= std::min((k + 1) * length, points_.size() - 1); ++i) {
        const Eigen::Vector2d &a = points_[i - 1].pixel, &b = points_[i].pixel;
        const auto share = meeting(a, b, place.pixel, heading);
        if (!share || (b - a).norm() > longest || !faces(b - a, place.across)) continue;
        const double offset = place.across.dot(a + *share * (b - a) - place.pixel);
        if (std::abs(offset) < std::abs(nearest.value_or(farthest_))) nearest = offset;
      }
    }
    return nearest;
  }

 private:
  // Returns true if an edge in this direction has the arm on the same side as the point has.
  [[nodiscard]] bool faces(const Eigen::Vector2d& way, const Eigen::Vector2d& across) const {
    constexpr double roughly = 0.5;
    const Eigen::Vector2d out = right_ * Eigen::Vector2d(-way.y(), way.x());
    return right_ == 0 || out.dot(across) > roughly * way.norm();
  }

  static constexpr std::size_t length = 16;
  static constexpr double longest = 20;  // Points farther apart, px, do not form a piece of a curve.
  const std::vector<CurvePoint>& points_;
  double farthest_, right_;
  std::vector<Eigen::AlignedBox2d> boxes_;  // Bounding box of each piece's points and the next piece's first.
};

// Returns the offset of the nearest measured point. Used for unmeasured points, at the ends and behind
// occluders, if cameras are wrong.
double offset_near(const std::vector<Place>& places, const std::vector<double>& shares, std::size_t k) {
  double offset = 0, nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double distance = std::abs(shares[i] - shares[k]);
    if (places[i].offset && distance < nearest) nearest = distance, offset = *places[i].offset;
  }
  return offset;
}

// Returns the offset of the nearest measured point on the same edge. Points of one edge have every other
// index.
double offset_beside(const std::vector<std::optional<double>>& offsets, std::size_t i) {
  for (std::size_t apart = 2; apart < offsets.size(); apart += 2) {
    if (apart <= i && offsets[i - apart]) return *offsets[i - apart];
    if (i + apart < offsets.size() && offsets[i + apart]) return *offsets[i + apart];
  }
  return 0;
}

}  // namespace

std::optional<Eigen::Matrix2Xd> measured_pixels(const Arm& arm, const ArmState& estimate,
                                                const Observation& seen, const std::vector<double>& shares) {
  const Backbone backbone(arm, estimate);
  std::vector<Place> places(shares.size());
  const CurveStretches axis(seen.points, farthest_in(seen), 0);
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const double s = std::min(arc_length_of(arm, estimate, material_point(arm, shares[k] * arm.length())),
                              backbone.length());
    const Pose X_WS = backbone.pose(s);
    const double ahead = 1e-4 * backbone.length();
    const auto at = seen.view.project(X_WS.position),
               next = seen.view.project(X_WS.position + ahead * X_WS.rotation.col(2));
    if (!at || !next) return std::nullopt;
    places[k].pixel = *at;
    const Eigen::Vector2d way = *next - *at;
    if (!(way.norm() > 0)) continue;
    places[k].across = Eigen::Vector2d(-way.y(), way.x()) / way.norm();
    places[k].offset = axis.offset(places[k]);
  }
  Eigen::Matrix2Xd pixels(2, static_cast<Eigen::Index>(shares.size()));
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const double unseen = seen.view_prior.is_any() ? 0 : offset_near(places, shares, k);
    const double offset = places[k].offset.value_or(unseen);
    pixels.col(static_cast<Eigen::Index>(k)) = places[k].pixel + offset * places[k].across;
  }
  return pixels;
}

void measured_edges(const ContourImage& contour, const Observation& seen,
                    Eigen::Ref<Eigen::Matrix2Xd> pixels) {
  const double farthest = farthest_in(seen);
  const std::array<CurveStretches, 2> edges = {CurveStretches(seen.edges[0], farthest, 1),
                                               CurveStretches(seen.edges[1], farthest, -1)};
  const auto offset_at = [&](Eigen::Index i) {
    std::optional<double> nearest;
    if (!contour.has(i)) return nearest;
    // Checks both edges: in one picture, tip and base may be swapped, and right and left.
    for (const CurveStretches& edge : edges) {
      const auto offset = edge.offset({contour.pixels.col(i), contour.normals.col(i), {}});
      if (offset && std::abs(*offset) < std::abs(nearest.value_or(farthest))) nearest = offset;
    }
    return nearest;
  };
  const Eigen::Index count = contour.pixels.cols();
  std::vector<std::optional<double>> offsets;
  offsets.reserve(static_cast<std::size_t>(count));
  for (Eigen::Index i = 0; i < count; ++i) offsets.push_back(offset_at(i));
  for (Eigen::Index i = 0; i < count; ++i) {
    const double unseen = seen.view_prior.is_any() ? 0 : offset_beside(offsets, static_cast<std::size_t>(i));
    pixels.col(i) = contour.pixels.col(i) +
                    offsets[static_cast<std::size_t>(i)].value_or(unseen) * contour.normals.col(i);
  }
}

}  // namespace flexura
