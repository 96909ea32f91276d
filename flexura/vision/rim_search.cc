#include "flexura/vision/rim_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "flexura/math/median.h"
#include "flexura/vision/border.h"
#include "flexura/vision/edge_finder.h"

namespace flexura {
namespace {

// Pixels whose light is correlated by blur and texture count as one.
constexpr double alike = 3;

Image<std::uint8_t> plane_of(const Image<std::uint8_t>& picture, int channel) {
  Image<std::uint8_t> plane(picture.width(), picture.height());
  const auto step = static_cast<std::size_t>(picture.channels());
  for (std::size_t i = 0; i < plane.values().size(); ++i)
    plane.values()[i] = picture.values()[i * step + static_cast<std::size_t>(channel)];
  return plane;
}

// Returns a part of a picture at its place in a picture of the given size; 0 elsewhere.
Image<std::uint8_t> whole_of(const Image<std::uint8_t>& part, const PixelBox& box, int width, int height) {
  Image<std::uint8_t> whole(width, height);
  for (int v = box.top; v < box.bottom; ++v)
    std::ranges::copy(part.row(v - box.top), whole.row(v).begin() + box.left);
  return whole;
}

// Returns the light on a side of an edge: the mean of samples from 1.5 to 4.5 px away.
double light_beside(const EdgeFinder<std::uint8_t>& finder, const Eigen::Vector2d& from,
                    const Eigen::Vector2d& way) {
  double sum = 0, count = 0;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2d place = from + (k + 2) * way;
    if (finder.holds(place)) sum += finder.at(place), ++count;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace

void RimSearch::begin(const Image<std::uint8_t>& picture, const ArmScene* scene) {
  planes_.clear(), complaint_.clear(), inside_ = {};
  blur_ = 0, width_ratio_ = 1;
  for (int c = 0; c < picture.channels(); ++c) planes_.push_back(plane_of(picture, c));
  if (scene == nullptr) return;
  const ScenePart part = part_in_scene(*scene, picture);
  complaint_ = part.reason;
  if (!part.reason.empty()) return;
  const int width = picture.width(), height = picture.height();
  if (!scene->region.empty()) {
    Image<std::uint8_t> all(part.box.right - part.box.left, part.box.bottom - part.box.top);
    std::ranges::fill(all.values(), std::uint8_t{255});
    inside_ = whole_of(part.inside.values().empty() ? all : part.inside, part.box, width, height);
  }
  if (part.has_matte) planes_.push_back(whole_of(part.matte, part.box, width, height));
}

// The shift d moves the second rim outwards and the first inwards. The score of a rim's place is the
// logarithm of the likelihood that what is inside is the tube and what is outside is not.
int RimSearch::score(std::size_t i, int& pixels) {
  const int reach = light_.profile(i, 0).reach;
  score_.assign(2 * static_cast<std::size_t>(reach) + 1, 0);
  int rims = 0;
  pixels = 0;
  for (const std::size_t rim : {std::size_t{0}, std::size_t{1}}) {
    const RimLight::Profile& one = light_.profile(i, rim);
    if (!one.is_seen) continue;
    ++rims, pixels += one.inner + one.outer;
    const auto sums = light_.log_ratio_sums(one);
    for (int d = -reach; d <= reach; ++d) {
      const int shift = rim == 1 ? reach + d : reach - d, place = reach + d;
      const auto from = static_cast<std::size_t>(shift);
      const auto edge = from + static_cast<std::size_t>(one.inner),
                 to = edge + static_cast<std::size_t>(one.outer);
      score_[static_cast<std::size_t>(place)] += (2 * sums[edge] - sums[from] - sums[to]) / alike;
    }
  }
  return rims;
}

SeenSection RimSearch::match(std::size_t i, const ExpectedSection& section) {
  const int reach = light_.profile(i, 0).reach;
  int pixels = 0;
  const int rims = score(i, pixels);
  if (rims == 0) return {};
  const double width = 2 * section.reach * section.reach;
  std::size_t best = 0;
  double most = -std::numeric_limits<double>::infinity();
  const auto likely = [&](std::size_t k) {
    const double d = static_cast<double>(k) - reach;
    return score_[k] - d * d / width;
  };
  for (std::size_t k = 0; k < score_.size(); ++k)
    if (likely(k) > most) most = likely(k), best = k;
  double weight = 0, mean = 0, square = 0;
  for (std::size_t k = 0; k < score_.size(); ++k) {
    const double d = static_cast<double>(k) - reach, share = std::exp(likely(k) - most);
    weight += share, mean += share * d, square += share * d * d;
  }
  mean /= weight;
  const double sigma = std::sqrt(std::max(square / weight - mean * mean, 0.0));
  // The score has a sharp top; a rim without contrast has none.
  constexpr double informed = 0.7, least_score = 0.1, least_sigma = 0.5;
  const bool is_clear = sigma < informed * std::max(section.reach, 1.0) &&
                        score_[best] * alike > least_score * pixels &&
                        std::abs(static_cast<double>(best) - reach - mean) < 2 * std::max(sigma, 1.0);
  if (!is_clear) return {};
  return {rims, mean, std::max(sigma, least_sigma)};
}

void RimSearch::look(std::span<const ExpectedSection> sections, std::vector<SeenSection>& seen) {
  light_.measure(planes_, inside_, sections);
  seen.assign(sections.size(), {});
  for (std::size_t i = 0; i < sections.size(); ++i) seen[i] = match(i, sections[i]);
}

std::vector<bool> RimSearch::looks_elsewhere(std::span<const ExpectedSection> sections, double reach) {
  std::vector<ExpectedSection> wide(sections.begin(), sections.end());
  for (ExpectedSection& section : wide) section.reach = reach / 2.5;
  light_.measure(planes_, inside_, wide, true);
  constexpr int near = 3;
  struct Scores {
    double here = 0, beside = 0;
  };
  std::vector<Scores> scores(wide.size());
  ratios_.clear();
  for (std::size_t i = 0; i < wide.size(); ++i) {
    int pixels = 0;
    if (score(i, pixels) == 0) continue;
    const int middle = light_.profile(i, 0).reach;
    for (int d = -middle; d <= middle; ++d) {
      const int place = d + middle;
      const double one = score_[static_cast<std::size_t>(place)] / pixels;
      double& most = std::abs(d) <= near ? scores[i].here : scores[i].beside;
      most = std::max(most, one);
    }
    if (scores[i].here > 0) ratios_.push_back(scores[i].here);
  }
  // As much as the median section does, and much more than this one.
  constexpr double alike_share = 0.7, more = 0.4;
  const double usual = ratios_.empty() ? 0.0 : median(std::span(ratios_));
  std::vector<bool> elsewhere;
  elsewhere.reserve(scores.size());
  for (const auto& [here, beside] : scores)
    elsewhere.push_back(usual > 0 && beside > alike_share * usual && beside > here + more * usual);
  return elsewhere;
}

// The plane with the greatest contrast is measured.
RimSearch::Edge RimSearch::edge(const ExpectedRim& rim, double room, double blur, double& misfit) {
  constexpr double least_contrast = 8, most_offset = 2, most_misfit = 0.3, least_sigma = 0.02;
  misfit = std::numeric_limits<double>::infinity();
  if (!rim.is_visible || !rim.pixel.allFinite()) return {};
  if (!inside_.values().empty()) {
    const int u = static_cast<int>(std::lround(rim.pixel.x())),
              v = static_cast<int>(std::lround(rim.pixel.y()));
    if (u < 0 || v < 0 || u >= inside_.width() || v >= inside_.height() ||
        inside_.row(v)[static_cast<std::size_t>(u)] == 0)
      return {};
  }
  const Image<std::uint8_t>* plane = nullptr;
  double most = least_contrast;
  for (const Image<std::uint8_t>& one : planes_) {
    const EdgeFinder<std::uint8_t> finder(one, 1, steps_);
    const double contrast =
        light_beside(finder, rim.pixel, rim.outward) - light_beside(finder, rim.pixel, -rim.outward);
    if (std::abs(contrast) > std::abs(most)) most = contrast, plane = &one;
  }
  if (plane == nullptr) return {};
  const EdgeFinder<std::uint8_t> finder(*plane, most > 0 ? 1 : -1, steps_, lone_border_blur);
  Edge found;
  for (int pass = 0; pass < 3; ++pass) {
    const auto fit = finder.look(rim.pixel + found.offset * rim.outward, rim.outward, blur, room);
    if (!fit || !(fit->contrast > least_contrast)) return {};
    found.offset += fit->offset;
    if (!(std::abs(found.offset) < most_offset)) return {};
    misfit = fit->residual / fit->contrast;
    constexpr double rounding = 0.3;
    found.sigma = std::max(fit->sigma * std::max(fit->residual, rounding) / fit->contrast, least_sigma);
    if (std::abs(fit->offset) < 0.1) break;
  }
  found.is_seen = misfit < most_misfit;
  return found;
}

void RimSearch::find_blur(std::span<const ExpectedSection> sections) {
  const BlurSeries series{.first = 0.5, .ratio = 1.3};
  constexpr std::size_t tries = 7, spread = 40;
  std::vector<double> misfits, left;
  for (std::size_t k = 0; k < tries; ++k) {
    misfits.clear();
    for (std::size_t i = 0; i < sections.size(); i += std::max<std::size_t>(1, sections.size() / spread))
      for (const ExpectedRim& rim : sections[i].rims) {
        double misfit = 0;
        (void)edge(rim, 0.4 * sections[i].width, series.at(k), misfit);
        if (misfit < 1) misfits.push_back(misfit);
      }
    constexpr std::size_t few = 6;
    left.push_back(misfits.size() < few ? std::numeric_limits<double>::infinity()
                                        : median(std::span(misfits)));
  }
  blur_ = std::ranges::all_of(left, [](double one) { return std::isinf(one); }) ? 1 : series.least(left);
}

void RimSearch::refine(std::span<const ExpectedSection> sections, std::vector<SeenSection>& seen) {
  find_blur(sections);
  seen.assign(sections.size(), {});
  edges_.assign(sections.size(), {});
  ratios_.clear();
  for (std::size_t i = 0; i < sections.size(); ++i) {
    double misfit = 0;
    for (std::size_t rim = 0; rim < 2; ++rim)
      edges_[i][rim] = edge(sections[i].rims[rim], 0.4 * sections[i].width, blur_, misfit);
    if (edges_[i][0].is_seen && edges_[i][1].is_seen)
      ratios_.push_back(1 + (edges_[i][0].offset + edges_[i][1].offset) / sections[i].width);
  }
  constexpr std::size_t few = 5;
  width_ratio_ = ratios_.size() < few ? 1.0 : median(std::span(ratios_));
  for (std::size_t i = 0; i < sections.size(); ++i) {
    // Both borders are as much farther out as the tube is wider; one alone is less certain.
    constexpr double tolerance = 4, slack = 0.3, of_width = 0.01;
    const double wider = 0.5 * (width_ratio_ - 1) * sections[i].width;
    const auto& [first, second] = edges_[i];
    const double before = wider - first.offset, after = second.offset - wider;
    const double other = of_width * sections[i].width;
    if (first.is_seen && second.is_seen) {
      const double both = std::hypot(first.sigma, second.sigma);
      if (std::abs(after - before) > tolerance * both + slack) continue;
      const double a = 1 / (first.sigma * first.sigma), b = 1 / (second.sigma * second.sigma);
      seen[i] = {2, (a * before + b * after) / (a + b), 1 / std::sqrt(a + b)};
    } else if (first.is_seen) {
      seen[i] = {1, before, std::hypot(first.sigma, other)};
    } else if (second.is_seen) {
      seen[i] = {1, after, std::hypot(second.sigma, other)};
    }
  }
}

}  // namespace flexura
