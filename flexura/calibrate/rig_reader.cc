#include "flexura/calibrate/rig_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "flexura/math/arrays.h"

namespace flexura {

RigReader::RigReader(const RigModel& guess, const RigPrior& prior, const std::array<std::size_t, 2>& cameras,
                     const Eigen::Vector3d& target, std::size_t fewest)
    : guess_(guess), prior_(prior), doubt_{.sideways = 0.01, .roll = 0.01, .scale = 0.01}, fewest_(fewest) {
  for (const std::size_t i : cameras) {
    const CameraPrior& camera = prior.cameras.at(i);
    const double distance = (vector(guess.cameras.at(i).mount.position) - target).norm();
    const double moved = camera.position / distance;
    doubt_.sideways = std::max(doubt_.sideways, std::hypot(camera.rotation, moved));
    doubt_.roll = std::max(doubt_.roll, camera.rotation);
    doubt_.scale = std::max(doubt_.scale, std::hypot(camera.focal, moved));
  }
}

MarkerMatch RigReader::read_last(const RigSights& sights, const RigModel* before) const {
  return before != nullptr ? sights.recognise_last(*before, of_found) : sights.recognise_last(guess_, doubt_);
}

RigReading RigReader::read(const RigSights& sights, const RigModel* before) const {
  std::vector<RigReading> readings;
  if (before != nullptr) readings.push_back(read_as(sights, *before, of_found, {0, 0}));
  constexpr std::array<std::array<std::size_t, 2>, 6> ranks = {
      {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {2, 0}, {0, 2}}};
  for (const auto& rank : ranks) {
    if (!readings.empty() && readings.back().is_whole()) break;
    readings.push_back(read_as(sights, guess_, doubt_, rank));
  }
  const auto best = std::ranges::max_element(readings, [](const RigReading& a, const RigReading& b) {
    if (a.found.is_found != b.found.is_found) return b.found.is_found;
    return a.explained < b.explained;
  });
  return std::move(*best);
}

// Recognised anew with each rig that is found, until nothing changes, or for so many rounds; the round that
// explains most.
RigReading RigReader::read_as(const RigSights& sights, const RigModel& first, const SightDoubt& doubt,
                              const std::array<std::size_t, 2>& rank) const {
  RigReading best;
  std::vector<MarkerMatch> matches = sights.recognise(first, doubt, rank);
  RigModel model = first;
  constexpr int rounds = 4;
  for (int round = 0; round < rounds; ++round) {
    RigReading now;
    now.problem.emplace(guess_, prior_, sights.observations(model, matches, round == 0 ? fewest_ : few));
    now.found = calibrate_rig(*now.problem);
    rate(sights, matches, now);
    const bool is_found = now.found.is_found;
    if (is_found) model = now.found.model;
    if (round == 0 || (is_found && now.explained >= best.explained)) best = std::move(now);
    if (!is_found) break;
    std::vector<MarkerMatch> again = sights.recognise(model, of_found);
    // The first round leaves out looks of few markers.
    if (round > 0 && again == matches) break;
    matches = std::move(again);
  }
  return best;
}

// Nothing is found by one camera alone.
void RigReader::rate(const RigSights& sights, const std::vector<MarkerMatch>& matches,
                     RigReading& reading) const {
  double unknown = 0;
  std::vector<std::size_t> images(guess_.cameras.size(), 0);
  for (const RigImage& image : reading.problem->observations().images) {
    reading.things += static_cast<double>(image.things());
    ++images[sights.stances[image.stance].camera];
  }
  for (const std::size_t camera : sights.cameras()) {
    if (images[camera] > 0 || !reading.found.is_found) continue;
    reading.found.is_found = false;
    reading.found.reason =
        fmt::format("the arm is recognised in no picture of camera {}", guess_.cameras[camera].name);
  }
  for (std::size_t i = 0; i < matches.size(); ++i)
    unknown +=
        static_cast<double>(markers_of(sights.looks[i].arm.scene)) - static_cast<double>(matches[i].count);
  const auto doubted = static_cast<double>(reading.found.doubts.size());
  reading.amiss = doubted + unknown;
  reading.explained = reading.things - 2 * doubted - unknown;
}

}  // namespace flexura
