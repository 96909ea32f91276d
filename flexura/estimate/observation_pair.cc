#include "flexura/estimate/observation_pair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <utility>

#include "flexura/estimate/correspondence.h"

namespace flexura {
namespace {

// Direction and apparent size of the arm in a picture.
struct Outlook {
  Eigen::Vector3d direction = {0, 0, 0};  // Towards the middle of the visible part, unit; 0: not visible.
  double angle = 0;                       // Angle subtended by its axis, rad; less where the arm is cut off.
};
Outlook outlook(const Observation& seen) {
  Outlook result;
  std::vector<Eigen::Vector3d> rays;
  for (const CurvePoint& point : seen.points)
    if (const auto ray = seen.view.lens.unproject(point.pixel))
      rays.push_back(ray->homogeneous().normalized());
  if (rays.empty()) return result;
  result.direction = seen.view.X_WC.rotation * rays[rays.size() / 2];
  for (std::size_t i = 1; i < rays.size(); ++i) result.angle += (rays[i] - rays[i - 1]).norm();
  constexpr double cut = 0.5;  // For each end: the part cut off has an unknown length.
  for (const auto& end : seen.ends) result.angle *= end ? 1 : cut;
  return result;
}

// Returns whether an observation runs opposite to these points, by the order of the nearest ones. (On a
// fragment of a bent arm, the ends alone may be nearer to the wrong ends.)
bool runs_against(const Observation& seen, std::span<const Eigen::Vector3d> places) {
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector3d& p_WP : places)
    if (const auto pixel = seen.view.project(p_WP)) pixels.push_back(*pixel);
  if (pixels.empty()) return false;
  std::ptrdiff_t ahead = 0, before = -1;
  for (const CurvePoint& point : seen.points) {
    const auto off = [&](const Eigen::Vector2d& pixel) { return (pixel - point.pixel).squaredNorm(); };
    const std::ptrdiff_t here = std::ranges::min_element(pixels, {}, off) - pixels.begin();
    if (before >= 0) ahead += (here > before ? 1 : 0) - (here < before ? 1 : 0);
    before = here;
  }
  return ahead < 0;
}

}  // namespace

ObservationPair best_pair(std::span<const Observation> observations) {
  ObservationPair best = {0, 1};
  if (observations.size() <= 2) return best;
  std::vector<Outlook> outlooks;
  for (const Observation& seen : observations) outlooks.push_back(outlook(seen));
  double most = 0;
  for (std::size_t i = 0; i < outlooks.size(); ++i) {
    for (std::size_t j = i + 1; j < outlooks.size(); ++j) {
      const double sine = outlooks[i].direction.cross(outlooks[j].direction).norm(),
                   apart = (observations[i].view.X_WC.position - observations[j].view.X_WC.position).norm(),
                   score = apart > 0 ? sine * std::min(outlooks[i].angle, outlooks[j].angle) : 0;
      if (score > most) most = score, best = {i, j};
    }
  }
  return best;
}

std::vector<Eigen::Vector3d> places_seen(const Observation& one, const Observation& other) {
  std::vector<Eigen::Vector3d> places;
  for (const SpacePoint& point : correspondence(one, other)) places.push_back(point.position);
  return places;
}

std::vector<Observation> run_alike(std::vector<Observation> observations, const ObservationPair& pair,
                                   bool against, bool from_base) {
  const auto turn = [](Observation& seen) { seen = reversed(std::move(seen)); };
  if (against) turn(observations[pair[1]]);
  if (observations.size() == 2) return observations;
  const auto places = places_seen(observations[pair[0]], observations[pair[1]]);
  bool is_first_turned = false;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const bool is_determined = i == pair[0] || i == pair[1] || (from_base && observations[i].ends[0]);
    if (is_determined || !runs_against(observations[i], places)) continue;
    turn(observations[i]);
    is_first_turned = is_first_turned || i == 0;
  }
  if (is_first_turned && !from_base) std::ranges::for_each(observations, turn);
  return observations;
}

}  // namespace flexura
