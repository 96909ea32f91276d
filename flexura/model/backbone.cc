#include "flexura/model/backbone.h"

#include <fmt/format.h>

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

}  // namespace

Pose arc_pose(const Eigen::Vector2d& bend, double length) {
  const double t = bend.norm();
  return arc_pose(bend, length, sinc(t), cosc(t));
}

// so3_exp((-y, x, 0)) without its zeros. Sums that begin with 0 are never -0.
Pose arc_pose(const Eigen::Vector2d& bend, double length, double sinc_t, double cosc_t) {
  const double x = bend.x(), y = bend.y(), S = sinc_t, A = cosc_t;
  Pose end;
  end.rotation << 1 - A * x * x, 0 - A * x * y, 0 + S * x,  //
      0 - A * y * x, 1 - A * y * y, 0 + S * y,              //
      0 - S * x, 0 - S * y, 1 - (A * x * x + A * y * y);
  end.position << length * A * x, length * A * y, length * S;
  return end;
}

Pose Arc::pose(double distance) const { return X_WS * arc_pose(bend * (distance / length), distance); }

Backbone::Backbone(const Arm& arm, const ArmState& state) : X_WT_(arm.X_WB) {
  if (arm.sections.empty()) throw std::invalid_argument("an arm needs at least one section");
  require_fit(arm, state);
  arcs_.reserve(arm.sections.size());
  double s = 0.0;
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const Arc& arc =
        arcs_.emplace_back(Arc{X_WT_, s, arm.sections[i].length * state.stretches[i], state.bends[i]});
    require_usable(arc, i);
    X_WT_ = arc.pose(arc.length);
    s += arc.length;
  }
}

double Backbone::length() const { return arcs_.back().s + arcs_.back().length; }

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
