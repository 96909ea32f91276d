#include "flexura/render/tube.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "flexura/math/series.h"

namespace flexura {
namespace {

// The arc from `X_WS` to `p_WP`, both on it.
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

void require_usable(const TubeSample& sample, std::size_t index) {
  if (sample.X_WS.position.allFinite() && sample.X_WS.rotation.allFinite() && std::isfinite(sample.s) &&
      std::isfinite(sample.radius))
    return;
  throw std::invalid_argument(fmt::format("sample {} of the backbone is not finite", index));
}

// Both halves of the biarc between two samples: the two arcs have equal tangents to the point where they meet
// (K. M. Bolton, "Biarc curves", 1975).
void join(const TubeSample& from, const TubeSample& to, std::size_t index, std::vector<TubeArc>& tube) {
  const Eigen::Vector3d chord = to.X_WS.position - from.X_WS.position;
  const Eigen::Vector3d t0 = from.X_WS.rotation.col(2), t1 = to.X_WS.rotation.col(2);
  const double along = chord.dot(t0 + t1), square = chord.squaredNorm();
  if (!(to.s > from.s) || !(square > 0) || !(chord.dot(t0) > 0) || !(chord.dot(t1) > 0)) {
    throw std::invalid_argument(
        fmt::format("samples {} and {} of the backbone do not follow each other", index, index + 1));
  }
  const double d = square / (along + std::sqrt(along * along + (t0 - t1).squaredNorm() * square));
  const Eigen::Vector3d middle = 0.5 * (from.X_WS.position + to.X_WS.position + d * (t0 - t1));
  const Arc first = arc_to(from.X_WS, middle);
  const Arc second = arc_to(first.pose(first.length), to.X_WS.position);
  const double share = first.length / (first.length + second.length);
  const double radius = from.radius + share * (to.radius - from.radius);
  tube.push_back({first, {from.radius, radius}, from.section});
  tube.push_back({second, {radius, to.radius}, from.section});
}

}  // namespace

std::vector<TubeArc> tube_of(const Arm& arm, const Backbone& backbone) {
  const auto arcs = backbone.arcs();
  if (arcs.size() != arm.sections.size()) {
    throw std::invalid_argument(fmt::format("a backbone of {} arcs is not that of an arm of {} sections",
                                            arcs.size(), arm.sections.size()));
  }
  std::vector<TubeArc> tube;
  tube.reserve(arcs.size());
  for (std::size_t i = 0; i < arcs.size(); ++i) tube.push_back({arcs[i], arm.sections[i].radius, i});
  return tube;
}

const TubeArc& tube_arc_at(std::span<const TubeArc> tube, double s) {
  const auto next = std::ranges::upper_bound(tube, s, {}, [](const TubeArc& at) { return at.arc.s; });
  return next == tube.begin() ? tube.front() : *(next - 1);
}

std::vector<TubeArc> tube_through(std::span<const TubeSample> samples) {
  if (samples.size() < 2) throw std::invalid_argument("a backbone needs at least two samples");
  for (std::size_t i = 0; i < samples.size(); ++i) require_usable(samples[i], i);
  std::vector<TubeArc> tube;
  tube.reserve(2 * (samples.size() - 1));
  double s = samples.front().s;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    join(samples[i], samples[i + 1], i, tube);
    for (std::size_t half = tube.size() - 2; half < tube.size(); ++half) {
      tube[half].arc.s = s;
      s += tube[half].arc.length;
    }
  }
  return tube;
}

}  // namespace flexura
