#include "flexura/app/estimate_guess.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "flexura/app/estimate_answer.h"
#include "flexura/base/bytes.h"
#include "flexura/base/source.h"
#include "flexura/estimate/tube_fit.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "flexura/vision/linear_light.h"
#include "flexura/vision/picture_file.h"
#include "flexura/vision/picture_hints.h"

namespace flexura {
namespace {

// Returns a number; nothing if the node has no value or is not finite.
std::optional<double> number_in(const Node& node) {
  double number = 0;
  if (const auto* real = node.as<double>())
    number = *real;
  else if (const auto* whole = node.as<std::int64_t>())
    number = static_cast<double>(*whole);
  else
    return std::nullopt;
  constexpr double most = 1e3;
  return std::abs(number) <= most ? std::optional(number) : std::nullopt;
}

Eigen::Vector2d bend_in(const Node& node, std::size_t section, bool is_planar) {
  const auto* pair = node.as<Node::Array>();
  const auto x = pair != nullptr && pair->size() == 2 ? number_in((*pair)[0]) : std::nullopt;
  const auto y = x ? number_in((*pair)[1]) : std::nullopt;
  if (!y) throw InputError({{node.where, fmt::format("bends[{}]: expected two numbers, rad", section)}});
  if (is_planar && *y != 0)
    throw InputError({{node.where, fmt::format("bends[{}]: expected 0 as the second number, because the arm "
                                               "is planar",
                                               section)}});
  return {*x, *y};
}

}  // namespace

Shape read_guess(const std::string& file, const Arm& arm) {
  constexpr std::size_t most_bytes = std::size_t{1} << 24;
  const Node document = parse_json(read_text_file(file, most_bytes), file);
  const Node* found = document.as<Node::Table>() == nullptr ? nullptr : document.find("bends");
  const auto* bends = found == nullptr ? nullptr : found->as<Node::Array>();
  if (bends == nullptr)
    throw input_error(file,
                      "expected an object with the key \"bends\", such as an answer of estimate with "
                      "--arm");
  if (bends->size() != arm.sections.size())
    throw InputError({{found->where, fmt::format("bends: {} bends for {} sections: expected one per section",
                                                 bends->size(), arm.sections.size())}});
  Shape guess{arm, ArmState::straight(arm.sections.size())};
  for (std::size_t i = 0; i < bends->size(); ++i)
    guess.state.bends[i] = bend_in((*bends)[i], i, arm.kind == ArmKind::planar);
  return guess;
}

ShapeAnswer estimate_near_guess(std::span<const PictureFile> pictures,
                                const std::vector<MeasuredCamera>& cameras, const EstimateConfig& config,
                                Progress* progress) {
  std::vector<PictureReport> report;
  std::vector<Image<std::uint8_t>> images;
  std::vector<TubePicture> tubes;
  std::vector<ViewPrior> view_priors;
  images.reserve(pictures.size());
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const auto& [name, file] = pictures[i];
    const MeasuredCamera& camera = cameras[i];
    images.push_back(linear_light(decode_picture(bytes_of(file), name), camera.gamma).bytes);
    const View view{camera.lens(), camera.pose(), images[i].width(), images[i].height()};
    if (const auto other = camera.other_size(view.width, view.height)) throw input_error(name, *other);
    PictureReport one{name, camera.name, "", {}};
    auto hint = camera.size ? std::nullopt : hint_of_size(view.lens, view.width, view.height);
    if (hint) one.notes.push_back(std::move(*hint));
    report.push_back(std::move(one));
    const ArmScene* scene = i < config.scenes.size() ? config.scenes[i].get() : nullptr;
    tubes.push_back({&images[i], view, camera.prior, scene});
    view_priors.push_back(camera.prior);
  }
  if (progress != nullptr) progress->update(0.5, "fitting the arm near the guess");
  EstimatorConfig estimator = TubeFitter::default_estimator();
  TubeFit fit = TubeFitter(config.prior, estimator)
                    .fit(tubes, rough_prediction(config.prior, *config.guess, config.guess_std, view_priors));
  for (std::size_t i = 0; i < report.size(); ++i) {
    if (fit.observations[i].points.empty()) report[i].reason = "no part of the arm was found near the guess";
    if (!fit.pictures[i].complaint.empty()) {
      report[i].notes.push_back(fit.pictures[i].complaint);
      fit.estimate.notes.push_back(fmt::format("see the notes of picture {}", i + 1));
    }
  }
  return {estimate_node(fit.estimate, fit.observations, report, config), fit.estimate.is_found};
}

}  // namespace flexura
