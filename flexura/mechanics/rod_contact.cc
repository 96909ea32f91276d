#include "flexura/mechanics/rod_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace flexura {
namespace {

constexpr double most_places = 10'000;

void require_radii(const RodContactConfig& config, std::size_t sections) {
  if (!config.radii.empty() && config.radii.size() != sections)
    throw std::invalid_argument(fmt::format("contacts: {} pairs of radii for {} sections: expected one each",
                                            config.radii.size(), sections));
}

// Throws unless the places rise along a rod with this number of sections.
void require_places(const std::vector<RodPlace>& places, std::size_t sections) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    const RodPlace& place = places[i];
    const bool is_inside = place.section < sections && place.at >= 0 && place.at <= 1;
    const bool rises = i == 0 || place.section > places[i - 1].section ||
                       (place.section == places[i - 1].section && place.at > places[i - 1].at);
    if (!is_inside || !rises)
      throw std::invalid_argument(fmt::format(
          "contacts: place {} at {} of section {}: expected places on the rod, in order from base to tip",
          i + 1, place.at, place.section + 1));
  }
}

}  // namespace

RodContact::RodContact(const RodChain& chain, const RodContactConfig& config)
    : law_(config.law), itself_(config.itself) {
  if (const std::string problem = law_problem(law_); !problem.empty()) throw std::invalid_argument(problem);
  if (!config.X_WB.rotation.allFinite() || !config.X_WB.position.allFinite())
    throw std::invalid_argument("contacts: the pose of the base must be finite");
  for (const ObstacleConfig& obstacle : config.obstacles)
    shapes_.emplace_back(obstacle, config.X_WB.inverse());
  require_radii(config, chain.rod().sections.size());
  places_ = config.places;
  if (places_.empty())
    for (const RodElement& element : chain.elements())
      for (const double t : element.grid().t)
        // The base of a piece is the end of the one before.
        if (t > 0 || element.part().begin == 0)
          places_.push_back({.section = element.part().section, .at = element.part().of_section(t)});
  require_places(places_, chain.rod().sections.size());
  if (itself_ && (!(config.itself_apart > 0) || !std::isfinite(config.itself_apart)))
    throw std::invalid_argument("contacts: itself_apart must be above 0 and finite");
  set_points(chain, config);
  if (itself_) set_curve(chain);
  balls_.resize(points_.size());
  interval_balls_.resize(intervals_.size());
  is_chosen_.resize(points_.size());
  index_.resize(points_.size());
  pieces_.reserve(curve_.segments().size());
}

void RodContact::set_points(const RodChain& chain, const RodContactConfig& config) {
  const std::vector<RodSection>& sections = chain.rod().sections;
  double thickest = 0, s_base = 0;
  std::size_t node = 0, next = 0;
  for (const RodElement& element : chain.elements()) {
    const RodPart& part = element.part();
    const std::size_t i = part.section;
    const std::array<double, 2> radius = config.radii.empty() ? sections[i].radius : config.radii[i];
    for (const double each : radius)
      if (!(each > 0) || !std::isfinite(each))
        throw std::invalid_argument(
            fmt::format("contacts, section {}: a radius must be above 0 and finite", i + 1));
    thickest = std::max({thickest, radius[0], radius[1]});
    const double length = sections[i].length;
    std::vector<double> t;  // As parts of the section.
    for (const double at : element.grid().t) t.push_back(part.of_section(at));
    const auto is_here = [&](std::size_t k) { return k < places_.size() && places_[k].section == i; };
    for (std::size_t k = 0; k + 1 < t.size(); ++k) {
      Interval& interval = intervals_.emplace_back(Interval{.first_node = node + k,
                                                            .first_point = next,
                                                            .begin = s_base + t[k] * length,
                                                            .end = s_base + t[k + 1] * length,
                                                            .radius = std::max(radius[0], radius[1])});
      const bool is_last = k + 2 == t.size();
      for (; is_here(next) && part.holds(places_[next]) && (is_last || places_[next].at < t[k + 1]);
           ++next, ++interval.points) {
        const double at = places_[next].at,
                     before = next > 0 && is_here(next - 1) ? 0.5 * (places_[next - 1].at + at) : 0,
                     after = is_here(next + 1) ? 0.5 * (places_[next + 1].at + at) : 1;
        points_.push_back({.s = s_base + at * length,
                           .run = (after - before) * length,
                           .radius = radius[0] + at * (radius[1] - radius[0]),
                           .part = std::clamp((at - t[k]) / (t[k + 1] - t[k]), 0.0, 1.0)});
      }
    }
    node += t.size();
    if (part.is_last) s_base += length;
  }
  apart_ = config.itself_apart * thickest;
}

void RodContact::pull(std::span<const NodeMotion> /*nodes*/, std::span<const double> /*run*/,
                      std::span<NodePull> pulls) const {
  for (NodePull& pull : pulls) pull.clear();
}

// Each point of an interval between two nodes is in a ball. Points of a curve of length l between ends at the
// distance c are within l sqrt(p (1 - p) (1 - c^2/l^2)) of their place on the line, with p their part of the
// length (M. Stewart's theorem for the triangle of the ends and the point).
void RodContact::choose(std::span<const NodeMotion> nodes, std::span<const double> lengths,
                        std::vector<std::size_t>& chosen) const {
  std::ranges::fill(is_chosen_, 0);
  double longest = 0;  // Largest stretch of the rod.
  for (std::size_t k = 0; k < intervals_.size(); ++k) {
    const Interval& interval = intervals_[k];
    const Eigen::Vector3d &begin = nodes[interval.first_node].pose.position,
                          &end = nodes[interval.first_node + 1].pose.position;
    longest = std::max(longest, lengths[k] / (interval.end - interval.begin));
    interval_balls_[k] = {.middle = 0.5 * (begin + end), .radius = 0.5 * lengths[k]};
    const double squared = lengths[k] * lengths[k],
                 spare = std::max(0.0, squared - (end - begin).squaredNorm());
    for (std::size_t i = interval.first_point; i < interval.first_point + interval.points; ++i) {
      const double part = points_[i].part;
      balls_[i] = {.middle = begin + part * (end - begin),
                   .radius = std::sqrt(part * (1 - part) * spare) + 1e-9 * lengths[k]};
    }
    choose_near_obstacles(interval, interval_balls_[k]);
  }
  for (std::size_t k = 0; itself_ && k < intervals_.size(); ++k) {
    for (std::size_t l = k; l < intervals_.size(); ++l) {
      const Interval &one = intervals_[k], &other = intervals_[l];
      if (!(other.end - one.begin > apart_)) continue;
      const double reach = interval_balls_[k].radius + interval_balls_[l].radius + one.radius + other.radius +
                           spacing_ * longest;
      if ((interval_balls_[k].middle - interval_balls_[l].middle).squaredNorm() < reach * reach)
        choose_near_itself(one, other, spacing_ * longest);
    }
  }
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (is_chosen_[i] != 0) chosen.push_back(i);
}

void RodContact::choose_near_obstacles(const Interval& interval, const Ball& ball) const {
  for (const ContactShape& shape : shapes_) {
    const double ignored = shape.ignore_base();
    if (interval.end <= ignored || !(shape.distance(ball.middle) < ball.radius + interval.radius)) continue;
    for (std::size_t i = interval.first_point; i < interval.first_point + interval.points; ++i) {
      if (is_chosen_[i] != 0 || (points_[i].s <= ignored && ignored > 0)) continue;
      if (shape.distance(balls_[i].middle) < balls_[i].radius + points_[i].radius) is_chosen_[i] = 1;
    }
  }
}

// Calls found(index among the chosen, obstacle, touch) for each contact with an obstacle.
template <typename Found>
void RodContact::for_obstacles(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
                               Found&& found) const {
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const Point& point = points_[chosen[k]];
    const Eigen::Vector3d& p = points[k].pose.position;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      if (point.s <= shapes_[i].ignore_base() && shapes_[i].ignore_base() > 0) continue;
      if (!(shapes_[i].distance(p) < point.radius)) continue;
      found(k, i,
            Touch{.center = p,
                  .radius = point.radius,
                  .nearest = shapes_[i].nearest(p),
                  .twist = points[k].twist,
                  .run = point.run});
    }
  }
}

bool RodContact::may_have_passed(std::span<const NodeMotion> before,
                                 std::span<const NodeMotion> after) const {
  if (before.size() != points_.size() || after.size() != points_.size())
    throw std::invalid_argument("contacts: a wrong number of points");
  constexpr double most_parts = 1000;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector3d &from = before[i].pose.position, way = after[i].pose.position - from;
    const double moved = way.norm();
    for (const ContactShape& shape : shapes_) {
      if (points_[i].s <= shape.ignore_base() && shape.ignore_base() > 0) continue;
      const double radius = points_[i].radius, reach = 0.5 * (radius + shape.half_thickness());
      if (!(moved > reach) || !(shape.distance(from) < moved + radius)) continue;
      // Contact extends over four times the reach.
      const double parts = std::min(std::ceil(moved / reach), most_parts);
      for (double k = 1; k < parts; ++k)
        if (shape.distance(from + k / parts * way) < radius) return true;
    }
  }
  return false;
}

void RodContact::pull_points(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
                             std::span<NodePull> pulls) const {
  for (NodePull& pull : pulls) pull.clear();
  NodePull one;
  for_obstacles(chosen, points, [&](std::size_t k, std::size_t, const Touch& touch) {
    touch_force(law_, touch, one);
    pulls[k] += one;
  });
  one = NodePull{};
  one.is_held = one.is_coupled = true;
  find_meetings(chosen, points);
  for (const Meeting& meeting : meetings_) {
    const Eigen::Vector3d force = touch_force(law_, meeting.touch).force;
    for (std::size_t i = 0; i < 5; ++i) {
      const std::size_t k = meeting.points[i];
      const double share = i == 0 ? 1 : -meeting.shares[static_cast<Eigen::Index>(i) - 1];
      Eigen::Vector3d arm = points[k].pose.position + meeting.arm;
      if (i == 0) arm -= meeting.off;
      one.wrench << share * force, arm.cross(share * force);
      pulls[k] += one;
    }
  }
}

void RodContact::find(std::span<const NodeMotion> points, std::vector<ContactForce>& found) const {
  if (points.size() != points_.size())
    throw std::invalid_argument(
        fmt::format("contacts: expected the motion of {} points, not of {}", points_.size(), points.size()));
  found.clear();
  std::vector<std::size_t> all(points.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const auto add = [&](std::size_t k, const Touch& touch) -> ContactForce& {
    const TouchForce at = touch_force(law_, touch);
    ContactForce& contact = found.emplace_back();
    contact.index = k;
    contact.place = places_[k];
    contact.point = at.point;
    contact.normal = touch.nearest.normal;
    contact.force = at.force;
    contact.slip = at.slip;
    contact.depth = at.depth;
    contact.normal_force = at.normal_force;
    contact.sticks = at.slip.norm() <= law_.slip_speed;
    contact.is_deep = touch.nearest.distance < 0;
    return contact;
  };
  for_obstacles(all, points,
                [&](std::size_t k, std::size_t i, const Touch& touch) { add(k, touch).obstacle = i; });
  find_meetings(all, points);
  for (const Meeting& meeting : meetings_) {
    const std::size_t before = curve_points_[curve_.segments()[meeting.segment].places[1]],
                      after = curve_points_[curve_.segments()[meeting.segment].places[2]];
    const std::size_t section = stretches_[meeting.segment].section;
    const double from = places_[before].section == section ? places_[before].at : 0,
                 to = places_[after].section == section ? places_[after].at : 1;
    add(meeting.points[0], meeting.touch).other = {.section = section,
                                                   .at = from + meeting.share * (to - from)};
  }
  std::ranges::stable_sort(found, {}, &ContactForce::index);
}

std::vector<ContactForce> RodContact::find(std::span<const NodeMotion> points) const {
  std::vector<ContactForce> found;
  find(points, found);
  return found;
}

std::vector<RodPlace> contact_places(const Rod& rod, double spacing) {
  const double length = rod.length();
  if (!(spacing > 0) || !std::isfinite(length) || !(length / spacing <= most_places))
    throw std::invalid_argument(
        fmt::format("a spacing of {} m along a rod of {} m: expected a spacing above 0 with at most 10,000 "
                    "places",
                    spacing, length));
  std::vector<RodPlace> places;
  for (std::size_t i = 0; i < rod.sections.size(); ++i) {
    const int count = std::max(1, static_cast<int>(std::ceil(rod.sections[i].length / spacing - 1e-9)));
    for (int k = 0; k <= count; ++k) places.push_back({.section = i, .at = static_cast<double>(k) / count});
  }
  return places;
}

}  // namespace flexura
