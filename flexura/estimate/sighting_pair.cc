#include "flexura/estimate/sighting_pair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "flexura/estimate/correspondence.h"

namespace flexura {
namespace {

// Where a picture sees the arm, and how much of it.
struct Outlook {
  Eigen::Vector3d direction = {0, 0, 0};  // Towards the middle of what is seen, unit; 0: none.
  double angle = 0;                       // Under which its axis is seen, rad; less where the arm is cut off.
};
Outlook outlook(const Sighting& seen) {
  Outlook result;
  std::vector<Eigen::Vector3d> rays;
  for (const CurvePoint& point : seen.points)
    if (const auto ray = seen.view.lens.unproject(point.pixel))
      rays.push_back(ray->homogeneous().normalized());
  if (rays.empty()) return result;
  result.direction = seen.view.X_WC.rotation * rays[rays.size() / 2];
  for (std::size_t i = 1; i < rays.size(); ++i) result.angle += (rays[i] - rays[i - 1]).norm();
  constexpr double cut = 0.5;  // For each end: what is cut off has any length.
  for (const auto& end : seen.ends) result.angle *= end ? 1 : cut;
  return result;
}

// Whether it is followed the other way than these places, as far as the picture tells.
bool runs_against(const Sighting& seen, std::span<const Eigen::Vector3d> places) {
  if (places.empty() || seen.points.empty()) return false;
  const auto begin = seen.view.project(places.front()), end = seen.view.project(places.back());
  if (!begin || !end) return false;
  const auto off = [&](const Eigen::Vector2d& near_base, const Eigen::Vector2d& near_tip) {
    return (near_base - *begin).norm() + (near_tip - *end).norm();
  };
  const Eigen::Vector2d first = seen.points.front().pixel, last = seen.points.back().pixel;
  return off(last, first) < off(first, last);
}

}  // namespace

SightingPair best_pair(std::span<const Sighting> sightings) {
  SightingPair best = {0, 1};
  if (sightings.size() <= 2) return best;
  std::vector<Outlook> outlooks;
  for (const Sighting& seen : sightings) outlooks.push_back(outlook(seen));
  double most = 0;
  for (std::size_t i = 0; i < outlooks.size(); ++i) {
    for (std::size_t j = i + 1; j < outlooks.size(); ++j) {
      const double sine = outlooks[i].direction.cross(outlooks[j].direction).norm(),
                   score = sine * std::min(outlooks[i].angle, outlooks[j].angle);
      if (score > most) most = score, best = {i, j};
    }
  }
  return best;
}

std::vector<Eigen::Vector3d> places_seen(const Sighting& one, const Sighting& other) {
  std::vector<Eigen::Vector3d> places;
  for (const SpacePoint& point : correspondence(one, other).points) places.push_back(point.position);
  return places;
}

std::vector<Sighting> run_alike(std::vector<Sighting> sightings, const SightingPair& pair, bool against) {
  const auto turn = [](Sighting& seen) { seen = reversed(std::move(seen)); };
  if (against) turn(sightings[pair[1]]);
  if (sightings.size() == 2) return sightings;
  const auto places = places_seen(sightings[pair[0]], sightings[pair[1]]);
  const bool is_first_against = pair[0] != 0 && runs_against(sightings[0], places);
  for (std::size_t i = 0; i < sightings.size(); ++i)
    if (i != pair[0] && i != pair[1] && runs_against(sightings[i], places)) turn(sightings[i]);
  if (is_first_against) std::ranges::for_each(sightings, turn);
  return sightings;
}

}  // namespace flexura
