#include "flexura/mechanics/rod_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace flexura {
namespace {

// Of a contact of the rod with itself both sides tell: each node that is near another part.
constexpr double of_both_sides = 0.5;
constexpr double no_direction = 1e-12;
constexpr double most_places = 10'000;

struct Between {
  double share = 0;
  NearestPoint nearest;
};

// The nearest point of a segment, whose distance is that from its middle line.
Between nearest_on(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& p) {
  const Eigen::Vector3d along = to - from, off_from = p - from;
  const double squared = along.squaredNorm();
  Between result;
  const double raw = squared > 0 ? off_from.dot(along) / squared : 0;
  result.share = std::clamp(raw, 0.0, 1.0);
  const Eigen::Vector3d off = off_from - result.share * along;
  const double norm = off.norm();
  result.nearest.distance = norm;
  if (!(norm > no_direction)) {
    Eigen::Index least = 0;
    along.cwiseAbs().minCoeff(&least);
    const Eigen::Vector3d across = along.cross(Eigen::Vector3d::Unit(least));
    if (across.norm() > 0) result.nearest.normal = across.normalized();
    return result;
  }
  const Eigen::Vector3d n = off / norm;
  result.nearest.normal = n;
  result.nearest.curvature = Eigen::Matrix3d::Identity() - n * n.transpose();
  if (raw > 0 && raw < 1) result.nearest.curvature -= along * along.transpose() / squared;
  result.nearest.curvature /= norm;
  return result;
}

}  // namespace

RodContact::RodContact(const RodChain& chain, const RodContactConfig& config)
    : law_(config.law), itself_(config.itself) {
  if (const std::string problem = law_problem(law_); !problem.empty()) throw std::invalid_argument(problem);
  if (!config.X_WB.rotation.allFinite() || !config.X_WB.position.allFinite())
    throw std::invalid_argument("contacts: a pose of the base that is not finite");
  for (const ObstacleConfig& obstacle : config.obstacles)
    shapes_.emplace_back(obstacle, config.X_WB.inverse());
  const std::vector<RodSection>& sections = chain.rod().sections;
  if (!config.radii.empty() && config.radii.size() != sections.size())
    throw std::invalid_argument(fmt::format("contacts: {} pairs of radii for {} sections: expected one each",
                                            config.radii.size(), sections.size()));
  double thickest = 0, s_base = 0;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const std::array<double, 2> radius = config.radii.empty() ? sections[i].radius : config.radii[i];
    for (const double each : radius)
      if (!(each > 0) || !std::isfinite(each))
        throw std::invalid_argument(
            fmt::format("contacts, section {}: a radius must be above 0 and finite", i + 1));
    thickest = std::max({thickest, radius[0], radius[1]});
    const double length = sections[i].length;
    const std::vector<double>& t = chain.elements()[i].grid().t;
    for (std::size_t k = 0; k < t.size(); ++k) {
      const double before = k > 0 ? t[k - 1] : t[k], after = k + 1 < t.size() ? t[k + 1] : t[k];
      nodes_.push_back({.place = {.section = i, .at = t[k]},
                        .s = s_base + t[k] * length,
                        .run = 0.5 * (after - before) * length,
                        .radius = radius[0] + t[k] * (radius[1] - radius[0])});
    }
    s_base += length;
  }
  if (itself_ && (!(config.itself_apart > 0) || !std::isfinite(config.itself_apart)))
    throw std::invalid_argument("contacts: itself_apart must be above 0 and finite");
  apart_ = config.itself_apart * thickest;
}

void RodContact::require_nodes(std::size_t nodes, std::size_t pulls) const {
  if (nodes != nodes_.size() || pulls != nodes_.size())
    throw std::invalid_argument(
        fmt::format("contacts of a rod of {} nodes are not those of one of {}", nodes_.size(), nodes));
}

// found(node, obstacle, touch): where a node's ball is in an obstacle.
template <typename Found>
void RodContact::for_obstacles(std::span<const NodeMotion> nodes, Found&& found) const {
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      const Node& node = nodes_[k];
      if (node.s <= shapes_[i].ignore_base() && shapes_[i].ignore_base() > 0) continue;
      if (!(shapes_[i].distance(nodes[k].pose.position) < node.radius)) continue;
      found(k, i,
            Touch{.center = nodes[k].pose.position,
                  .radius = node.radius,
                  .nearest = shapes_[i].nearest(nodes[k].pose.position),
                  .twist = nodes[k].twist,
                  .run = node.run});
    }
  }
}

// found(node, meeting): where a node's ball is in another part of the rod, of all such the nearest.
template <typename Found>
void RodContact::for_meetings(std::span<const NodeMotion> nodes, Found&& found) const {
  if (!itself_) return;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Eigen::Vector3d& p = nodes[k].pose.position;
    Meeting best;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j + 1 < nodes_.size(); ++j) {
      const Node &from = nodes_[j], &to = nodes_[j + 1];
      if (from.place.section != to.place.section) continue;
      if (!(from.s - nodes_[k].s > apart_ || nodes_[k].s - to.s > apart_)) continue;
      const Eigen::Vector3d &a = nodes[j].pose.position, &b = nodes[j + 1].pose.position;
      const double reach = nodes_[k].radius + std::max(from.radius, to.radius);
      // Out of reach of a ball around the segment.
      const double half = 0.5 * (b - a).norm() + reach;
      if (!((p - 0.5 * (a + b)).squaredNorm() < half * half)) continue;
      const Between between = nearest_on(a, b, p);
      const double other = from.radius + between.share * (to.radius - from.radius);
      const double gap = between.nearest.distance - other - nodes_[k].radius;
      if (!(gap < 0) || !(gap < nearest)) continue;
      nearest = gap;
      best = {.from = j, .share = between.share, .touch = {}};
      best.touch.nearest = between.nearest;
      best.touch.nearest.distance -= other;
    }
    if (!std::isfinite(nearest)) continue;
    best.touch.center = p;
    best.touch.radius = nodes_[k].radius;
    best.touch.twist =
        nodes[k].twist - (1 - best.share) * nodes[best.from].twist - best.share * nodes[best.from + 1].twist;
    best.touch.run = of_both_sides * nodes_[k].run;
    found(k, best);
  }
}

void RodContact::pull(std::span<const NodeMotion> nodes, std::span<const double> /*run*/,
                      std::span<NodePull> pulls) const {
  require_nodes(nodes.size(), pulls.size());
  for (NodePull& pull : pulls) pull.clear();
  NodePull one;
  for_obstacles(nodes, [&](std::size_t k, std::size_t, const Touch& touch) {
    touch_force(law_, touch, one);
    pulls[k] += one;
  });
  // What one node does to the other is not in the derivatives. Twice what holds each holds both.
  for_meetings(nodes, [&](std::size_t k, const Meeting& meeting) {
    touch_force(law_, meeting.touch, one);
    one.stiffness *= 2;
    one.damping *= 2;
    pulls[k] += one;
    const auto answer = [&](std::size_t j, double share) {
      if (share == 0) return;
      NodePull other = one;
      other.wrench *= -share;
      other.by_pose *= share * share;
      other.by_twist *= share * share;
      other.stiffness *= share;
      other.damping *= share;
      pulls[j] += other;
    };
    answer(meeting.from, 1 - meeting.share);
    answer(meeting.from + 1, meeting.share);
  });
}

void RodContact::find(std::span<const NodeMotion> nodes, std::vector<ContactForce>& found) const {
  require_nodes(nodes.size(), nodes.size());
  found.clear();
  const auto add = [&](std::size_t k, const Touch& touch) -> ContactForce& {
    const TouchForce at = touch_force(law_, touch);
    ContactForce& contact = found.emplace_back();
    contact.node = k;
    contact.place = nodes_[k].place;
    contact.point = at.point;
    contact.normal = touch.nearest.normal;
    contact.force = at.force;
    contact.slip = at.slip;
    contact.depth = at.depth;
    contact.normal_force = at.normal_force;
    contact.sticks = at.slip.norm() <= law_.slip_speed;
    return contact;
  };
  for_obstacles(nodes, [&](std::size_t k, std::size_t i, const Touch& touch) {
    ContactForce& contact = add(k, touch);
    contact.obstacle = i;
    contact.is_deep = touch.nearest.distance < 0;
  });
  for_meetings(nodes, [&](std::size_t k, const Meeting& meeting) {
    ContactForce& contact = add(k, meeting.touch);
    const Node &from = nodes_[meeting.from], &to = nodes_[meeting.from + 1];
    contact.other = {.section = from.place.section,
                     .at = from.place.at + meeting.share * (to.place.at - from.place.at)};
    contact.is_deep = meeting.touch.nearest.distance < 0;
  });
  std::ranges::stable_sort(found, {}, &ContactForce::node);
}

std::vector<ContactForce> RodContact::find(std::span<const NodeMotion> nodes) const {
  std::vector<ContactForce> found;
  find(nodes, found);
  return found;
}

std::vector<RodPlace> contact_places(const Rod& rod, double spacing) {
  const double length = rod.length();
  if (!(spacing > 0) || !std::isfinite(length) || !(length / spacing <= most_places))
    throw std::invalid_argument(
        fmt::format("a spacing of {} m along a rod of {} m: expected one above 0 that makes at most 10,000 "
                    "places",
                    spacing, length));
  std::vector<RodPlace> places;
  for (std::size_t i = 0; i < rod.sections.size(); ++i) {
    const int count = std::max(1, static_cast<int>(std::ceil(rod.sections[i].length / spacing - 1e-9)));
    for (int k = 1; k < count; ++k) places.push_back({.section = i, .at = static_cast<double>(k) / count});
  }
  return places;
}

}  // namespace flexura
