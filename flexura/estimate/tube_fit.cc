#include "flexura/estimate/tube_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace flexura {
namespace {

// The search becomes narrower by this factor at most, down to the least standard deviation, px.
constexpr double narrowing = 0.4, least_reach = 0.8;
// Correlation length of the errors of edges along the arm, px, by texture; and their error that all have in
// common, as a share of their standard deviation and at least, px.
constexpr double correlated = 6, common_share = 0.3, least_common = 0.01;

}  // namespace

EstimatorConfig TubeFitter::default_estimator() {
  EstimatorConfig config;
  config.uncertain = 1e-3;
  return config;
}

TubeFitter::TubeFitter(ShapePrior prior, const EstimatorConfig& estimator, const TubeFitConfig& config)
    : prior_(prior), config_(config), estimator_(std::move(prior), estimator) {}

// Measures the sections of picture i.
void TubeFitter::observe(std::size_t i, bool is_fine, TubeFit& fit) {
  expected_.clear(), of_section_.clear();
  for (std::size_t k = 0; k < sections_[i].size(); ++k)
    if (sections_[i][k].is_measurable)
      expected_.push_back(sections_[i][k].expected), of_section_.push_back(k);
  RimSearch& search = searches_[i];
  if (is_fine)
    search.refine(expected_, seen_);
  else
    search.look(expected_, seen_);
  Observation& observation = fit.observations[i];
  observation.points.clear();
  observation.reach.sigma = correlated;
  TubeVisibility& picture = fit.pictures[i];
  picture.expected = expected_.size();
  if (is_fine) picture.measured = picture.both = 0, picture.width_ratio = search.width_ratio();
  const std::size_t tip = seen_.size() - seen_.size() / 5;
  const auto is_measured = [](const SeenSection& one) { return one.rims > 0; };
  if (is_fine && tip < seen_.size())
    picture.tip_share = static_cast<double>(std::count_if(seen_.begin() + static_cast<std::ptrdiff_t>(tip),
                                                          seen_.end(), is_measured)) /
                        static_cast<double>(seen_.size() - tip);
  if (!is_fine) picture.lit = 0;
  for (std::size_t k = 0; k < seen_.size(); ++k) {
    if (seen_[k].rims == 0) continue;
    const TubeSection& section = sections_[i][of_section_[k]];
    const double common = std::max(least_common, common_share * seen_[k].sigma);
    observation.points.push_back(
        {section.pixel + seen_[k].shift * section.normal, seen_[k].sigma, is_fine ? common : 0.0});
    if (is_fine)
      ++picture.measured, picture.both += seen_[k].rims == 2 ? 1 : 0;
    else
      ++picture.lit;
  }
}

// Makes the search narrower. Returns false if it is as narrow as possible.
bool TubeFitter::narrow(TubeImage& image, const ShapeEstimate& estimate) {
  bool is_wide = false;
  if (!image.set(estimate.shape, estimate.covariance)) return false;
  Sections next;
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    image.sections(i, next);
    for (std::size_t k = 0; k < next.size(); ++k) {
      const double before = sections_[i][k].expected.reach;
      double& reach = next[k].expected.reach;
      if (!std::isfinite(reach)) reach = before;
      reach = std::max({std::min(reach, before), narrowing * before, least_reach});
      is_wide = is_wide || (next[k].is_measurable && reach > 1.5 * least_reach);
    }
    std::swap(sections_[i], next);
  }
  return is_wide;
}

TubeFit TubeFitter::fit(std::span<const TubePicture> pictures, const ShapePrediction& start) {
  TubeFit fit;
  fit.observations.resize(pictures.size()), fit.pictures.resize(pictures.size());
  searches_.resize(pictures.size()), sections_.assign(pictures.size(), {});
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    fit.observations[i].view = pictures[i].view, fit.observations[i].view_prior = pictures[i].view_prior;
    searches_[i].begin(*pictures[i].picture, pictures[i].scene);
    fit.pictures[i].complaint = searches_[i].complaint();
  }
  TubeImage image(prior_, fit.observations);
  fit.estimate.shape = start.mean;
  if (!image.set(start.mean, start.covariance)) {
    fit.estimate.reason = "the guessed shape is not in front of all cameras";
    return fit;
  }
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    image.sections(i, sections_[i]);
    for (TubeSection& section : sections_[i])
      section.expected.reach = std::max(section.expected.reach, least_reach);
  }
  const auto update = [&](bool is_fine) {
    for (std::size_t i = 0; i < pictures.size(); ++i) observe(i, is_fine, fit);
    if (!are_enough(fit.observations)) return false;
    ShapeEstimate next = estimator_.update(fit.observations, start);
    const bool is_usable = next.covariance.size() > 0 && next.covariance.allFinite();
    if (is_usable || is_fine) fit.estimate = std::move(next);
    return is_usable;
  };
  bool is_seen = true;
  for (int pass = 0; pass < config_.most_passes && is_seen; ++pass)
    is_seen = update(false) && (narrow(image, fit.estimate) || pass == 0);
  for (int pass = 0; pass < config_.refinements; ++pass) {
    if (fit.estimate.covariance.size() == 0) break;
    (void)narrow(image, fit.estimate);
    if (!update(true)) break;
  }
  look_beside(fit);
  judge(fit);
  return fit;
}

// A fit can end at something else that has edges. Then the arm itself is beside it.
void TubeFitter::look_beside(TubeFit& fit) {
  constexpr double reach = 45;  // px
  for (std::size_t i = 0; i < fit.pictures.size(); ++i) {
    expected_.clear();
    for (const TubeSection& section : sections_[i])
      if (section.is_measurable) expected_.push_back(section.expected);
    if (expected_.empty()) continue;
    searches_[i].look(expected_, seen_);
    const std::vector<bool> elsewhere = searches_[i].looks_elsewhere(expected_, reach);
    std::size_t longest = 0, length = 0, others = 0;
    for (const bool is_elsewhere : elsewhere) {
      // Single sections in between may be hidden.
      others = is_elsewhere ? 0 : others + 1;
      length = others > 1 ? 0 : length + (is_elsewhere ? 1 : 0);
      longest = std::max(longest, length);
    }
    fit.pictures[i].elsewhere = static_cast<double>(longest) / static_cast<double>(elsewhere.size());
  }
}

void TubeFitter::judge(TubeFit& fit) const {
  ShapeEstimate& estimate = fit.estimate;
  for (std::size_t i = 0; i < fit.pictures.size(); ++i) {
    const TubeVisibility& picture = fit.pictures[i];
    const double all = static_cast<double>(std::max<std::size_t>(picture.expected, 1));
    const double measured = static_cast<double>(picture.measured) / all;
    const double lit = static_cast<double>(picture.lit) / all;
    if (std::min(measured, lit) < config_.least_visible || estimate.covariance.size() == 0) {
      if (estimate.is_found || estimate.reason.empty())
        estimate.reason = fmt::format(
            "in picture {}, the arm's borders were found along {:.0f} % of the arm near the guessed shape: "
            "expected {:.0f} % at least",
            i + 1, 100 * std::min(measured, lit), 100 * config_.least_visible);
      estimate.is_found = false;
      continue;
    }
    if (std::min(measured, lit) < config_.trusted_visible)
      estimate.notes.push_back(fmt::format("in picture {}, only {:.0f} % of the arm is visible", i + 1,
                                           100 * std::min(measured, lit)));
    if (picture.tip_share < config_.trusted_tip)
      estimate.notes.push_back(
          fmt::format("in picture {}, only {:.0f} % of the last fifth of the arm is visible", i + 1,
                      100 * picture.tip_share));
    if (picture.elsewhere > config_.most_elsewhere)
      estimate.notes.push_back(
          fmt::format("in picture {}, something beside {:.0f} % of the fitted shape looks more like the arm",
                      i + 1, 100 * picture.elsewhere));
    constexpr double most_wider = 0.15;
    if (std::abs(picture.width_ratio - 1) > most_wider)
      estimate.notes.push_back(fmt::format("in picture {}, the arm looks {:.2f} times as wide as described",
                                           i + 1, picture.width_ratio));
  }
  if (estimate.innovation > config_.most_innovation)
    estimate.notes.push_back(
        fmt::format("the arm is {:.1f} standard deviations from the guessed shape: expected {} at most",
                    estimate.innovation, config_.most_innovation));
}

ShapePrediction rough_prediction(const ShapePrior& prior, const Shape& mean, double bend_std,
                                 std::span<const ViewPrior> views) {
  std::vector<Observation> observations(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) observations[i].view_prior = views[i];
  const ShapeVariables variables(prior, observations);
  Eigen::VectorXd sigma(variables.count());
  Eigen::Index at = variables.bends_a_section() * static_cast<Eigen::Index>(prior.arm.sections.size());
  sigma.head(at).setConstant(bend_std);
  constexpr double of_length = 0.01, of_direction = 0.05, of_stretch = 0.02;
  if (!prior.is_base_position_known)
    sigma.segment<3>(at).setConstant(of_length * prior.arm.length()), at += 3;
  if (!prior.is_base_direction_known) sigma.segment<2>(at).setConstant(of_direction), at += 2;
  if (!prior.is_length_known) sigma[at] = of_stretch;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Eigen::Index first = variables.of_view(i);
    if (first < 0) continue;
    constexpr double least = 1e-6;
    sigma.segment<3>(first).setConstant(std::max(views[i].rotation_std, least));
    sigma[first + 3] = std::max(views[i].focal_std, least);
  }
  ShapePrediction prediction{mean, sigma.cwiseAbs2().asDiagonal(), true};
  prediction.mean.views.resize(views.size());
  return prediction;
}

}  // namespace flexura
