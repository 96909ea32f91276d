#include "flexura/app/estimate_answer.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "flexura/base/table.h"
#include "flexura/estimate/curve_angles.h"
#include "flexura/log/messages.h"
#include "flexura/math/pose.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

Node vector_node(const Eigen::Vector3d& p) {
  return {Node::Array{number_node(p.x()), number_node(p.y()), number_node(p.z())}, {}};
}

Node image_node(const PictureReport& picture, const Observation& observation,
                const std::optional<ViewError>& error) {
  Node::Table entry{{"image", {}, text_node(picture.image)},
                    {"camera", {}, text_node(picture.camera)},
                    {"points", {}, {static_cast<std::int64_t>(observation.points.size()), {}}}};
  if (error) {
    Node::Table off{{"turn", {}, vector_node(error->turn)}, {"focal", {}, number_node(error->focal)}};
    entry.push_back({"camera_error", {}, {std::move(off), {}}});
  }
  if (!picture.reason.empty()) entry.push_back({"reason", {}, text_node(picture.reason)});
  if (!picture.notes.empty()) entry.push_back({"notes", {}, texts_node(picture.notes)});
  return {std::move(entry), {}};
}

// The standard deviation at so many places evenly along the backbone, linear between where it is known.
Node::Array sigmas_at(const ShapeEstimate& found, std::size_t count, double length) {
  Node::Array sigmas;
  std::size_t after = 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = length * static_cast<double>(i) / static_cast<double>(count - 1);
    while (after + 1 < found.s.size() && found.s[after] < s) ++after;
    const double from = found.s[after - 1], to = found.s[after];
    const double share = to > from ? std::clamp((s - from) / (to - from), 0.0, 1.0) : 0;
    sigmas.push_back(
        number_node(found.sigma[after - 1] + share * (found.sigma[after] - found.sigma[after - 1])));
  }
  return sigmas;
}

void add_angles(const std::vector<DirectionAngles>& angles, const std::string& before, Node::Table& answer) {
  Node::Array azimuths, elevations;
  for (const DirectionAngles& angle : angles) {
    azimuths.push_back(number_node(angle.azimuth));
    elevations.push_back(number_node(angle.elevation));
  }
  answer.push_back({before + "azimuth", {}, {std::move(azimuths), {}}});
  answer.push_back({before + "elevation", {}, {std::move(elevations), {}}});
}

// As two image planes show them, if the cameras stand for that: one looks along Z, the other one along X.
void add_plane_angles(std::span<const Observation> observations, std::size_t count, Node::Table& answer) {
  if (observations.size() != 2) return;
  const Pose &first = observations[0].view.X_WC, &second = observations[1].view.X_WC;
  const bool is_front_first = stand_for_planes(first, second);
  if (!is_front_first && !stand_for_planes(second, first)) return;
  const auto angles = is_front_first ? plane_angles(observations[0], observations[1], count)
                                     : plane_angles(observations[1], observations[0], count);
  if (angles.empty()) return;
  Node::Table planes;
  add_angles(angles, "", planes);
  Node::Array singular;
  for (const DirectionAngles& angle : angles) singular.push_back({angle.is_singular, {}});
  planes.push_back({"singular", {}, {std::move(singular), {}}});
  answer.push_back({"planes", {}, {std::move(planes), {}}});
}

void add_markers(const ShapeEstimate& found, const Backbone& backbone, Node::Table& answer) {
  if (found.markers.empty()) return;
  Node::Array markers;
  for (const PlacedMarker& marker : found.markers) {
    Node::Table entry{{"s", {}, number_node(marker.s)},
                      {"at", {}, vector_node(backbone.pose(std::min(marker.s, backbone.length())).position)},
                      {"images", {}, {static_cast<std::int64_t>(marker.looks), {}}}};
    markers.push_back({std::move(entry), {}});
  }
  answer.push_back({"markers", {}, {std::move(markers), {}}});
}

void add_shape(const ShapeEstimate& found, std::span<const Observation> observations,
               const EstimateConfig& config, Node::Table& answer) {
  const Backbone backbone(found.shape.arm, found.shape.state);
  const std::size_t count = config.points;
  Node::Array points;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    points.push_back(vector_node(backbone.pose(share * backbone.length()).position));
  }
  answer.push_back({"backbone", {}, {std::move(points), {}}});
  add_angles(direction_angles(backbone, count), "", answer);
  add_plane_angles(observations, count, answer);
  answer.push_back({"length", {}, number_node(backbone.length())});
  answer.push_back({"sigma", {}, number_node(found.rms_sigma())});
  answer.push_back({"sigmas", {}, {sigmas_at(found, count, backbone.length()), {}}});
  answer.push_back({"rms_px", {}, number_node(found.rms)});
  add_markers(found, backbone, answer);
  if (!config.has_bends) return;
  answer.push_back({"bends", {}, bends_node(found.shape.state)});
}

}  // namespace

Node estimate_node(const ShapeEstimate& found, std::span<const Observation> observations,
                   std::span<const PictureReport> pictures, const EstimateConfig& config) {
  Node::Array images;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    std::optional<ViewError> error;
    if (found.is_found && observations[i].view_prior.is_any()) error = found.shape.views.at(i);
    images.push_back(image_node(pictures[i], observations[i], error));
  }
  Node::Table answer{{"found", {}, {found.is_found, {}}}, {"trusted", {}, {found.is_trusted(), {}}}};
  if (found.is_found)
    add_shape(found, observations, config, answer);
  else
    answer.push_back({"reason", {}, text_node(found.reason)});
  if (!found.notes.empty()) answer.push_back({"notes", {}, texts_node(found.notes)});
  answer.push_back({"images", {}, {std::move(images), {}}});
  return {std::move(answer), {}};
}

}  // namespace flexura
