#include "flexura/calibrate/rig_pictures.h"

#include <algorithm>
#include <utility>

namespace flexura {

std::size_t markers_of(const MarkerScene& scene) {
  return static_cast<std::size_t>(
      std::ranges::count_if(scene.markers, [](const auto& marker) { return marker.has_value(); }));
}

MarkerPicture RigPictures::picture(const RigModel& model, const Look& look) const {
  MarkerPicture picture = marker_picture(model.arm, model.bent(poses[look.pose]), config_.markers,
                                         view_of(model, stances[look.stance]), marked_);
  picture.seen = look.arm.scene;
  return picture;
}

std::vector<MarkerMatch> RigPictures::recognise(const RigModel& model, const PointingPrior& pointing_prior,
                                                const std::array<std::size_t, 2>& rank) const {
  std::vector<MarkerMatch> matches(looks.size());
  for (std::size_t i = 0; i < looks.size(); ++i) matches[i].markers.resize(looks[i].arm.scene.markers.size());
  for (std::size_t i = 0; i < 2; ++i) recognise(model, pointing_prior, cameras_[i], rank[i], matches);
  return matches;
}

MarkerMatch RigPictures::recognise_last(const RigModel& model, const PointingPrior& pointing_prior) const {
  std::vector<MarkerMatch> matches(looks.size());
  matches.back().markers.resize(looks.back().arm.scene.markers.size());
  recognise(model, pointing_prior, stances[looks.back().stance].camera, 0, matches);
  return matches.back();
}

void RigPictures::recognise(const RigModel& model, const PointingPrior& pointing_prior, std::size_t camera,
                            std::size_t rank, std::vector<MarkerMatch>& matches) const {
  std::vector<MarkerPicture> pictures;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    if (stances[looks[i].stance].camera != camera) continue;
    pictures.push_back(picture(model, looks[i]));
    places.push_back(i);
  }
  const auto errors = likely_errors(pictures, pointing_prior, rank + 1);
  if (errors.size() <= rank) return;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto& size = looks[places[k]].arm.size;
    // What one common error does not explain: arms bent differently from the readings, a moved camera.
    const MatchPrior rest{.shift = 0.04 * size[0], .turn = 0.05, .scale = 0.05};
    const MarkerScene expected = expected_scene(pictures[k], errors[rank]);
    MarkerMatch& match = matches[places[k]];
    match = match_markers(expected, pictures[k].seen, size, rest);
    // A rig that is hardly known predicts worse for new viewpoints.
    constexpr double more = 3;
    const std::size_t count = markers_of(pictures[k].seen);
    if (2 * match.count >= count) continue;
    MarkerMatch wide =
        match_markers(expected, pictures[k].seen, size,
                      {.shift = more * rest.shift, .turn = more * rest.turn, .scale = more * rest.scale});
    if (4 * wide.count >= 3 * count && wide.count > match.count) match = std::move(wide);
  }
}

SeenArm RigPictures::seen(const RigModel& model, std::size_t look, const MarkerMatch& match) const {
  return recognised(looks[look].arm, match, view_of(model, stances[looks[look].stance]).lens, config_);
}

RigObservations RigPictures::observations(const RigModel& model, const std::vector<MarkerMatch>& matches,
                                          std::size_t fewest) const {
  RigObservations result{.poses = poses, .stances = stances, .images = {}};
  for (std::size_t i = 0; i < looks.size(); ++i) {
    if (matches[i].count < fewest) continue;
    SeenArm arm = seen(model, i, matches[i]);
    result.images.push_back({.stance = looks[i].stance,
                             .pose = looks[i].pose,
                             .markers = std::move(arm.markers),
                             .points = std::move(arm.points)});
  }
  return result;
}

}  // namespace flexura
