#include "flexura/app/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <ostream>
#include <utility>

#include "flexura/app/commands.h"
#include "flexura/app/estimate_answer.h"
#include "flexura/app/estimate_guess.h"
#include "flexura/app/terminal_progress.h"
#include "flexura/base/bytes.h"
#include "flexura/base/source.h"
#include "flexura/camera/measured_camera.h"
#include "flexura/estimate/picture_observation.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/estimate/shape_hint.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "flexura/store/toml.h"
#include "flexura/vision/arm_finder.h"
#include "flexura/vision/linear_light.h"
#include "flexura/vision/picture_file.h"
#include "flexura/vision/picture_hints.h"

namespace flexura {
namespace {

// One picture's evidence for the estimation.
struct PictureObservation {
  PictureReport report;
  Observation observation;
  // Whether the picture seems to have another size than the camera is described for.
  bool is_of_other_size = false;
  bool contradicts = false;  // Whether the figure contradicts the given base or arm.
};

// Returns the least and the greatest width of the arm in a picture, px, if its radius and base are known. The
// arm may reach towards the camera or away from it by its length.
std::optional<std::array<double, 2>> expected_width(const ShapePrior& prior, const View& view, double focal) {
  double thinnest = std::numeric_limits<double>::infinity(), thickest = 0;
  for (const Section& section : prior.arm.sections)
    for (const double radius : section.radius)
      thinnest = std::min(thinnest, radius), thickest = std::max(thickest, radius);
  if (!prior.is_base_position_known || !(thinnest > 0)) return std::nullopt;
  const double depth = (view.X_WC.rotation.transpose() * (prior.arm.X_WB.position - view.X_WC.position)).z(),
               reach = prior.arm.length();
  if (depth <= 0) return std::nullopt;
  constexpr double grace = 1.5;
  const double most = depth > reach ? 2 * thickest * focal / (depth - reach) * grace
                                    : std::numeric_limits<double>::infinity();
  return std::array{2 * thinnest * focal / (depth + reach) / grace, most};
}

PictureObservation observe(const PictureFile& picture, const MeasuredCamera& camera,
                           const EstimateConfig& config, std::size_t index) {
  const auto& [name, file] = picture;
  const ShapePrior& prior = config.prior;
  const Photograph photograph = linear_light(decode_picture(bytes_of(file), name), camera.gamma);
  const View view{camera.lens(), camera.pose(), photograph.bytes.width(), photograph.bytes.height()};
  if (const auto other = camera.other_size(view.width, view.height)) throw input_error(name, *other);
  ArmFinderConfig finding;
  finding.threshold = config.threshold;
  if (prior.is_base_position_known) finding.base = view.project(prior.arm.X_WB.position);
  finding.cuts_at_base = true;
  finding.width = expected_width(prior, view, view.lens.intrinsics().fx);
  if (index < config.scenes.size()) finding.scene = config.scenes[index];
  ArmFinder finder(finding);
  const ArmObservation& found = finder.find(photograph);
  PictureObservation observed{{name, camera.name, found.reason, found.notes},
                              observation_of(found, view, photograph.bytes)};
  observed.contradicts = found.contradicts;
  auto& notes = observed.report.notes;
  // A camera with a given size has already been checked against the picture.
  auto hint = camera.size ? std::nullopt : hint_of_size(view.lens, view.width, view.height);
  observed.is_of_other_size = hint.has_value();
  if (hint) notes.push_back(std::move(*hint));
  if (!photograph.is_mask)
    if (auto note = hint_of_exposure(gray_picture(photograph.bytes))) notes.push_back(std::move(*note));
  if (observed.observation.leaves_out) notes.emplace_back(rays_lacking);
  observed.observation.view_prior = camera.prior;
  return observed;
}

// Adds the notes that concern all pictures together.
void add_notes(std::span<const PictureFile> pictures, std::span<const Observation> observations,
               const EstimateConfig& config, ShapeEstimate& found) {
  if (found.is_found && !config.prior.is_base_position_known)
    found.notes.emplace_back(
        "assumed that the arm's base is the end at the border of the first picture, or the lower end: give "
        "the base with --base");
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const auto same = std::ranges::find_if(
        pictures.first(i), [&](const PictureFile& other) { return other.bytes == pictures[i].bytes; });
    if (same != pictures.first(i).end())
      found.notes.push_back(
          fmt::format("pictures {} and {} are identical", same - pictures.begin() + 1, i + 1));
  }
  if (auto hint = hint_of(config.prior, observations, found)) found.notes.push_back(std::move(*hint));
  const auto& sections = config.prior.arm.sections;
  if (config.has_bends && !found.is_trusted() && sections.size() > 1 &&
      std::ranges::any_of(sections, &Section::can_stretch))
    found.notes.emplace_back("all sections are assumed to have equal stretches");
}

}  // namespace

ShapeAnswer estimate_shape(std::span<const PictureFile> pictures, const std::vector<MeasuredCamera>& cameras,
                           const EstimateConfig& config, Progress* progress) {
  if (config.guess) return estimate_near_guess(pictures, cameras, config, progress);
  // The estimation takes about as long as a picture.
  const auto all = static_cast<double>(cameras.size() + 1);
  std::vector<PictureReport> report;
  std::vector<Observation> observations;
  std::vector<std::string> notes, doubts;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (progress != nullptr)
      progress->update(static_cast<double>(i) / all, "finding the arm in " + pictures[i].name);
    PictureObservation observed = observe(pictures[i], cameras[i], config, i);
    if (observed.is_of_other_size)
      doubts.push_back(fmt::format(
          "picture {} may not have the size of its camera in the file: see the picture's notes", i + 1));
    else if (!observed.report.notes.empty())
      notes.push_back(fmt::format("see the notes of picture {}", i + 1));
    if (observed.contradicts)
      doubts.push_back(
          fmt::format("the figure in picture {} contradicts the given base or arm: see its notes", i + 1));
    report.push_back(std::move(observed.report)), observations.push_back(std::move(observed.observation));
  }
  if (progress != nullptr) progress->update(1 - 1 / all, "estimating the shape");
  ShapeEstimate found = ShapeEstimator(config.prior, config.estimator).estimate(observations);
  add_notes(pictures, observations, config, found);
  if (!found.is_found) found.notes.insert(found.notes.end(), notes.begin(), notes.end());
  found.notes.insert(found.notes.end(), doubts.begin(), doubts.end());
  return {estimate_node(found, observations, report, config), found.is_found};
}

int estimate_command(const EstimateArguments& arguments, std::ostream& out, TerminalProgress* progress) {
  check_arguments(arguments);
  const auto cameras = standing_cameras(read_toml_file(arguments.cameras), arguments.images.size());
  EstimateConfig config = estimate_config(arguments);
  std::vector<double> gammas;
  gammas.reserve(cameras.size());
  for (const MeasuredCamera& camera : cameras) gammas.push_back(camera.gamma);
  config.scenes = arm_scenes(arguments.scene, gammas);
  std::vector<PictureFile> pictures;
  pictures.reserve(arguments.images.size());
  for (const std::string& name : arguments.images)
    pictures.push_back({name, read_text_file(name, most_picture_bytes)});
  const ShapeAnswer found = estimate_shape(pictures, cameras, config, progress);
  if (progress != nullptr) progress->clear();
  out << write_json(found.answer, 2) << '\n';
  return found.is_found ? exit_done : exit_missed;
}

}  // namespace flexura
