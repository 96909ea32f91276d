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
  passed_ = 0, reported_at_ = now, ends_at_ = now;
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
  if (legs_.empty()) passed_ = 0, reported_at_ = now;
  legs_.push_back(std::move(leg));
}

double GrblPath::lag(double now) const { return legs_.empty() ? 0 : std::max(ends_at_ - now, 0.0); }

// Returns the place nearest to a position. Legs may cover each other, as on the way there and back, so places
// behind the last report count only if there is no other near one.
GrblPath::Place GrblPath::place_of(std::span<const std::int64_t> position, double tolerance) const {
  Place best{.error = std::numeric_limits<double>::infinity()};
  bool is_best_ahead = false;
  for (std::size_t k = 0; k < legs_.size(); ++k) {
    const Leg& leg = legs_[k];
    double along = 0;
    for (std::size_t i = 0; i < position.size(); ++i) {
      const double scale = axes_.per_mm[i] * axes_.per_mm[i];
      along += static_cast<double>(position[i] - leg.from[i]) * static_cast<double>(leg.to[i] - leg.from[i]) /
               scale;
    }
    Place place{.leg = k, .share = std::clamp(along / (leg.length * leg.length), 0.0, 1.0)};
    for (std::size_t i = 0; i < position.size(); ++i) {
      const double there =
          static_cast<double>(leg.from[i]) + place.share * static_cast<double>(leg.to[i] - leg.from[i]);
      place.error = std::max(place.error, std::abs(static_cast<double>(position[i]) - there));
    }
    const bool is_ahead = place.error <= tolerance && way_to(place) >= -margin_of(tolerance);
    if (is_ahead != is_best_ahead ? is_ahead : place.error < best.error)
      best = place, is_best_ahead = is_ahead;
  }
  if (!legs_.empty()) return best;
  best.error = 0;
  for (std::size_t i = 0; i < position.size(); ++i)
    best.error = std::max(best.error, std::abs(static_cast<double>(position[i] - end_[i])));
  return best;
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

bool GrblPath::can_be_at(std::span<const std::int64_t> position, double tolerance, double now) const {
  const Place place = place_of(position, tolerance);
  if (place.error > tolerance) return false;
  if (legs_.empty()) return true;
  const double fastest = std::ranges::max_element(legs_, {}, &Leg::speed)->speed;
  const double way = way_to(place), margin = margin_of(tolerance);
  return way >= -margin && way <= 1.1 * fastest * (now - reported_at_) + margin;
}

void GrblPath::report(std::span<const std::int64_t> position, double now) {
  reported_at_ = now;
  if (legs_.empty()) return;
  constexpr double rounding = 2;  // Steps.
  const Place place = place_of(position, rounding);
  legs_.erase(legs_.begin(), legs_.begin() + static_cast<std::ptrdiff_t>(place.leg));
  passed_ = place.share;
  double left = -passed_ * legs_.front().length / legs_.front().speed;
  for (const Leg& leg : legs_) left += leg.length / leg.speed;
  if (left <= 0) return;
  rests_at_ += now + left - ends_at_;
  ends_at_ = now + left;
}

}  // namespace flexura
