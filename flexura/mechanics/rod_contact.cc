#include "flexura/mechanics/rod_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "flexura/math/so3.h"

namespace flexura {
namespace {

// Of a contact of the rod with itself both sides tell: each node that is near another part.
constexpr double of_both_sides = 0.5;
constexpr double no_length = 1e-12;
constexpr double most_places = 10'000;

struct Between {
  double share = 0;
  bool slides = false;  // Inside the segment.
  NearestPoint nearest;
};

// The nearest point of a segment, whose distance is that from its middle line.
Between nearest_on(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& p) {
  const Eigen::Vector3d along = to - from, off_from = p - from;
  const double squared = along.squaredNorm();
  Between result;
  const double raw = squared > 0 ? off_from.dot(along) / squared : 0;
  result.share = std::clamp(raw, 0.0, 1.0);
  result.slides = raw > 0 && raw < 1;
  const Eigen::Vector3d off = off_from - result.share * along;
  const double norm = off.norm();
  result.nearest.distance = norm;
  if (!(norm > no_length)) {
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

// found(node, meeting): where a node's ball is in other parts of the rod: of each part, segment after
// segment, the nearest place.
template <typename Found>
void RodContact::for_meetings(std::span<const NodeMotion> nodes, Found&& found) const {
  if (!itself_) return;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    Meeting best;
    double nearest = 0;
    const auto finish = [&] {
      if (nearest < 0) found(k, best);
      nearest = 0;
    };
    for (std::size_t j = 0; j + 1 < nodes_.size(); ++j) {
      if (nodes_[j].place.section != nodes_[j + 1].place.section) continue;
      Meeting meeting;
      const double gap = meet(nodes, k, j, meeting);
      if (!(gap < 0)) {
        finish();
      } else if (gap < nearest) {
        nearest = gap;
        best = meeting;
      }
    }
    finish();
  }
}

// How far a node's ball is from a segment, which is where it meets it; not below 0 where it does not.
double RodContact::meet(std::span<const NodeMotion> nodes, std::size_t k, std::size_t j,
                        Meeting& meeting) const {
  constexpr double none = std::numeric_limits<double>::infinity();
  const Node &from = nodes_[j], &to = nodes_[j + 1], &node = nodes_[k];
  const bool is_apart = from.s - node.s > apart_ || node.s - to.s > apart_;
  if (!is_apart) return none;
  const Eigen::Vector3d &a = nodes[j].pose.position, &b = nodes[j + 1].pose.position,
                        &p = nodes[k].pose.position;
  // Out of reach of a ball around the segment.
  const double reach = 0.5 * (b - a).norm() + node.radius + std::max(from.radius, to.radius);
  if (!((p - 0.5 * (a + b)).squaredNorm() < reach * reach)) return none;
  const Between between = nearest_on(a, b, p);
  const double other = from.radius + between.share * (to.radius - from.radius);
  const double gap = between.nearest.distance - other - node.radius;
  if (!(gap < 0)) return none;
  meeting = {.from = j, .share = between.share, .slides = between.slides, .touch = {}};
  meeting.touch.nearest = between.nearest;
  meeting.touch.nearest.distance -= other;
  meeting.touch.center = p;
  meeting.touch.radius = node.radius;
  meeting.touch.twist =
      nodes[k].twist - (1 - between.share) * nodes[j].twist - between.share * nodes[j + 1].twist;
  meeting.touch.run = of_both_sides * node.run;
  return gap;
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
  // Twice what holds each holds both, whatever one does to the other.
  for_meetings(nodes, [&](std::size_t k, const Meeting& meeting) {
    const TouchForce at = touch_force(law_, meeting.touch, one);
    const MeetingSlopes slopes = slopes_of(nodes, meeting, at);
    const NodePull held = one;
    const std::array<double, 3> shares = {1, 1 - meeting.share, meeting.share};
    const std::array<std::size_t, 3> of = {k, meeting.from, meeting.from + 1};
    for (int i = 0; i < 3; ++i) {
      const double share = shares[static_cast<std::size_t>(i)];
      const Blocks own = blocks(slopes, meeting, held.wrench, i, i);
      one.by_pose = own.by_pose;
      one.by_twist = own.by_twist;
      one.wrench = (i == 0 ? 1 : -share) * held.wrench;
      one.stiffness = 2 * share * held.stiffness;
      one.damping = 2 * share * held.damping;
      one.is_coupled = true;
      pulls[of[static_cast<std::size_t>(i)]] += one;
    }
  });
}

void RodContact::couple(std::span<const NodeMotion> nodes, std::span<const double> /*run*/,
                        std::vector<NodeCoupling>& couplings) const {
  for_meetings(nodes, [&](std::size_t k, const Meeting& meeting) {
    const TouchForce at = touch_force(law_, meeting.touch);
    const MeetingSlopes slopes = slopes_of(nodes, meeting, at);
    const std::array<std::size_t, 3> node = {k, meeting.from, meeting.from + 1};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (i == j) continue;
        const Blocks block = blocks(slopes, meeting, at.wrench(), i, j);
        couplings.push_back({.of = node[static_cast<std::size_t>(j)],
                             .at = node[static_cast<std::size_t>(i)],
                             .by_pose = block.by_pose,
                             .by_twist = block.by_twist});
      }
    }
  });
}

// With p the node, a and b the segment's ends, u the share, e = b - a and off = p - a - u e: off is
// perpendicular to e as long as u is inside, so that |e|^2 du = e . (dp - (1 - u) da - u db) + off . (db -
// da).
RodContact::MeetingSlopes RodContact::slopes_of(std::span<const NodeMotion> nodes, const Meeting& meeting,
                                                const TouchForce& at) const {
  using Rows = Eigen::Matrix<double, 3, 18>;
  const Touch& touch = meeting.touch;
  const std::size_t from = meeting.from;
  const double u = meeting.share;
  const Eigen::Vector3d &a = nodes[from].pose.position, &b = nodes[from + 1].pose.position;
  const Eigen::Vector3d& n = touch.nearest.normal;
  const Eigen::Vector3d e = b - a, off = touch.center - a - u * e;
  const double distance = off.norm();
  const auto moved = [](const Eigen::Vector3d& p) {
    Eigen::Matrix<double, 3, 6> rows;
    rows << Eigen::Matrix3d::Identity(), -skew(p);
    return rows;
  };
  Rows apart, stretched = Rows::Zero(), center = Rows::Zero(), twisted;
  apart << moved(touch.center), -(1 - u) * moved(a), -u * moved(b);
  stretched.middleCols<6>(6) = -moved(a);
  stretched.rightCols<6>() = moved(b);
  center.leftCols<6>() = moved(touch.center);
  const Eigen::Matrix<double, 3, 6> at_point = moved(at.point);
  twisted << at_point, -(1 - u) * at_point, -u * at_point;

  MeetingSlopes slopes;
  slopes.share_by_pose.setZero();
  if (meeting.slides)
    slopes.share_by_pose = (e.transpose() * apart + off.transpose() * stretched) / e.squaredNorm();
  TouchChange change;
  change.depth.setZero(18);
  change.normal.setZero(3, 18);
  change.point.setZero(3, 18);
  change.velocity = twisted;
  slopes.by_twist = wrench_change(law_, touch, at, change);
  const Rows moves = apart - e * slopes.share_by_pose;
  if (distance > no_length) change.normal = (moves - n * (n.transpose() * moves)) / distance;
  change.depth =
      -n.transpose() * moves + (nodes_[from + 1].radius - nodes_[from].radius) * slopes.share_by_pose;
  change.point = center - touch.radius * change.normal;
  const Vector6d between = nodes[from + 1].twist - nodes[from].twist;
  const Eigen::Vector3d faster = between.head<3>() + between.tail<3>().cross(at.point);
  change.velocity = skew(touch.twist.tail<3>()) * change.point - faster * slopes.share_by_pose;
  slopes.by_pose = wrench_change(law_, touch, at, change);
  return slopes;
}

RodContact::Blocks RodContact::blocks(const MeetingSlopes& slopes, const Meeting& meeting,
                                      const Vector6d& wrench, int at, int of) {
  const std::array<double, 3> shares = {1, meeting.share - 1, -meeting.share}, by_share = {0, 1, -1};
  const auto which = static_cast<std::size_t>(at);
  const auto columns = 6 * static_cast<Eigen::Index>(of);
  return {.by_pose = shares[which] * slopes.by_pose.middleCols<6>(columns) +
                     by_share[which] * wrench * slopes.share_by_pose.middleCols<6>(columns),
          .by_twist = shares[which] * slopes.by_twist.middleCols<6>(columns)};
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
