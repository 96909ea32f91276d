#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "flexura/render/quick_picture.h"

namespace flexura {
namespace {

// The edge of a ring whose axis is seen at an angle. Near the contour it runs along the contour. At d px
// inside, it is slope sqrt(2 r d) px along the tube from their meeting point (docs/renderer.md).
struct RingAspect {
  double sine = 0, slope = 0;

  explicit RingAspect(double cosine) {
    const double bounded = std::min(cosine, 0.95);
    sine = std::sqrt(1 - bounded * bounded), slope = bounded / sine;
  }
  // Largest distance from a pixel, m along the tube, of an edge that divides it.
  [[nodiscard]] double reach(double radius, double pixel) const {
    return pixel * (1 / sine + slope * std::sqrt(2.8 * radius / pixel));
  }
  // Distance inside the contour, m, within which a straight line is too inaccurate: the error of the mean
  // over a pixel is 1/24 of the second derivative.
  [[nodiscard]] double bent_reach(double radius, double pixel) const {
    constexpr double most = 0.004;  // px
    // On thick arms these pixels are few, and sample points, with an error of a hundredth, are no better.
    if (slope * pixel <= 0.02 * radius) return 0;
    return std::min(radius, std::pow(slope * std::sqrt(2 * radius / pixel) / (96 * most), 2.0 / 3) * pixel);
  }
};

// Computes the edge as seen from around the middle of the piece, for the steepest view.
RingAspect steepest_aspect(const TubePiece& piece) {
  const Eigen::Vector3d center = piece.p_CP + piece.R_CP * piece.bound_center;
  const double along = std::abs((piece.R_CP * piece.bound_center).normalized().dot(center.normalized()));
  return RingAspect(along + 0.5 * piece.curvature * piece.length + 2 * piece.widest() / center.z());
}

// Returns whether the plane of an edge outside the piece leaves both its ends on one side.
bool is_clear_of(const RingEdge& edge, const TubePiece& piece) {
  const double slack = 1e-6 * piece.widest();
  const bool is_before = edge.s<piece.s - slack, is_after = edge.s> piece.s + piece.length + slack;
  if (!is_before && !is_after) return true;
  const auto is_clear = [&](const Eigen::Vector3d& p_P, const Eigen::Vector3d& tangent_P) {
    const Eigen::Vector3d& normal = edge.circle.normal;
    const double beyond = normal.dot(piece.p_CP + piece.R_CP * p_P - edge.circle.center);
    const double tilt = piece.widest() * normal.cross(piece.R_CP * tangent_P).norm() - slack;
    return is_before ? beyond > tilt : beyond < -tilt;
  };
  return is_clear({0, 0, 0}, {0, 0, 1}) && is_clear(2 * piece.bound_center, piece.end_tangent);
}

Color albedo_at(const ArmLook& arm, double s) {
  for (std::size_t i = arm.markers.size(); i-- > 0;)
    if (s >= arm.markers[i].s_from && s < arm.markers[i].s_to) return arm.markers[i].albedo;
  return arm.albedo;
}

}  // namespace

// Adds the planes of marker edges at the piece and their colour changes. Returns false if an edge beyond its
// ends cuts it, where the arm turns sharply. Also if rings finer than pixels are seen aslant.
bool QuickPicture::add_edges(const Stage& stage, const TubePiece& piece, Skin& skin) {
  skin.first_edge = edges_.size();
  const Body& body = stage.bodies[static_cast<std::size_t>(piece.body)];
  if (body.is_etalon) return add_lines(stage, piece, skin);
  const ArmLook& arm = stage.scene->arm;
  const double pixel = static_cast<double>(skin.piece.reach) / 0.9;
  const double margin = std::max(8 * pixel, steepest_aspect(piece).reach(piece.widest(), pixel));
  const auto& rings = stage.ring_edges;
  const auto begin = std::ranges::lower_bound(rings, piece.s - margin, {}, &RingEdge::s);
  const auto end = std::ranges::upper_bound(rings, piece.s + piece.length + margin, {}, &RingEdge::s);
  Color before = albedo_at(arm, begin == end ? piece.s + 0.5 * piece.length : std::nextafter(begin->s, -1e9));
  set_channels(before, skin.piece.albedo);
  bool is_fine = false;
  double s_before = -std::numeric_limits<double>::infinity();
  for (auto ring = begin; ring != end; ++ring) {
    // Among several edges at one position the last one determines the colour. Faces of disks do not change
    // the colour.
    if (ring->is_disk || std::any_of(ring + 1, end, [&](const RingEdge& other) {
          return !other.is_disk && other.s <= ring->s;
        }))
      continue;
    if (!is_clear_of(*ring, piece)) return false;
    const Circle& circle = ring->circle;
    const RingAspect aspect(std::abs(circle.normal.dot(circle.center.normalized())) +
                            2 * piece.widest() / circle.center.z());
    skin.piece.bent_reach = std::max(skin.piece.bent_reach, number(aspect.bent_reach(piece.widest(), pixel)));
    // The sample points of a pixel do not resolve rings finer than a pixel.
    constexpr double finest = 1.5;  // px
    is_fine = is_fine || aspect.sine * (ring->s - s_before) < finest * pixel;
    if (is_fine && skin.piece.bent_reach > skin.piece.reach) return false;
    s_before = ring->s;
    const Color after = albedo_at(arm, ring->s);
    const Eigen::Vector3d normal = piece.R_CP.transpose() * circle.normal;
    SpanEdge edge{};
    for (Eigen::Index i = 0; i < 3; ++i) edge.normal[i] = number(normal[i]);
    edge.offset = number(circle.normal.dot(circle.center - piece.p_CP));
    edge.far = number(aspect.reach(piece.widest(), pixel));
    set_channels(after - before, edge.change);
    edges_.push_back(edge);
    before = after;
  }
  skin.piece.edge_count = edges_.size() - skin.first_edge;
  return true;
}

// Adds the planes of the edges of the etalon's lines and their colour changes; opposite lines lie between the
// same two. Returns false for lines that are too fine or too wide.
bool QuickPicture::add_lines(const Stage& stage, const TubePiece& piece, Skin& skin) {
  const Etalon& etalon = *stage.scene->etalon;
  skin.piece.edge_count = 0;
  set_channels(etalon.albedo, skin.piece.albedo);
  if (!(etalon.line_width > 0)) return true;
  const double pixel = static_cast<double>(skin.piece.reach) / 0.9;
  const double half_angle = 0.5 * etalon.line_width / etalon.radius;
  // The sample points of a pixel do not resolve lines finer than a pixel; wide lines merge.
  constexpr double finest = 1.5, widest = 0.7;  // px, rad
  if (etalon.line_width < finest * pixel || half_angle > widest) return false;
  // At d px inside the contour, an edge deviates from a straight line by x^2 / (4 d) within x px.
  constexpr double bent = 6;  // px
  skin.piece.bent_reach = std::max(skin.piece.reach, number(std::min(piece.widest(), bent * pixel)));
  for (const int axis : {0, 2}) {
    const Eigen::Vector3d normal = piece.R_CP.transpose() * stage.X_CE.rotation.col(axis);
    for (const double side : {-1.0, 1.0}) {
      SpanEdge& edge = edges_.emplace_back();
      for (Eigen::Index i = 0; i < 3; ++i) edge.normal[i] = number(normal[i]);
      edge.offset = number(side * etalon.radius * std::sin(half_angle));
      edge.far = number(pixel + std::sqrt(2.8 * piece.widest() * pixel));
      set_channels(-side * (etalon.line_albedo - etalon.albedo), edge.change);
    }
  }
  skin.piece.edge_count = edges_.size() - skin.first_edge;
  return true;
}

void QuickPicture::set_channels(const Color& color, float (&channels)[3]) const {
  for (std::size_t c = 0; c < channels_; ++c)
    channels[c] = number(channels_ == 1 ? gray_of(color) : color[static_cast<Eigen::Index>(c)]);
}

}  // namespace flexura
