#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "flexura/render/quick_picture.h"

namespace flexura {
namespace {

// A linear function of the image with this value and these changes per pixel, times `scale`.
Linear linear(double value, double by_u, double by_v, double scale = 1) {
  return {number(scale * value), number(scale * by_u), number(scale * by_v)};
}

// Sets the numbers of Newton steps, and the limits on the last step, for which the parabolas of H are
// accurate enough. The first steps lead to the minimum of H, from `start` radii away, with an error of a
// tenth of a pixel in the contour. The next steps lead from the parabola's entry to the entry. `bend` is
// curvature * radius; `pixels` is the radius in pixels. The error of a parabola is due to the third
// derivative.
void plan_steps(double bend, double start, double pixels, SpanPiece& span) {
  constexpr int most = 6;
  const double largest = std::cbrt(0.1 / (std::max(bend, 1e-6) * pixels));
  span.centering = 1;
  for (double move = start; move > largest && span.centering < most; move *= 1.5 * bend * move)
    ++span.centering;
  span.largest_move = number(largest * static_cast<double>(span.radius));
  constexpr double settled = 3e-3;
  span.refining = 1;
  for (double move = 0.5 * bend; move > 0.7 * settled && span.refining < most; move *= 0.5 * move)
    ++span.refining;
  span.settled = number(settled * static_cast<double>(span.radius));
}

// Returns the smallest distance between the segments from p to p + u and from q to q + v.
double distance_between(const Eigen::Vector3d& p, const Eigen::Vector3d& u, const Eigen::Vector3d& q,
                        const Eigen::Vector3d& v) {
  const Eigen::Vector3d w = p - q;
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), uw = u.dot(w), vw = v.dot(w);
  const double scale = uu * vv - uv * uv;
  double a = scale > 1e-12 * uu * vv ? std::clamp((uv * vw - vv * uw) / scale, 0.0, 1.0) : 0.0;
  const double b = vv > 0 ? std::clamp((uv * a + vw) / vv, 0.0, 1.0) : 0.0;
  if (uu > 0) a = std::clamp((uv * b - uw) / uu, 0.0, 1.0);
  return (w + a * u - b * v).norm();
}

bool do_meet(const TubePiece& one, const TubePiece& other) {
  const double reach = one.widest() + other.widest();
  const Eigen::Vector3d middle = one.R_CP * one.bound_center, other_middle = other.R_CP * other.bound_center;
  const double apart = (one.p_CP + middle - other.p_CP - other_middle).norm();
  if (apart > one.bound_radius + other.bound_radius) return false;
  const auto sagitta = [](const TubePiece& piece) {
    return piece.length * piece.length * piece.curvature / 8;
  };
  return distance_between(one.p_CP, 2 * middle, other.p_CP, 2 * other_middle) <
         reach + sagitta(one) + sagitta(other);
}

// Returns whether the stage contains the etalon and otherwise only screens.
bool is_etalon_alone(const Stage& stage) {
  return stage.pieces.size() == 1 && stage.planes.empty() &&
         std::ranges::all_of(stage.faces, [](const FacePart& face) { return face.screen >= 0; });
}

// Returns whether the fast path supports the bend and taper of a piece.
bool is_gentle(const TubePiece& piece) {
  return piece.curvature * piece.widest() < 0.5 && std::abs(piece.widening) < 0.1;
}

// Returns the curvature of a piece's axis at its start or end: towards the circle's centre, in C, 1/m.
Eigen::Vector3d curvature_at(const TubePiece& piece, bool is_at_end) {
  const Eigen::Vector3d towards = is_at_end
                                      ? Eigen::Vector3d(piece.end_tangent.z(), 0, -piece.end_tangent.x())
                                      : Eigen::Vector3d(1, 0, 0);
  return piece.curvature * (piece.R_CP * towards);
}

// Returns the distance along the axis from a joint, m, within which contours are left to the reference path;
// `pixel` is the pixel size. Where bend or taper change, the contours of the two arcs differ. 0 if the same
// arc continues, at a true end, and where they differ too little to be visible.
double kink_of(const Stage& stage, const TubePiece& piece, int neighbour, double pixel) {
  if (neighbour < 0) return 0;
  const TubePiece& other = stage.pieces[static_cast<std::size_t>(neighbour)];
  if (other.tube_arc == piece.tube_arc) return 0;
  // Range of the skin's slope along the axis, over the directions around the axis of a bent arc.
  const auto spread = [](const TubePiece& one) {
    const double bend = one.curvature * one.widest();
    return std::abs(one.widening) * bend / (1 - std::min(bend, 0.5));
  };
  const double change = std::abs(other.widening - piece.widening) + spread(piece) + spread(other);
  // If the tube is seen at the angle a from the axis, a difference of slopes shifts the contour by cot^2 a
  // radii times this difference.
  const bool is_at_end = neighbour == piece.after;
  const Eigen::Vector3d p_PJ = is_at_end ? 2 * piece.bound_center : Eigen::Vector3d(0, 0, 0);
  const Eigen::Vector3d tangent = is_at_end ? piece.end_tangent : Eigen::Vector3d(0, 0, 1);
  const double cosine = tangent.dot((p_PJ - piece.p_PC).normalized()),
               square = std::min(cosine * cosine, 0.96);
  // Pixels at the joint extend up to one pixel beyond it, so that a change of curvature shifts a contour by
  // up to half this many pixels. An elastic arm is drawn as many arcs of almost the same curvature.
  constexpr double invisible = 5e-4;
  const Eigen::Vector3d bend = curvature_at(piece, is_at_end) - curvature_at(other, !is_at_end);
  if (change == 0 && bend.norm() * pixel <= invisible * (1 - square)) return 0;
  return pixel + piece.widest() * change * std::max(2.0, square / (1 - square));
}

// Returns whether a screen reaches into a ball.
bool meets_screen(const Stage& stage, const Eigen::Vector3d& center, double radius) {
  return std::ranges::any_of(stage.faces, [&](const FacePart& part) {
    if (part.screen < 0) return false;
    const auto& corners = part.face.corners;
    const Eigen::Vector3d from = center - 0.5 * (corners[0] + corners[2]);
    return std::abs(part.face.normal.dot(from)) < radius &&
           from.norm() < 0.5 * (corners[2] - corners[0]).norm() + radius;
  });
}

}  // namespace

bool QuickPicture::plan_pieces(const Stage& stage) {
  skin_count_ = 0;
  edges_.clear();
  find_meetings(stage);
  if (!std::ranges::all_of(stage.pieces, [&](const TubePiece& piece) { return plan_piece(stage, piece); }))
    return false;
  // Where neighbouring pieces overlap at equal depth, the piece drawn first remains. The order is from the
  // top of the picture.
  by_row_.clear();
  for (std::size_t i = 0; i < skin_count_; ++i) {
    skins_[i].piece.edges = edges_.data() + skins_[i].first_edge;
    by_row_.push_back(i);
  }
  std::ranges::sort(by_row_, {}, [this](std::size_t i) { return std::pair(skins_[i].rows.begin, i); });
  return true;
}

// Finds pieces of the arm that intersect without being neighbours. Their surfaces then end in a line that is
// not a contour. Slightly bent arcs do not return to themselves within 2.5 radii of arc length.
void QuickPicture::find_meetings(const Stage& stage) {
  const auto& pieces = stage.pieces;
  meets_.assign(pieces.size(), 0);
  const auto is_arm = [&](const TubePiece& piece) {
    return stage.bodies[static_cast<std::size_t>(piece.body)].is_arm;
  };
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!is_arm(pieces[i])) continue;
    bool is_gentle_between = true;
    for (std::size_t j = i + 1; j < pieces.size() && is_arm(pieces[j]); ++j) {
      const double gap = pieces[j].s - (pieces[i].s + pieces[i].length);
      const bool is_near = gap < 1.25 * (pieces[i].widest() + pieces[j].widest());
      const bool is_next = j == i + 1 || (is_near && is_gentle_between);
      if (!is_next && do_meet(pieces[i], pieces[j])) meets_[i] = meets_[j] = 1;
      is_gentle_between = is_gentle_between && is_gentle(pieces[j]);
    }
  }
}

bool QuickPicture::is_drawn_skin(const Stage& stage, const TubePiece& piece) const {
  const Body& body = stage.bodies[static_cast<std::size_t>(piece.body)];
  if (body.is_etalon) return is_etalon_alone(stage);
  return body.is_arm && meets_[static_cast<std::size_t>(&piece - stage.pieces.data())] == 0;
}

bool QuickPicture::plan_piece(const Stage& stage, const TubePiece& piece) {
  const Eigen::Vector3d end = piece.p_CP + piece.R_CP * (2 * piece.bound_center);
  const double widest = piece.widest();
  const Eigen::Vector3d center = piece.p_CP + piece.R_CP * piece.bound_center;
  const Eigen::Vector3d chord = (end - piece.p_CP).normalized();
  const double slant = chord.dot(center.normalized());
  // The bounding volume is centred between chord and arc. The skin extends beyond the chord's ends for two
  // reasons: the planes there are tilted, and a ray needs some way from the axis to the skin.
  const double turn = piece.curvature * piece.length, sagitta = piece.length * turn / 8;
  const Eigen::Vector3d chord_P = piece.bound_center.normalized();
  const Eigen::Vector3d aside = piece.R_CP * Eigen::Vector3d(-chord_P.z(), 0, chord_P.x()) * (0.5 * sagitta);
  const double steepest = std::min(0.95, std::abs(slant) + 0.1);
  const double lean = 1.2 * std::tan(0.5 * turn) + steepest / std::sqrt(1 - steepest * steepest);
  const auto region = ImageRegion::of(intrinsics_, piece.p_CP + aside, end + aside, widest + 0.5 * sagitta,
                                      piece.is_ball ? 2 * widest : widest * (lean + 0.1));
  if (!region) return false;
  // An etalon's lines are wide. Seen at a small angle to the axis they are bent more than the sample points
  // of a pixel resolve.
  const bool is_etalon = stage.bodies[static_cast<std::size_t>(piece.body)].is_etalon;
  const double most_slant = is_etalon ? 0.5 : 0.9;  // Squares of cosines.
  bool is_quick = is_drawn_skin(stage, piece) && !piece.is_ball && slant * slant < most_slant &&
                  is_gentle(piece) && center.z() > 4 * piece.bound_radius && is_near_picture(center) &&
                  !meets_screen(stage, center, piece.bound_radius);
  if (is_quick) {
    if (skin_count_ == skins_.size()) skins_.emplace_back();
    Skin& skin = skins_[skin_count_];
    fill_span_piece(stage, piece, skin);
    // At least two pixels across the radius, so that a pixel with one contour does not reach over the axis to
    // the other. Also limited above, as single precision and the overlap beyond an end would become visible.
    constexpr float most_pixels = 700;
    is_quick = 2.1F * skin.piece.reach < number(piece.narrowest()) &&
               number(widest) < most_pixels * skin.piece.reach && add_edges(stage, piece, skin);
  }
  if (!is_quick) {
    leave(*region);
    return true;
  }
  Skin& skin = skins_[skin_count_++];
  skin.index = static_cast<int>(&piece - stage.pieces.data());
  skin.before = skin.piece.kink_before > 0 ? -1 : piece.before;
  skin.after = skin.piece.kink_after > 0 ? -1 : piece.after;
  skin.piece.rims = 0;
  skin.region = *region;
  skin.rows = map_.rows(*region);
  skin.contour.clear();
  return true;
}

void QuickPicture::fill_span_piece(const Stage& stage, const TubePiece& piece, Skin& skin) const {
  const Eigen::Vector3d center = piece.p_CP + piece.R_CP * piece.bound_center;
  const Eigen::Matrix3d R_PC = piece.R_CP.transpose();
  SpanPiece& span = skin.piece;
  const Eigen::Vector2d pixel = pixel_of(center);
  const double u0 = pixel.x(), v0 = pixel.y();
  span.u0 = number(u0), span.v0 = number(v0);
  span.depth0 = number(center.z());
  const auto depth0 = static_cast<double>(span.depth0);
  const Eigen::Vector3d d = R_PC * straight_ray(intrinsics_, u0, v0).direction;
  const Eigen::Vector3d by_u = R_PC.col(0) / intrinsics_.fx, by_v = R_PC.col(1) / intrinsics_.fy;
  const Eigen::Vector3d start = piece.p_PC + depth0 * d;
  const Light& light = stage.scene->light;
  const Eigen::Vector3d towards = R_PC * stage.light * (light.directional / piece.radius);
  for (Eigen::Index i = 0; i < 3; ++i) {
    span.direction[i] = linear(d[i], by_u[i], by_v[i]);
    span.point[i] = linear(start[i], depth0 * by_u[i], depth0 * by_v[i]);
    span.light[i] = number(towards[i]);
  }
  // The plane half-way between chord and arc.
  const Eigen::Vector3d chord = piece.bound_center.normalized(), aside(-chord.z(), 0, chord.x());
  const double half_sagitta = piece.length * piece.length * piece.curvature / 16;
  const Eigen::Vector3d middle = piece.bound_center + half_sagitta * aside;
  const Eigen::Vector3d normal = (d - d.dot(chord) * chord).normalized();
  const double rise = normal.dot(d), scale = -1 / rise;
  span.way = linear(normal.dot(start - middle), depth0 * normal.dot(by_u), depth0 * normal.dot(by_v), scale);
  span.curvature = number(piece.curvature), span.radius = number(piece.radius);
  span.widening = number(piece.widening), span.widest = number(piece.widest());
  span.end_sine = number(piece.end_tangent.x()), span.end_cosine = number(piece.end_tangent.z());
  span.end_offset = number(piece.end_offset);
  const double size = (center.z() + piece.bound_radius) * pixel_;
  span.reach = span.bent_reach = number(0.9 * size);
  span.kink_before = number(kink_of(stage, piece, piece.before, size));
  span.kink_after = number(kink_of(stage, piece, piece.after, size));
  // The height of the rays over that plane changes across the image.
  const double bend = piece.curvature * piece.widest(), slant = std::abs(d.dot(chord)) / rise;
  const double width = piece.bound_radius * piece.bound_radius / center.z();
  const double start_error = half_sagitta + slant * slant * width;
  plan_steps(bend, 0.05 + bend + start_error / piece.narrowest(), piece.widest() / size, span);
  span.ambient = number(light.ambient);
  span.channels = channels_;
}

void QuickPicture::draw(Skin& skin) {
  for (int v = skin.rows.begin; v < skin.rows.end; ++v) {
    const PixelRange columns = map_.columns(skin.region, v);
    if (columns.begin == columns.end) continue;
    SpanRow& row = rows_[static_cast<std::size_t>(v)];
    row.border_count = 0;
    kernels_->draw(skin.piece, columns.begin, columns.end, row);
    for (std::size_t j = 0; j < row.border_count; ++j) skin.contour.push_back({row.borders[j], v});
  }
}

}  // namespace flexura
