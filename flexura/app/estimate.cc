#include "flexura/app/estimate.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <ostream>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "flexura/app/commands.h"
#include "flexura/base/bytes.h"
#include "flexura/base/source.h"
#include "flexura/camera/measured_camera.h"
#include "flexura/estimate/curve_angles.h"
#include "flexura/estimate/picture_sighting.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/estimate/shape_hint.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/messages.h"
#include "flexura/model/backbone.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "flexura/store/toml.h"
#include "flexura/vision/arm_finder.h"
#include "flexura/vision/linear_light.h"
#include "flexura/vision/picture_file.h"
#include "flexura/vision/picture_hints.h"

namespace flexura {
namespace {

Node vector(const Eigen::Vector3d& p) {
  return {Node::Array{number_node(p.x()), number_node(p.y()), number_node(p.z())}, {}};
}

// What is beyond has no picture of which anything could be told.
constexpr double farthest_place = 1e6;  // m

void check(const EstimateArguments& arguments) {
  if (arguments.images.size() < 2)
    throw input_error("IMAGE", "expected at least two pictures, one of each camera");
  for (const double x : arguments.base)
    if (!(std::abs(x) <= farthest_place))
      throw input_error("--base", fmt::format("expected three numbers x,y,z within {:g} m", farthest_place));
  const auto is_size = [](double x) { return x > 0 && x <= farthest_place; };
  if (arguments.length && !is_size(*arguments.length))
    throw input_error("--length", fmt::format("{} m: expected a number above 0, at most {:g}",
                                              *arguments.length, farthest_place));
  constexpr std::int64_t most = 100000;
  if (arguments.points < 2 || arguments.points > most)
    throw input_error("--points", fmt::format("{}: expected 2 to {}", arguments.points, most));
}

// What a camera's table has at `key`, in whatever unit; null where it is left out.
const Node* written_at(const Node& camera, std::string_view key) {
  const auto& members = *camera.as<Node::Table>();
  const auto found = std::ranges::find_if(
      members, [&](const Node::Member& member) { return without_unit(member.key) == key; });
  return found == members.end() ? nullptr : &found->node;
}

bool stand_at_one_place(const std::vector<MeasuredCamera>& cameras) {
  constexpr double near = 1e-6;  // m
  return std::ranges::all_of(cameras, [&](const MeasuredCamera& camera) {
    return (camera.pose().position - cameras[0].pose().position).norm() < near;
  });
}

// A lens alone is enough to measure a picture, but not for two to meet.
void check_poses(const Node& file, const std::vector<MeasuredCamera>& cameras) {
  std::vector<Problem> problems;
  const auto& tables = *file.find("camera")->as<Node::Array>();
  for (std::size_t i = 0; i < tables.size(); ++i) {
    for (const std::string_view key : {"position", "rotation"})
      if (written_at(tables[i], key) == nullptr)
        problems.push_back(
            {tables[i].where,
             fmt::format("camera[{}].{}: missing: expected where each camera stands", i, key)});
    const Node* position = written_at(tables[i], "position");
    if (position == nullptr) continue;
    const Eigen::Vector3d p_WC = cameras[i].pose().position;
    if (!(p_WC.cwiseAbs().maxCoeff() <= farthest_place))
      problems.push_back(
          {position->where, fmt::format("camera[{}].position: expected within {:g} m", i, farthest_place)});
    else if (i + 1 == tables.size() && i > 0 && stand_at_one_place(cameras))
      problems.push_back({position->where, fmt::format("camera[{}].position: camera[0] stands there: "
                                                       "expected the position and rotation of each",
                                                       i)});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

std::optional<Eigen::Vector3d> base_of(const EstimateArguments& arguments) {
  if (arguments.base.empty()) return std::nullopt;
  return Eigen::Vector3d(arguments.base.data());
}

// Of an arm that may stretch, how long it is: its sections stretch alike, as far as all of them do.
void hold_length(double length, ShapePrior& prior) {
  if (prior.is_length_known) throw input_error("--length", "--arm says how long the arm is");
  double shortest = 0, longest = std::numeric_limits<double>::infinity();
  for (const Section& section : prior.arm.sections) {
    shortest = std::max(shortest, section.stretch_limits[0] * prior.arm.length());
    longest = std::min(longest, section.stretch_limits[1] * prior.arm.length());
  }
  constexpr double grace = 1e-9;  // Sums of the same in another order.
  if (length < (1 - grace) * shortest || length > (1 + grace) * longest)
    throw input_error(
        "--length",
        fmt::format("{} m: expected {:.6g} to {:.6g} m, as far as all sections of --arm stretch alike",
                    length, shortest, longest));
  const double stretch = length / prior.arm.length();
  for (Section& section : prior.arm.sections) section.length *= stretch;
  prior.is_length_known = true;
}

ShapePrior arm_of(const EstimateArguments& arguments) {
  const auto base = base_of(arguments);
  if (arguments.arm.empty()) return unknown_arm(base, arguments.length);
  ShapePrior prior = described_arm(load_experiment(arguments.arm).arm.arm());
  if (arguments.length) hold_length(*arguments.length, prior);
  if (base) prior.arm.X_WB.position = *base;
  return prior;
}

// "0.25" m or "25%" of the arm's length, as m along the unstretched arm.
double marker_place(const std::string& word, const ShapePrior& prior, bool is_described) {
  const bool is_share = word.ends_with('%');
  const std::string digits = word.substr(0, word.size() - (is_share ? 1 : 0));
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
    throw input_error("--markers",
                      fmt::format("\"{}\": expected arc lengths, m, or shares as \"25%\"", word));
  if (!is_share && !is_described && !prior.is_length_known)
    throw input_error(
        "--markers",
        fmt::format("{} m of an arm of unknown length: expected --length, --arm, or shares as \"25%\"",
                    word));
  constexpr double percent = 0.01;
  const double s = is_share ? percent * value * prior.arm.length() : value;
  const bool is_on_arm = s >= 0 && s <= prior.arm.length();
  if (!is_on_arm) throw input_error("--markers", fmt::format("\"{}\" is not on the arm", word));
  return s;
}

EstimateConfig estimate_config(const EstimateArguments& arguments) {
  EstimateConfig config;
  config.prior = arm_of(arguments);
  auto& markers = config.prior.markers;
  const bool is_described = !arguments.arm.empty();
  for (const std::string& word : arguments.markers)
    markers.push_back(marker_place(word, config.prior, is_described));
  std::ranges::sort(markers);
  // Of one place in metres and in percent: but for rounding.
  const double alike = 1e-9 * config.prior.arm.length();
  const auto is_alike = [&](double one, double next) { return next - one <= alike; };
  if (const auto twice = std::ranges::adjacent_find(markers, is_alike); twice != markers.end())
    throw input_error("--markers",
                      fmt::format("a place is there twice, {:.9g} of the arm's length: expected each once",
                                  *twice / config.prior.arm.length()));
  config.threshold = threshold_config(arguments.threshold);
  config.points = static_cast<std::size_t>(arguments.points);
  config.has_bends = is_described;
  return config;
}

// One picture: what it shows of the arm.
struct Look {
  Sighting sighting;
  std::string reason;  // Why there is none.
  std::vector<std::string> notes;
  std::size_t samples = 0;
  bool is_of_other_size = false;  // As far as the camera's description tells.
};

Look look_at(const PictureFile& picture, const MeasuredCamera& camera, const EstimateConfig& config) {
  Look look;
  const auto& [name, file] = picture;
  const ShapePrior& prior = config.prior;
  const Photograph photograph = linear_light(decode_picture(bytes_of(file), name), camera.gamma);
  const View view{camera.lens(), camera.pose(), photograph.bytes.width(), photograph.bytes.height()};
  if (const auto other = camera.other_size(view.width, view.height)) throw input_error(name, *other);
  ArmFinderConfig finding;
  finding.threshold = config.threshold;
  if (prior.is_base_position_known) finding.base = view.project(prior.arm.X_WB.position);
  ArmFinder finder(finding);
  const ArmSighting& found = finder.find(photograph);
  look.reason = found.reason, look.notes = found.notes;
  // A camera that says for which size it is described has been held to it.
  auto hint = camera.size ? std::nullopt : hint_of_size(view.lens, view.width, view.height);
  look.is_of_other_size = hint.has_value();
  if (hint) look.notes.push_back(std::move(*hint));
  if (!photograph.is_mask)
    if (auto note = hint_of_exposure(gray_picture(photograph.bytes))) look.notes.push_back(std::move(*note));
  look.sighting = sighting_of(found, view, photograph.bytes);
  if (look.sighting.leaves_out) look.notes.emplace_back(rays_lacking);
  look.sighting.doubt = {camera.doubt.turn, camera.doubt.focal};
  look.samples = look.sighting.points.size();
  return look;
}

Node image_node(const std::string& name, const MeasuredCamera& camera, const Look& look,
                const std::optional<ViewError>& error) {
  Node::Table entry{{"image", {}, text_node(name)},
                    {"camera", {}, text_node(camera.name)},
                    {"points", {}, {static_cast<std::int64_t>(look.samples), {}}}};
  if (error) {
    Node::Table off{{"turn", {}, vector(error->turn)}, {"focal", {}, number_node(error->focal)}};
    entry.push_back({"camera_error", {}, {std::move(off), {}}});
  }
  if (!look.reason.empty()) entry.push_back({"reason", {}, text_node(look.reason)});
  if (!look.notes.empty()) entry.push_back({"notes", {}, texts_node(look.notes)});
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
void add_plane_angles(std::span<const Sighting> sightings, std::size_t count, Node::Table& answer) {
  if (sightings.size() != 2) return;
  const Pose &first = sightings[0].view.X_WC, &second = sightings[1].view.X_WC;
  const bool is_front_first = stand_for_planes(first, second);
  if (!is_front_first && !stand_for_planes(second, first)) return;
  const auto angles = is_front_first ? plane_angles(sightings[0], sightings[1], count)
                                     : plane_angles(sightings[1], sightings[0], count);
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
                      {"at", {}, vector(backbone.pose(std::min(marker.s, backbone.length())).position)},
                      {"images", {}, {static_cast<std::int64_t>(marker.looks), {}}}};
    markers.push_back({std::move(entry), {}});
  }
  answer.push_back({"markers", {}, {std::move(markers), {}}});
}

void add_shape(const ShapeEstimate& found, std::span<const Sighting> sightings, const EstimateConfig& config,
               Node::Table& answer) {
  const Backbone backbone(found.shape.arm, found.shape.state);
  const std::size_t count = config.points;
  Node::Array points;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    points.push_back(vector(backbone.pose(share * backbone.length()).position));
  }
  answer.push_back({"backbone", {}, {std::move(points), {}}});
  add_angles(direction_angles(backbone, count), "", answer);
  add_plane_angles(sightings, count, answer);
  answer.push_back({"length", {}, number_node(backbone.length())});
  answer.push_back({"sigma", {}, number_node(found.rms_sigma())});
  answer.push_back({"sigmas", {}, {sigmas_at(found, count, backbone.length()), {}}});
  answer.push_back({"rms_px", {}, number_node(found.rms)});
  add_markers(found, backbone, answer);
  if (!config.has_bends) return;
  answer.push_back({"bends", {}, bends_node(found.shape.state)});
}

}  // namespace

std::vector<MeasuredCamera> standing_cameras(const Node& file, std::size_t count) {
  auto cameras = read_as<MeasuredCameras>(file).camera;
  check_poses(file, cameras);
  if (cameras.size() != count)
    throw InputError(
        {{file.find("camera")->where,
          fmt::format("camera: {} for {} pictures: expected one for each", cameras.size(), count)}});
  return cameras;
}

ShapeAnswer estimate_shape(std::span<const PictureFile> pictures, const std::vector<MeasuredCamera>& cameras,
                           const EstimateConfig& config) {
  std::vector<Look> looks;
  std::vector<Sighting> sightings;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    looks.push_back(look_at(pictures[i], cameras[i], config));
    sightings.push_back(looks.back().sighting);
  }
  ShapeEstimate found = ShapeEstimator(config.prior, config.estimator).estimate(sightings);
  if (found.is_found && !config.prior.is_base_position_known)
    found.notes.emplace_back(
        "which end is the base is guessed: the one that the border of the first picture cuts, or the lower "
        "one; --base tells");
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const auto same = std::ranges::find_if(
        pictures.first(i), [&](const PictureFile& other) { return other.bytes == pictures[i].bytes; });
    if (same != pictures.first(i).end())
      found.notes.push_back(
          fmt::format("pictures {} and {} are the same", same - pictures.begin() + 1, i + 1));
  }
  if (auto hint = hint_of(config.prior, sightings, found)) found.notes.push_back(std::move(*hint));
  const auto& sections = config.prior.arm.sections;
  if (config.has_bends && !found.is_trusted() && sections.size() > 1 &&
      std::ranges::any_of(sections, &Section::can_stretch))
    found.notes.emplace_back("its sections are taken to stretch alike");
  for (std::size_t i = 0; i < looks.size(); ++i)
    if (!found.is_found && !looks[i].is_of_other_size && !looks[i].notes.empty())
      found.notes.push_back(fmt::format("picture {} has notes of its own", i + 1));
  for (std::size_t i = 0; i < looks.size(); ++i)
    if (looks[i].is_of_other_size)
      found.notes.push_back(fmt::format(
          "picture {} may be of another size than its camera is described for: see its own notes", i + 1));
  Node::Array images;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    std::optional<ViewError> error;
    if (found.is_found && sightings[i].doubt.is_any()) error = found.shape.views.at(i);
    images.push_back(image_node(pictures[i].name, cameras[i], looks[i], error));
  }
  Node::Table answer{{"found", {}, {found.is_found, {}}}, {"trusted", {}, {found.is_trusted(), {}}}};
  if (found.is_found)
    add_shape(found, sightings, config, answer);
  else
    answer.push_back({"reason", {}, text_node(found.reason)});
  if (!found.notes.empty()) answer.push_back({"notes", {}, texts_node(found.notes)});
  answer.push_back({"images", {}, {std::move(images), {}}});
  return {{std::move(answer), {}}, found.is_found};
}

int estimate_command(const EstimateArguments& arguments, std::ostream& out) {
  check(arguments);
  const auto cameras = standing_cameras(read_toml_file(arguments.cameras), arguments.images.size());
  const EstimateConfig config = estimate_config(arguments);
  std::vector<PictureFile> pictures;
  pictures.reserve(arguments.images.size());
  for (const std::string& name : arguments.images)
    pictures.push_back({name, read_text_file(name, most_picture_bytes)});
  const ShapeAnswer found = estimate_shape(pictures, cameras, config);
  out << write_json(found.answer, 2) << '\n';
  return found.is_found ? exit_done : exit_missed;
}

}  // namespace flexura
