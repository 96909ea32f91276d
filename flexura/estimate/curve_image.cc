#include "flexura/estimate/curve_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "flexura/math/so3.h"

namespace flexura {

bool CurveImage::set(const View& view, const ViewError& error, const SpaceCurve& curve, Eigen::Index own,
                     Eigen::Index count_of_unknowns) {
  const Pose X_WC = {view.X_WC.rotation * so3_exp(error.turn), view.X_WC.position}, X_CW = X_WC.inverse();
  const double zoom = std::exp(error.focal);
  const double focal = zoom * std::sqrt(view.lens.intrinsics().fx * view.lens.intrinsics().fy);
  const Eigen::Vector2d center(view.lens.intrinsics().cx, view.lens.intrinsics().cy);
  // exp(turn + d) = exp(turn) exp(J(-turn) d) to first order, J the left Jacobian.
  const Eigen::Matrix3d by_turn = so3_left_jacobian(-error.turn);
  const std::size_t count = curve.knots().size();
  pieces_.resize(count - 1);
  unknowns_.resize(count);
  scales_.resize(count);
  in_section_ = curve.intervals_a_section();
  Eigen::Vector2d before, slope_before;
  for (std::size_t i = 0; i < count; ++i) {
    const SpaceCurve::Knot& point = curve.knots()[i];
    const Eigen::Vector3d p_CP = X_CW * point.position;
    const auto projection = view.lens.project_with_derivatives(p_CP);
    if (!projection) return false;
    scales_[i] = focal / p_CP.norm();
    const Eigen::Vector2d pixel = center + zoom * (projection->pixel - center);
    const Eigen::Matrix<double, 2, 3> by_place = zoom * projection->by_point,
                                      by_point = by_place * X_CW.rotation;
    const Eigen::Vector2d slope = by_point * point.tangent;
    const Eigen::Index of_shape = point.unknowns.cols();
    unknowns_[i].resize(2, std::max(count_of_unknowns, of_shape));
    unknowns_[i].leftCols(of_shape).noalias() = by_point * point.unknowns;
    unknowns_[i].rightCols(unknowns_[i].cols() - of_shape).setZero();
    if (own >= 0) {
      unknowns_[i].middleCols<3>(own) = by_place * skew(p_CP) * by_turn;
      unknowns_[i].col(own + 3) = pixel - center;
    }
    if (i > 0) {
      const double length = curve.interval(i - 1);
      pieces_[i - 1] = piece(before, length * slope_before, pixel, length * slope);
    }
    before = pixel, slope_before = slope;
  }
  return true;
}

// Returns the cubic through two points with these slopes. It lies in the convex hull of its four control
// points.
CurveImage::Piece CurveImage::piece(const Eigen::Vector2d& a, const Eigen::Vector2d& da,
                                    const Eigen::Vector2d& b, const Eigen::Vector2d& db) {
  Piece piece{a, da, 3 * (b - a) - 2 * da - db, 2 * (a - b) + da + db, 0.5 * (a + b), 0};
  const double farthest =
      std::max({(a - piece.middle).squaredNorm(), (a + da / 3 - piece.middle).squaredNorm(),
                (b - db / 3 - piece.middle).squaredNorm()});
  piece.radius = std::sqrt(farthest);
  return piece;
}

// Returns the position on the piece nearest to the pixel, from 0 to 1.
double CurveImage::foot(const Piece& piece, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d chord = 2 * (piece.middle - piece.a);
  double f = std::clamp((pixel - piece.a).dot(chord) / chord.squaredNorm(), 0.0, 1.0);
  constexpr int most = 8;
  constexpr double small = 1e-7;
  for (int step = 0; step < most; ++step) {
    const Eigen::Vector2d off = piece.at(f) - pixel, along = piece.slope(f);
    // Curvature of the distance along the curve; where it is not convex, only the tangent is used.
    const double slope = off.dot(along), square = along.squaredNorm();
    const double curving = square + off.dot(piece.bend(f));
    const double next = std::clamp(f - slope / (curving > 0.1 * square ? curving : square), 0.0, 1.0);
    const double moved = std::abs(next - f);
    f = next;
    if (!(moved > small)) break;
  }
  return std::isfinite(f) ? f : 0.0;
}

CurveImage::Point CurveImage::at(double place) const {
  const auto i = std::min(static_cast<std::size_t>(std::max(place, 0.0)), pieces_.size() - 1);
  const double f = place - static_cast<double>(i);
  const Eigen::Vector2d slope = pieces_[i].slope(f);
  const double speed = slope.norm();
  const double scale = scales_[i] + f * (scales_[i + 1] - scales_[i]);
  return {place, pieces_[i].at(f), slope / speed, speed, scale};
}

CurveImage::Point CurveImage::nearest(const Eigen::Vector2d& pixel, const Eigen::Vector2d& heading,
                                      const Window& window) const {
  // Penalty for a branch in the opposite direction, px.
  constexpr double turn_penalty = 10;
  double least = std::numeric_limits<double>::infinity(), place = static_cast<double>(window.first);
  const auto consider = [&](std::size_t i) {
    const Piece& piece = pieces_[i];
    // Everything inside a disc that is farther away is farther away.
    const double away = (pixel - piece.middle).norm() - piece.radius;
    if (away > 0 && away * away >= least) return;
    const double f = foot(piece, pixel);
    const double turned = turn_penalty * (1 - heading.dot(piece.slope(f).normalized()));
    const double distance = (piece.at(f) - pixel).squaredNorm() + turned * turned;
    if (distance < least) least = distance, place = static_cast<double>(i) + f;
  };
  const std::size_t last = std::min(window.last, pieces_.size());
  if (window.first <= window.likely && window.likely < last) consider(window.likely);
  for (std::size_t i = window.first; i < last; ++i)
    if (i != window.likely) consider(i);
  return at(place);
}

// Quadratic through three knots of the section: derivatives have kinks where sections meet.
void CurveImage::along(const Eigen::Vector2d& direction, double place,
                       Eigen::Ref<Eigen::RowVectorXd> row) const {
  const auto i = std::min(static_cast<std::size_t>(std::max(place, 0.0)), pieces_.size() - 1);
  const std::size_t section = i - i % in_section_;
  const bool is_late = place - static_cast<double>(i) >= 0.5;
  const std::size_t first =
      std::clamp(is_late ? i : std::max<std::size_t>(i, 1) - 1, section, section + in_section_ - 2);
  const double f = place - static_cast<double>(first);
  const Eigen::Vector2d a = 0.5 * (f - 1) * (f - 2) * direction, b = f * (2 - f) * direction,
                        c = 0.5 * f * (f - 1) * direction;
  const Unknowns &by_a = unknowns_[first], &by_b = unknowns_[first + 1], &by_c = unknowns_[first + 2];
  row = a.x() * by_a.row(0) + a.y() * by_a.row(1) + b.x() * by_b.row(0) + b.y() * by_b.row(1) +
        c.x() * by_c.row(0) + c.y() * by_c.row(1);
}

}  // namespace flexura
