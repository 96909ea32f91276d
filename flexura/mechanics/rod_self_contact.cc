#include <algorithm>
#include <cmath>
#include <limits>

#include "flexura/math/so3.h"
#include "flexura/mechanics/rod_contact.h"

// Self-contact: a point's ball against a smooth curve through the other points.
namespace flexura {
namespace {

// Both sides of a self-contact report it: each point that is near another part.
constexpr double of_both_sides = 0.5;
constexpr double no_length = 1e-12;
constexpr double one_curve_place = 1e-9;
// Below this part of its value on a line, the curvature of the distance does not define a nearest point.
constexpr double no_minimum = 1e-6;
constexpr int most_halvings = 60;
constexpr std::size_t not_chosen = std::numeric_limits<std::size_t>::max();

Eigen::Matrix<double, 3, 6> moved_by_twist(const Eigen::Vector3d& p) {
  Eigen::Matrix<double, 3, 6> rows;
  rows << Eigen::Matrix3d::Identity(), -skew(p);
  return rows;
}

// Finds the u of least distance from p between u = 0, towards which the distance falls, and u = 1. Newton's
// method in a bracket.
double nearest_share(const RodCurve::Piece& curve, const Eigen::Vector3d& p) {
  double low = 0, high = 1, u = 0.5;
  for (int i = 0; i < most_halvings; ++i) {
    const Eigen::Vector3d off = p - curve.at(u), slope = curve.slope_at(u);
    const double towards = off.dot(slope), change = off.dot(curve.bend_at(u)) - slope.squaredNorm();
    (towards > 0 ? low : high) = u;
    double next = u - towards / change;
    const bool is_between = next > low && next < high;
    if (!is_between) next = 0.5 * (low + high);
    if (std::abs(next - u) < 1e-15) return next;
    u = next;
  }
  return u;
}

}  // namespace

void RodContact::set_curve(const RodChain& chain) {
  std::vector<double> s, after;
  const double rounding = one_curve_place * chain.rod().length();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!s.empty() && points_[i].s - s.back() <= rounding) {
      after.back() = points_[i].radius;
      continue;
    }
    s.push_back(points_[i].s);
    after.push_back(points_[i].radius);
    curve_points_.push_back(i);
  }
  curve_ = RodCurve(s);
  for (std::size_t k = 0; k + 1 < s.size(); ++k) {
    const std::size_t end = curve_points_[k + 1];
    stretches_.push_back({.from = s[k],
                          .to = s[k + 1],
                          .radius = after[k],
                          .end_radius = points_[end].radius,
                          .section = places_[end].section});
    spacing_ = std::max(spacing_, s[k + 1] - s[k]);
  }
}

// Chooses points of two intervals that may be near each other, and those of the curve there.
void RodContact::choose_near_itself(const Interval& one, const Interval& other, double apart) const {
  const auto beside = [&](std::size_t i) {
    const std::size_t first = i - std::min<std::size_t>(i, 3), last = std::min(i + 3, points_.size() - 1);
    for (std::size_t k = first; k <= last; ++k) is_chosen_[k] = 1;
  };
  for (std::size_t i = one.first_point; i < one.first_point + one.points; ++i) {
    for (std::size_t j = other.first_point; j < other.first_point + other.points; ++j) {
      if (!(points_[j].s - points_[i].s > apart_)) continue;
      // A place between two points is near one of them.
      const double reach =
          balls_[i].radius + balls_[j].radius + points_[i].radius + points_[j].radius + apart;
      if (!((balls_[i].middle - balls_[j].middle).squaredNorm() < reach * reach)) continue;
      beside(i);
      beside(j);
    }
  }
}

void RodContact::find_pieces(std::span<const std::size_t> chosen, std::span<const NodeMotion> points) const {
  pieces_.clear();
  std::ranges::fill(index_, not_chosen);
  for (std::size_t k = 0; k < chosen.size(); ++k) index_[chosen[k]] = k;
  for (std::size_t segment = 0; segment < curve_.segments().size(); ++segment) {
    Piece piece{.segment = segment, .places = {}, .curve = {}};
    std::array<Eigen::Vector3d, 4> at;
    bool is_there = true;
    for (std::size_t i = 0; i < 4 && is_there; ++i) {
      piece.places[i] = index_[curve_points_[curve_.segments()[segment].places[i]]];
      is_there = piece.places[i] != not_chosen;
      if (is_there) at[i] = points[piece.places[i]].pose.position;
    }
    if (!is_there) continue;
    piece.curve = RodCurve::piece(curve_.segments()[segment], at);
    pieces_.push_back(piece);
  }
}

// Finds where a point's ball meets the rest of the rod: each place that is nearer than its neighbours.
void RodContact::find_meetings(std::span<const std::size_t> chosen,
                               std::span<const NodeMotion> points) const {
  meetings_.clear();
  if (!itself_ || chosen.empty()) return;
  find_pieces(chosen, points);
  Meeting meeting;
  for (std::size_t k = 0; k < chosen.size(); ++k)
    for (const Piece& piece : pieces_)
      if (meet(piece, points, chosen[k], k, meeting)) meetings_.push_back(meeting);
}

bool RodContact::meet(const Piece& piece, std::span<const NodeMotion> points, std::size_t index,
                      std::size_t k, Meeting& meeting) const {
  const Point& point = points_[index];
  const Stretch& stretch = stretches_[piece.segment];
  const bool is_after = stretch.from - point.s > apart_, is_before = point.s - stretch.to > apart_;
  if (!is_after && !is_before) return false;
  const Eigen::Vector3d& p = points[k].pose.position;
  const double reach = piece.curve.reach + point.radius + std::max(stretch.radius, stretch.end_radius);
  if (!((p - piece.curve.middle).squaredNorm() < reach * reach)) return false;

  // Side from which the distance is least: at an end of the valid range it may be that end.
  const bool falls = (p - piece.curve.at(0)).dot(piece.curve.slope_at(0)) > 0,
             rises = !((p - piece.curve.at(1)).dot(piece.curve.slope_at(1)) > 0);
  const std::size_t last = stretches_.size() - 1;
  const bool is_first =
                 piece.segment == 0 || (is_after && !(stretches_[piece.segment - 1].from - point.s > apart_)),
             is_last = piece.segment == last ||
                       (is_before && !(point.s - stretches_[piece.segment + 1].to > apart_));
  if (!falls && !is_first) return false;
  if (!rises && !is_last) return false;
  double u = falls ? 1 : 0;
  const bool is_inside = falls && rises;
  if (is_inside) u = nearest_share(piece.curve, p);
  const Eigen::Vector3d off = p - piece.curve.at(u);
  const double distance = off.norm(), other = stretch.radius + u * (stretch.end_radius - stretch.radius);
  if (!(distance < other + point.radius)) return false;

  meeting.segment = piece.segment;
  meeting.points = {k, piece.places[0], piece.places[1], piece.places[2], piece.places[3]};
  const Eigen::Matrix4d& weights = curve_.segments()[piece.segment].weights;
  meeting.shares = weights * Eigen::Vector4d(1, u, u * u, u * u * u);
  meeting.slopes = weights * Eigen::Vector4d(0, 1, 2 * u, 3 * u * u);
  meeting.share = u;
  meeting.slope = piece.curve.slope_at(u);
  meeting.bend = piece.curve.bend_at(u);
  meeting.slides = is_inside && meeting.slope.squaredNorm() - off.dot(meeting.bend) >
                                    no_minimum * meeting.slope.squaredNorm();
  meeting.off = off;
  Touch& touch = meeting.touch;
  if (distance > no_length) {
    touch.nearest.normal = off / distance;
  } else {
    Eigen::Index least = 0;
    meeting.slope.cwiseAbs().minCoeff(&least);
    const Eigen::Vector3d across = meeting.slope.cross(Eigen::Vector3d::Unit(least));
    touch.nearest.normal =
        across.norm() > 0 ? Eigen::Vector3d(across.normalized()) : Eigen::Vector3d::UnitZ();
  }
  touch.nearest.distance = distance - other;
  touch.center = p;
  touch.radius = point.radius;
  touch.run = of_both_sides * point.run;
  meeting.arm = off - point.radius * touch.nearest.normal;
  // Velocity at the touching point; on the other side interpolated with its place.
  const auto velocity = [&](std::size_t i, const Eigen::Vector3d& at) -> Eigen::Vector3d {
    return points[i].twist.head<3>() + points[i].twist.tail<3>().cross(at);
  };
  Eigen::Vector3d faster = velocity(k, p - point.radius * touch.nearest.normal);
  for (std::size_t i = 0; i < 4; ++i)
    faster -= meeting.shares[static_cast<Eigen::Index>(i)] *
              velocity(piece.places[i], points[piece.places[i]].pose.position + meeting.arm);
  touch.twist << faster, Eigen::Vector3d::Zero();
  return true;
}

// With p the point, x_a the places, b_a(u) their shares, x = sum of b_a x_a and off = p - x: off is
// perpendicular to x' while u is inside. Hence (x' . x' - off . x'') du = x' . (dp - sum of b_a dx_a) + off .
// sum of b_a' dx_a.
RodContact::MeetingSlopes RodContact::slopes_of(std::span<const NodeMotion> points, const Meeting& meeting,
                                                const TouchForce& at) const {
  using Rows = Eigen::Matrix<double, 3, 30>;
  const Touch& touch = meeting.touch;
  const Stretch& stretch = stretches_[meeting.segment];
  const Eigen::Vector3d& n = touch.nearest.normal;
  const double distance = meeting.off.norm();
  Rows apart, shifted = Rows::Zero(), center = Rows::Zero(), twisted;
  center.leftCols<6>() = moved_by_twist(touch.center);
  apart.leftCols<6>() = center.leftCols<6>();
  twisted.leftCols<6>() = moved_by_twist(at.point);
  for (Eigen::Index i = 0; i < 4; ++i) {
    const Eigen::Vector3d& x = points[meeting.points[static_cast<std::size_t>(i) + 1]].pose.position;
    const Eigen::Matrix<double, 3, 6> moves = moved_by_twist(x);
    apart.middleCols<6>(6 * (i + 1)) = -meeting.shares[i] * moves;
    shifted.middleCols<6>(6 * (i + 1)) = meeting.slopes[i] * moves;
    twisted.middleCols<6>(6 * (i + 1)) = -meeting.shares[i] * moved_by_twist(x + meeting.arm);
  }
  MeetingSlopes slopes;
  slopes.share.setZero();
  if (meeting.slides)
    slopes.share = (meeting.slope.transpose() * apart + meeting.off.transpose() * shifted) /
                   (meeting.slope.squaredNorm() - meeting.off.dot(meeting.bend));
  TouchChange change;
  change.depth.setZero(30);
  change.normal.setZero(3, 30);
  change.velocity = twisted;
  slopes.force_by_twist = force_change(law_, touch, at, change);
  const Rows moves = apart - meeting.slope * slopes.share;  // Derivative of off.
  if (distance > no_length) change.normal = (moves - n * (n.transpose() * moves)) / distance;
  change.depth = -n.transpose() * moves + (stretch.end_radius - stretch.radius) * slopes.share;
  slopes.point = center - touch.radius * change.normal;
  slopes.moves = moves - touch.radius * change.normal;  // Derivative of the arm.
  Rows velocity = skew(points[meeting.points[0]].twist.tail<3>()) * slopes.point;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const NodeMotion& place = points[meeting.points[static_cast<std::size_t>(i) + 1]];
    const Eigen::Vector3d w = place.twist.tail<3>(), x = place.pose.position;
    Rows of_arm = slopes.moves;
    of_arm.middleCols<6>(6 * (i + 1)) += moved_by_twist(x);
    velocity -= meeting.shares[i] * skew(w) * of_arm;
    velocity -= meeting.slopes[i] * (place.twist.head<3>() + w.cross(x + meeting.arm)) * slopes.share;
  }
  change.velocity = velocity;
  slopes.force_by_pose = force_change(law_, touch, at, change);
  return slopes;
}

void RodContact::couple(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
                        std::vector<PointCoupling>& couplings) const {
  find_meetings(chosen, points);
  for (const Meeting& meeting : meetings_) {
    const TouchForce at = touch_force(law_, meeting.touch);
    const MeetingSlopes slopes = slopes_of(points, meeting, at);
    for (std::size_t i = 0; i < 5; ++i) {
      // Derivative of the wrench share [f; y x f], with y the place plus the arm.
      const auto row = static_cast<Eigen::Index>(i) - 1;
      const double share = i == 0 ? 1 : -meeting.shares[row], by_share = i == 0 ? 0 : -meeting.slopes[row];
      const Eigen::Vector3d& x = points[meeting.points[i]].pose.position;
      const Eigen::Vector3d y = i == 0 ? at.point : Eigen::Vector3d(x + meeting.arm);
      const Eigen::Vector3d moment = y.cross(at.force);
      for (std::size_t j = 0; j < 5; ++j) {
        const auto columns = 6 * static_cast<Eigen::Index>(j);
        const Eigen::Matrix<double, 3, 6> by_pose = slopes.force_by_pose.middleCols<6>(columns),
                                          by_twist = slopes.force_by_twist.middleCols<6>(columns);
        const Eigen::Matrix<double, 1, 6> slides = by_share * slopes.share.middleCols<6>(columns);
        Eigen::Matrix<double, 3, 6> moves =
            i == 0 ? slopes.point.middleCols<6>(columns) : slopes.moves.middleCols<6>(columns);
        if (i > 0 && i == j) moves += moved_by_twist(x);
        PointCoupling& coupling = couplings.emplace_back();
        coupling.of = meeting.points[j];
        coupling.at = meeting.points[i];
        coupling.by_pose << share * by_pose + at.force * slides,
            share * (skew(y) * by_pose - skew(at.force) * moves) + moment * slides;
        coupling.by_twist << share * by_twist, share * skew(y) * by_twist;
      }
    }
  }
}

void RodContact::tie(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
                     std::vector<PointTie>& ties) const {
  find_meetings(chosen, points);
  for (const Meeting& meeting : meetings_) {
    const TouchForce at = touch_force(law_, meeting.touch);
    const TouchHold hold = hold_of(law_, meeting.touch, at);
    PointTie& tie = ties.emplace_back();
    tie.points = meeting.points;
    tie.stiffness = hold.stiffness;
    tie.damping = hold.damping;
    tie.rows[0] = moved_by_twist(at.point);
    for (std::size_t i = 0; i < 4; ++i)
      tie.rows[i + 1] = -meeting.shares[static_cast<Eigen::Index>(i)] *
                        moved_by_twist(points[meeting.points[i + 1]].pose.position + meeting.arm);
  }
}

}  // namespace flexura
