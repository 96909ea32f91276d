// Which figure is the arm, which end is its base, and what the user must know about both.
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "flexura/vision/arm_search.h"
#include "flexura/vision/axis_lengths.h"

namespace flexura {
namespace {

using Eigen::Vector2d;

// A tube that covers more than this fraction of its figure has no other tube beside it.
constexpr double all_but_little = 0.9;

// A base this near to a figure is on it, px.
constexpr double on_figure = 3;

double diagonal(const Component& component) {
  return std::hypot(component.right - component.left + 1, component.bottom - component.top + 1);
}

double distance_to(const Run& run, const Vector2d& pixel) {
  const double u = std::clamp(pixel.x(), static_cast<double>(run.first), static_cast<double>(run.last - 1));
  return std::hypot(u - pixel.x(), run.v - pixel.y());
}

std::size_t nearest_sample(const std::vector<AxisSample>& axis, const Vector2d& pixel) {
  const auto nearest = std::ranges::min_element(
      axis, {}, [&](const AxisSample& sample) { return (sample.pixel - pixel).squaredNorm(); });
  return static_cast<std::size_t>(nearest - axis.begin());
}

}  // namespace

// Sorts the figures by area or, with a known base, by their distance from it. Dust near the base comes last.
void ArmSearch::order_figures() {
  order_.clear();
  for (std::uint32_t i = 0; i < components_.list.size(); ++i)
    if (components_.list[i].area >= least_area) order_.push_back(i);
  std::ranges::stable_sort(order_, std::ranges::greater{},
                           [&](std::uint32_t i) { return components_.list[i].area; });
  if (!config.base || order_.size() < 2) return;
  std::vector<double>& distances = distances_;
  distances.assign(components_.list.size(), std::numeric_limits<double>::infinity());
  for (const Run& run : components_.runs)
    distances[run.component] = std::min(distances[run.component], distance_to(run, *config.base));
  double longest = 0;
  for (const std::uint32_t i : order_) longest = std::max(longest, diagonal(components_.list[i]));
  constexpr double dust = 0.1;
  constexpr std::ptrdiff_t first_tries = 4;
  by_area_ = order_;
  std::ranges::stable_sort(order_, {}, [&](std::uint32_t i) {
    const bool is_dust = diagonal(components_.list[i]) < dust * longest;
    return std::pair(is_dust, std::max(0.0, distances[i] - on_figure));
  });
  // The largest figures follow the four nearest.
  const auto next = order_.begin() + std::min(first_tries, std::ssize(order_));
  std::erase_if(by_area_, [&](std::uint32_t i) { return std::find(order_.begin(), next, i) != next; });
  std::ranges::copy(by_area_, next);
}

// Returns whether the measured tube begins near the base, if that is given and in the picture.
bool ArmSearch::ends_at_base() {
  if (!config.base || seen.is_closed || !is_base_visible()) return true;
  if (seen.contradicts) return false;
  // A tube from the base to the picture's border may be a post under the arm.
  if (config.cuts_at_base && cut_.empty() && seen.ends[1].kind == AxisEndKind::border &&
      seen.covered < all_but_little)
    return false;
  const double grace = std::max(20.0, median_width(seen.axis, widths_));
  return !cut_.empty() || (seen.ends[0].pixel - *config.base).norm() <= grace ||
         seen.covered >= all_but_little;
}

bool ArmSearch::is_base_visible() const {
  return config.base->x() >= 0 && config.base->y() >= 0 && config.base->x() < width_ &&
         config.base->y() < height_;
}

// Returns whether the tracked tube has the width of the settings, if they have one.
bool ArmSearch::has_width() {
  const double width = median_width(seen.axis, widths_);
  return !config.width || (width >= (*config.width)[0] && width <= (*config.width)[1]);
}

// Returns how the tracked tube differs from what the settings say about the arm; "" if it does not. A base
// outside the picture says nothing about the visible part.
std::string ArmSearch::contradiction() {
  if (!config.base && !config.width) return "";
  const double width = median_width(seen.axis, widths_);
  if (!has_width())
    return fmt::format(
        "the tube is {:.0f} px wide, but the arm should be {:.0f} to {:.0f} px wide: it may be another "
        "object",
        width, (*config.width)[0], (*config.width)[1]);
  if (!config.base) return "";
  const Vector2d nearest = seen.axis[nearest_sample(seen.axis, *config.base)].pixel;
  const double distance = (nearest - *config.base).norm();
  const double grace = std::max({20.0, 2 * width, 0.15 * length_of(seen.axis)});
  const bool is_cut =
      std::ranges::any_of(seen.ends, [](const AxisEnd& end) { return end.kind == AxisEndKind::border; });
  if (distance <= grace || (is_cut && !is_base_visible())) return "";
  const Vector2d base = *config.base + origin;
  return fmt::format(
      "the base is given at ({:.0f}, {:.0f}), {:.0f} px from the measured tube: the base is wrong or hidden, "
      "or "
      "the tube is another object",
      base.x(), base.y(), distance);
}

void ArmSearch::order_ends() {
  auto& [base, tip] = seen.ends;
  bool is_reversed = false;
  if (is_expected_) {
    is_reversed = expected.is_reversed(seen.axis);
  } else if (config.base) {
    is_reversed = (tip.pixel - *config.base).norm() < (base.pixel - *config.base).norm();
  } else if ((base.kind == AxisEndKind::border) != (tip.kind == AxisEndKind::border)) {
    is_reversed = tip.kind == AxisEndKind::border;
  } else {
    is_reversed = tip.pixel.y() > base.pixel.y();
  }
  if (is_reversed) reverse();
}

void ArmSearch::reverse() {
  std::swap(seen.ends[0], seen.ends[1]);
  std::ranges::reverse(seen.axis);
  for (AxisSample& sample : seen.axis) sample.normal = -sample.normal;
}

// A post under the arm of the same brightness and width continues the tube beyond the base. The arm is the
// part with a free end or, if both parts or none have one, the longer part.
void ArmSearch::begin_at_base() {
  cut_.clear();
  if (!config.base || !config.cuts_at_base || seen.is_closed || seen.contradicts) return;
  const double width = median_width(seen.axis, widths_);
  std::size_t at = nearest_sample(seen.axis, *config.base);
  const double aside = (seen.axis[at].pixel - *config.base).norm();
  const std::span<const AxisSample> axis = seen.axis;
  const double before = length_of(axis.first(at + 1)), after = length_of(axis.subspan(at));
  const double grace = std::max(20.0, 2.5 * width);
  if (aside > std::max(width, 6.0) || std::min(before, after) < grace) return;
  const auto is_free = [&](std::size_t end) { return seen.ends[end].kind == AxisEndKind::free; };
  if (is_free(0) == is_free(1) ? before > after : is_free(0)) {
    reverse();
    at = seen.axis.size() - 1 - at;
  }
  const auto first = seen.axis.begin() + static_cast<std::ptrdiff_t>(at);
  for (auto sample = seen.axis.begin(); sample != first; ++sample) cut_.push_back(sample->pixel);
  seen.notes.push_back(
      fmt::format("the tube continues {:.0f} px beyond the given base: this part is not measured",
                  length_of(std::span(seen.axis).first(at + 1))));
  seen.axis.erase(seen.axis.begin(), first);
  seen.ends[0] = {};
  seen.ends[0].pixel = seen.axis.front().pixel;
}

void ArmSearch::note_ends() {
  if (seen.is_closed) {
    seen.notes.emplace_back("the tube is closed and has no ends");
    return;
  }
  if (is_part_)
    seen.notes.emplace_back(
        "the arm touches a wider figure of the same brightness: only the thin part was measured");
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    const AxisEnd& end = seen.ends[i];
    if (end.kind == AxisEndKind::border)
      seen.notes.push_back(
          fmt::format("the picture's border cuts the arm at its {}", i == 0 ? "base" : "tip"));
    const Vector2d pixel = end.pixel + origin;
    const bool is_cut = i == 0 && !cut_.empty();
    if (end.kind == AxisEndKind::lost && !is_cut)
      seen.notes.push_back(
          fmt::format("at ({:.1f}, {:.1f}) the arm's borders are no longer visible: the arm is beside "
                      "another figure, or points at the camera",
                      pixel.x(), pixel.y()));
  }
}

void ArmSearch::note_others() {
  const Component& own = components_.list[followed_];
  std::size_t others = 0;
  for (const std::uint32_t i : order_) {
    const Component& other = components_.list[i];
    constexpr double similar_area = 0.2, similar_length = 0.5;
    if (i != followed_ && (static_cast<double>(other.area) > similar_area * static_cast<double>(own.area) ||
                           diagonal(other) > similar_length * diagonal(own)))
      ++others;
  }
  if (others > 0)
    seen.notes.push_back(
        fmt::format("{} other figure{} of similar size: {}", others, others > 1 ? "s" : "",
                    config.base ? "the tube at the base was measured" : "the largest tube was measured"));
  constexpr double percent = 100, enough = 0.85;
  if (seen.covered < enough)
    seen.notes.push_back(fmt::format(
        "the tube covers {:.0f} % of the silhouette: something touches the tube, or the tube crosses itself",
        percent * seen.covered));
}

// Adds enough places to test whether a shape covers the figure. Parts thinner than a third of the arm may
// have none.
void ArmSearch::add_places() {
  constexpr double about = 120;
  double width = 0;
  for (const AxisSample& sample : seen.axis) width += sample.width / static_cast<double>(seen.axis.size());
  const auto area = static_cast<double>(components_.list[followed_].area);
  const auto spacing = static_cast<int>(std::clamp(std::sqrt(area / about), 1.0, std::max(1.0, width / 3)));
  strew(components_, followed_, spacing, seen.places);
  if (cut_.empty()) return;
  // Whether the part beyond the base is nearer than the arm.
  std::erase_if(seen.places, [&](const Vector2d& place) {
    const auto distance = [&](const Vector2d& pixel) { return (pixel - place).squaredNorm(); };
    return distance(*std::ranges::min_element(cut_, {}, distance)) <
           distance(seen.axis[nearest_sample(seen.axis, place)].pixel);
  });
}

// Removes from all figures the parts that are wider than the thinnest chords: the discs of this diameter that
// fit into the figures. Returns false if there is nothing to remove.
bool ArmSearch::keep_thin_parts(const Image<std::uint8_t>& gray) {
  constexpr double wider = 1.6, beyond = 3, widest_share = 0.25;
  const double widest = std::round(wider * thinnest_ + beyond);
  if (!std::isfinite(thinnest_) || widest > widest_share * std::min(gray.width(), gray.height()))
    return false;
  Image<std::uint8_t> figures(gray.width(), gray.height());
  cv::Rect box;
  for (const Component& one : components_.list)
    box |= cv::Rect(one.left, one.top, one.right - one.left + 1, one.bottom - one.top + 1);
  for (const Run& run : components_.runs)
    std::ranges::fill(figures.row(run.v).subspan(static_cast<std::size_t>(run.first),
                                                 static_cast<std::size_t>(run.last - run.first)),
                      std::uint8_t{255});
  // Outside the picture is background.
  cv::Mat all(gray.height(), gray.width(), CV_8U, figures.values().data()), framed, depths, wide, distances;
  cv::copyMakeBorder(all(box), framed, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::distanceTransform(framed, depths, cv::DIST_L2, cv::DIST_MASK_5);
  const double radius = 0.5 * (widest - 1);  // Between centres of pixels.
  // The centres of the discs are dark, so that distances to them are known.
  wide = depths <= radius;
  if (cv::countNonZero(wide) == static_cast<int>(wide.total())) return false;
  cv::distanceTransform(wide, distances, cv::DIST_L2, cv::DIST_MASK_5);
  // The discs are enlarged by some pixels, so that no rim of the wide parts is left.
  constexpr double rim = 3;
  wide = distances(cv::Rect(1, 1, box.width, box.height)) <= radius + rim;
  all(box).setTo(0, wide);
  Threshold threshold;
  constexpr double middle = 127.5;
  threshold.level = middle, threshold.figure = Figure::bright;
  components_.find(figures, threshold);
  is_part_ = true;
  return true;
}

}  // namespace flexura
