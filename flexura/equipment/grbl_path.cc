#include "flexura/equipment/grbl_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace flexura {
namespace {

constexpr double slowest = 1;  // mm/min; Grbl moves no slower.

}  // namespace

void GrblPath::rest(std::vector<std::int64_t> position, double now) {
  if (!legs_.empty()) rests_at_ = std::min(rests_at_, now);
  legs_.clear();
  end_ = std::move(position);
  passed_ = 0, spread_ = 0, reported_at_ = now, ends_at_ = now;
}

void GrblPath::stop(std::vector<std::int64_t> position, double now) {
  rest(std::move(position), now);
  rests_at_ = -std::numeric_limits<double>::infinity();
}

GrblPath::Leg GrblPath::leg_to(std::span<const std::int64_t> target) const {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  Leg leg{.from = end_, .to = {target.begin(), target.end()}, .speed = unlimited, .acceleration = unlimited};
  std::vector<double> way(target.size());
  for (std::size_t i = 0; i < target.size(); ++i) {
    way[i] = static_cast<double>(target[i] - end_[i]) / axes_.per_mm[i];
    leg.length = std::hypot(leg.length, way[i]);
  }
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (way[i] == 0) continue;
    const double share = std::abs(way[i]) / leg.length;
    leg.speed = std::min(leg.speed, axes_.rates[i] / share);
    leg.acceleration = std::min(leg.acceleration, axes_.accelerations[i] / share);
  }
  return leg;
}

double GrblPath::feed_to(std::span<const std::int64_t> target, double duration, double lead,
                         double now) const {
  const Leg leg = leg_to(target);
  double speed = leg.speed;
  const double late = lag(now);
  if (duration > 0 && now < rests_at_ + lead) {
    // In a stream, the motions are stretched or shortened until the controller is `lead` behind.
    speed = leg.length / std::clamp(duration + lead - late, 0.5 * duration, 2 * duration);
  } else if (duration > 0) {
    // From rest to rest, with constant accelerations: length = speed (duration - speed / acceleration).
    const double reach = leg.acceleration * duration;
    const double root = reach * reach - 4 * leg.acceleration * leg.length;
    if (root >= 0) speed = 2 * leg.acceleration * leg.length / (reach + std::sqrt(root));
  }
  return std::max(60 * std::min(speed, leg.speed), slowest);
}

void GrblPath::add(std::vector<std::int64_t> target, double feed, double now) {
  Leg leg = leg_to(target);
  if (leg.length == 0) return;
  leg.speed = std::min(leg.speed, feed / 60);
  const double reached = std::min(leg.speed, std::sqrt(leg.acceleration * leg.length));
  if (lag(now) == 0) ends_at_ = now + 0.5 * reached / leg.acceleration;
  ends_at_ += leg.length / reached;
  rests_at_ = ends_at_ + 0.5 * reached / leg.acceleration;
  end_ = std::move(target);
  if (legs_.empty()) passed_ = 0, spread_ = 0, reported_at_ = now;
  legs_.push_back(std::move(leg));
  forget_passed_legs();
}

// A controller accepts a line when its queue has a place, so the lines before a full queue are done. Without
// this, a controller that only moves by a few steps might be at the first of them for ever.
void GrblPath::forget_passed_legs() {
  for (; legs_.size() > most_legs; legs_.pop_front()) {
    spread_ = std::max(0.0, spread_ - (1 - passed_) * legs_.front().length);
    passed_ = 0;
  }
}

double GrblPath::lag(double now) const { return legs_.empty() ? 0 : std::max(ends_at_ - now, 0.0); }

// Returns the place on a leg that is nearest to a position.
GrblPath::Place GrblPath::place_on(std::size_t leg, std::span<const std::int64_t> position) const {
  const Leg& line = legs_[leg];
  double along = 0;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const double scale = axes_.per_mm[i] * axes_.per_mm[i];
    along += static_cast<double>(position[i] - line.from[i]) *
             static_cast<double>(line.to[i] - line.from[i]) / scale;
  }
  Place place{.leg = leg, .share = std::clamp(along / (line.length * line.length), 0.0, 1.0)};
  for (std::size_t i = 0; i < position.size(); ++i) {
    const double there =
        static_cast<double>(line.from[i]) + place.share * static_cast<double>(line.to[i] - line.from[i]);
    place.error = std::max(place.error, std::abs(static_cast<double>(position[i]) - there));
  }
  return place;
}

// Returns all places of the path near a position that are not behind the last report and can be reached by
// the time `now`, in the order of the path.
std::vector<GrblPath::Place> GrblPath::places_of(std::span<const std::int64_t> position, double tolerance,
                                                 double now) const {
  double fastest = 0;
  for (const Leg& leg : legs_) fastest = std::max(fastest, leg.speed);
  const double margin = margin_of(tolerance);
  const double farthest = spread_ + 1.1 * fastest * (now - reported_at_) + margin;
  std::vector<Place> places;
  double before = -passed_ * (legs_.empty() ? 0 : legs_.front().length);  // The way to a leg.
  for (std::size_t k = 0; k < legs_.size(); before += legs_[k++].length) {
    const Place place = place_on(k, position);
    const double way = before + place.share * legs_[k].length;
    if (place.error <= tolerance && way >= -margin && way <= farthest) places.push_back(place);
  }
  return places;
}

// Returns the way from the last report to a place, mm.
double GrblPath::way_to(const Place& place) const {
  double way = -passed_ * (legs_.empty() ? 0 : legs_.front().length);
  for (std::size_t k = 0; k < place.leg; ++k) way += legs_[k].length;
  if (place.leg < legs_.size()) way += place.share * legs_[place.leg].length;
  return way;
}

// Returns the way that a tolerance in steps may make up, mm.
double GrblPath::margin_of(double tolerance) const {
  double margin = 0;
  for (const double per_mm : axes_.per_mm) margin = std::max(margin, 2 * tolerance / per_mm);
  return margin;
}

// Returns the time from a place to the end, without braking, s.
double GrblPath::time_from(const Place& place) const {
  double time = -place.share * legs_[place.leg].length / legs_[place.leg].speed;
  for (std::size_t k = place.leg; k < legs_.size(); ++k) time += legs_[k].length / legs_[k].speed;
  return time;
}

bool GrblPath::can_be_at(std::span<const std::int64_t> position, double tolerance, double now) const {
  if (!legs_.empty()) return !places_of(position, tolerance, now).empty();
  for (std::size_t i = 0; i < position.size(); ++i)
    if (std::abs(static_cast<double>(position[i] - end_[i])) > tolerance) return false;
  return true;
}

void GrblPath::report(std::span<const std::int64_t> position, double asked, double received) {
  constexpr double rounding = 2;  // Steps.
  const std::vector<Place> places = places_of(position, rounding, received);
  if (places.empty()) return;
  const auto surprise = [&](const Place& place) { return std::abs(asked + time_from(place) - ends_at_); };
  const double left = time_from(*std::ranges::min_element(places, {}, surprise));
  spread_ = way_to(places.back()) - way_to(places.front());
  passed_ = places.front().share;
  reported_at_ = asked;
  legs_.erase(legs_.begin(), legs_.begin() + static_cast<std::ptrdiff_t>(places.front().leg));
  if (left <= 0) return;
  rests_at_ += asked + left - ends_at_;
  ends_at_ = asked + left;
}

}  // namespace flexura
