#include "flexura/model/backbone.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "flexura/math/series.h"

namespace flexura {
namespace {

void require_usable(const Arc& arc, std::size_t index) {
  if (!arc.bend.allFinite()) {
    throw std::invalid_argument(
        fmt::format("section {}: the bend ({}, {}) is not finite", index + 1, arc.bend.x(), arc.bend.y()));
  }
  if (!(arc.length > 0.0) || !std::isfinite(arc.length)) {
    throw std::invalid_argument(
        fmt::format("section {}: the stretched length {} is not a positive number", index + 1, arc.length));
  }
}

void require_usable(const BackboneSample& sample, std::size_t index) {
  if (sample.X_WS.position.allFinite() && sample.X_WS.rotation.allFinite() && std::isfinite(sample.s_rest) &&
      std::isfinite(sample.radius) && sample.radius > 0)
    return;
  throw std::invalid_argument(
      fmt::format("sample {} of the backbone is not finite, or has a radius that is not positive", index));
}

// Returns the arc that starts at the frame `X_WS` and ends at the point `p_WP`.
Arc arc_to(const Pose& X_WS, const Eigen::Vector3d& p_WP) {
  const Eigen::Vector3d p_SP = X_WS.inverse() * p_WP;
  const double across = p_SP.head<2>().norm();
  const double half = std::atan2(across, p_SP.z());
  Arc arc;
  arc.X_WS = X_WS;
  arc.length = p_SP.norm() / sinc(half);
  if (across > 0) arc.bend = p_SP.head<2>() * (2 * half / across);
  return arc;
}

// Returns the rotation from `from` to `to` about their common tangent, rad.
double turn_about_tangent(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
  constexpr double rounding = 1e-12;
  const double turn = std::atan2(from.col(1).dot(to.col(0)), from.col(0).dot(to.col(0)));
  return std::abs(turn) < rounding ? 0 : turn;
}

// Adds the two arcs of the biarc between two samples. Both arcs have equal tangent lengths to their joint (K.
// M. Bolton, "Biarc curves", 1975).
void join(const BackboneSample& from, const BackboneSample& to, std::size_t index, std::vector<Arc>& arcs) {
  const Eigen::Vector3d chord = to.X_WS.position - from.X_WS.position;
  const Eigen::Vector3d t0 = from.X_WS.rotation.col(2), t1 = to.X_WS.rotation.col(2);
  const double along = chord.dot(t0 + t1), square = chord.squaredNorm();
  if (!(to.s_rest > from.s_rest) || !(square > 0) || !(chord.dot(t0) > 0) || !(chord.dot(t1) > 0)) {
    throw std::invalid_argument(fmt::format(
        "samples {} and {} of the backbone have equal positions, decreasing s_rest or a reversed tangent",
        index, index + 1));
  }
  const double d = square / (along + std::sqrt(along * along + (t0 - t1).squaredNorm() * square));
  const Eigen::Vector3d middle = 0.5 * (from.X_WS.position + to.X_WS.position + d * (t0 - t1));
  Arc first = arc_to(from.X_WS, middle);
  Arc second = arc_to(first.pose(first.length), to.X_WS.position);
  const double share = first.length / (first.length + second.length);
  const double turn = turn_about_tangent(second.pose(second.length).rotation, to.X_WS.rotation);
  if (turn != 0) {
    first.twist = share * turn;
    second = arc_to(first.pose(first.length), to.X_WS.position);
    second.twist = turn - first.twist;
  }
  const double rest = to.s_rest - from.s_rest, radius = from.radius + share * (to.radius - from.radius);
  first.s = arcs.empty() ? 0 : arcs.back().s + arcs.back().length;
  first.s_rest = from.s_rest, first.rest_length = share * rest, first.radius = {from.radius, radius};
  second.s = first.s + first.length;
  second.s_rest = from.s_rest + first.rest_length, second.rest_length = rest - first.rest_length;
  second.radius = {radius, to.radius};
  first.section = second.section = from.section;
  arcs.push_back(first);
  arcs.push_back(second);
}

}  // namespace

Pose arc_pose(const Eigen::Vector2d& bend, double length) {
  const double t = bend.norm();
  return arc_pose(bend, length, sinc(t), cosc(t));
}

// so3_exp((-y, x, 0)) without the terms that are zero. Sums that begin with 0 are never -0.
Pose arc_pose(const Eigen::Vector2d& bend, double length, double sinc_t, double cosc_t) {
  const double x = bend.x(), y = bend.y(), S = sinc_t, A = cosc_t;
  Pose end;
  end.rotation << 1 - A * x * x, 0 - A * x * y, 0 + S * x,  //
      0 - A * y * x, 1 - A * y * y, 0 + S * y,              //
      0 - S * x, 0 - S * y, 1 - (A * x * x + A * y * y);
  end.position << length * A * x, length * A * y, length * S;
  return end;
}

Pose Arc::carried(double distance) const { return X_WS * arc_pose(bend * (distance / length), distance); }

Pose Arc::pose(double distance) const {
  Pose X = carried(distance);
  if (twist == 0) return X;
  const double turn = twist * (distance / length), cosine = std::cos(turn), sine = std::sin(turn);
  const Eigen::Vector3d x = X.rotation.col(0), y = X.rotation.col(1);
  X.rotation.col(0) = cosine * x + sine * y;
  X.rotation.col(1) = cosine * y - sine * x;
  return X;
}

Backbone::Backbone(const Arm& arm, const ArmState& state) : X_WT_(arm.X_WB) {
  if (arm.sections.empty()) throw std::invalid_argument("an arm needs at least one section");
  require_fit(arm, state);
  arcs_.reserve(arm.sections.size());
  double s = 0.0, s_rest = 0.0;
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const Section& section = arm.sections[i];
    const Arc& arc = arcs_.emplace_back(Arc{.X_WS = X_WT_,
                                            .s = s,
                                            .length = section.length * state.stretches[i],
                                            .bend = state.bends[i],
                                            .s_rest = s_rest,
                                            .rest_length = section.length,
                                            .radius = section.radius,
                                            .section = i});
    require_usable(arc, i);
    X_WT_ = arc.pose(arc.length);
    s += arc.length, s_rest += section.length;
  }
}

Backbone Backbone::through(std::span<const BackboneSample> samples) {
  if (samples.size() < 2) throw std::invalid_argument("a backbone needs at least two samples");
  for (std::size_t i = 0; i < samples.size(); ++i) require_usable(samples[i], i);
  Backbone backbone;
  backbone.arcs_.reserve(2 * (samples.size() - 1));
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) join(samples[i], samples[i + 1], i, backbone.arcs_);
  backbone.X_WT_ = samples.back().X_WS;
  return backbone;
}

Backbone::Backbone(const Arm& arm, const ArmState& state, std::span<const std::size_t> section_of)
    : Backbone(arm, state) {
  if (section_of.size() != arcs_.size())
    throw std::invalid_argument("a backbone of parts needs the section of each part");
  for (std::size_t i = 0; i < arcs_.size(); ++i) arcs_[i].section = section_of[i];
}

double Backbone::length() const { return arcs_.back().s + arcs_.back().length; }

double Backbone::rest_length() const {
  return arcs_.back().s_rest + arcs_.back().rest_length - arcs_.front().s_rest;
}

double Backbone::s_at_rest(double s_rest) const {
  for (const Arc& arc : arcs_)
    if (s_rest <= arc.s_rest + arc.rest_length)
      return arc.s + std::max(s_rest - arc.s_rest, 0.0) * (arc.length / arc.rest_length);
  return length();
}

double Backbone::s_rest_at(double s) const {
  for (const Arc& arc : arcs_)
    if (s <= arc.s + arc.length) return arc.s_rest + std::max(s - arc.s, 0.0) / arc.length * arc.rest_length;
  return arcs_.back().s_rest + arcs_.back().rest_length;
}

Pose Backbone::pose(double s) const {
  const double tolerance = 1e-12 * length();
  const bool inside = s >= -tolerance && s <= length() + tolerance;
  if (!inside) {
    throw std::out_of_range(fmt::format("arc length {} is outside [0, {}]", s, length()));
  }
  if (s <= 0.0) return arcs_.front().X_WS;
  if (s >= length()) return X_WT_;
  const auto next = std::ranges::upper_bound(arcs_, s, {}, &Arc::s);
  const Arc& arc = *(next - 1);
  return arc.pose(s - arc.s);
}

}  // namespace flexura
