#include "flexura/vision/arm_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/base/table.h"
#include "flexura/vision/axis_lengths.h"
#include "flexura/vision/border.h"

namespace flexura {
namespace {

// Limits of the border model. Borders with more blur (px, or as a share of the arm's width) are not modelled.
// Arms of less contrast may be lost in noise.
constexpr double least_blurred = 2, blurred_share = 0.12, faint = 30;

// Number of pixels that suffice for the histogram. The borders are measured separately.
constexpr std::size_t histogram_samples = 12288;

// Smallest ratio of length to width of a tube.
constexpr double least_slenderness = 2.5;

// If an axis covers less than this fraction of its figure, it is an edge of the figure, not an arm.
constexpr double least_covered = 0.3;

// Smallest ratio of length to width of a tube that is only a part of a figure.
constexpr double long_for_width = 6;

constexpr std::size_t most_seeds = 4;

// If the axis covers more than this fraction, the rest is due to the ends and noise.
constexpr double all_but_ends = 0.95;

// Score of an axis: the covered share of the figure and the number of known ends.
double merit(const ArmObservation& seen) {
  const auto is_known = [](const AxisEnd& end) { return end.kind != AxisEndKind::lost; };
  return std::min(seen.covered, 1.0) + 0.2 * static_cast<double>(std::ranges::count_if(seen.ends, is_known));
}

bool has_both_ends(const ArmObservation& seen) {
  const auto is_lost = [](const AxisEnd& end) { return end.kind == AxisEndKind::lost; };
  return seen.is_found() && (seen.is_closed || std::ranges::none_of(seen.ends, is_lost));
}

// Returns whether no other seed can give a better result.
bool shows_all(const ArmObservation& seen) {
  constexpr double whole = 0.85;
  return seen.covered > whole && has_both_ends(seen);
}

}  // namespace

template <typename Value>
bool ArmSearch::run(const Image<Value>& picture, const Image<std::uint8_t>& gray, double scale,
                    const ThresholdConfig& threshold) {
  segment(gray, threshold);
  if (stops_at_frame && seen.reason.empty()) {
    part = inside_frame(gray, seen.threshold.level);
    if (part.width() < gray.width() || part.height() < gray.height()) return false;
  }
  if (seen.reason.empty()) find_axis(picture, scale);
  add_unexplained(gray);
  // An arm and its mount are one figure if both are equally dark.
  if (order_.empty() || is_expected_ || (seen.is_found() && ends_at_base())) return true;
  first_ = seen;
  if (keep_thin_parts(gray)) {
    find_axis(picture, scale);
    const bool is_better = is_clear() && ends_at_base() &&
                           length_of(seen.axis) > long_for_width * median_width(seen.axis, widths_);
    if (is_better) return true;
  }
  seen = first_;
  return true;
}

bool ArmSearch::is_clear() {
  constexpr double enough = 0.8, too_much = 3, slender = 20;
  if (!seen.is_found() || seen.contradicts || seen.covered <= enough || seen.covered > too_much) return false;
  const double width = median_width(seen.axis, widths_);
  if (seen.blur > std::max(least_blurred, blurred_share * width)) return false;
  const auto is_lost = [](const AxisEnd& end) { return end.kind == AxisEndKind::lost; };
  return seen.is_closed || !std::ranges::all_of(seen.ends, is_lost) ||
         (order_.size() == 1 && length_of(seen.axis) > slender * width);
}

void ArmSearch::segment(const Image<std::uint8_t>& gray, const ThresholdConfig& threshold) {
  if (gray.channels() != 1)
    throw std::invalid_argument(
        fmt::format("a picture with {} channels: expected a gray picture", gray.channels()));
  width_ = gray.width(), height_ = gray.height();
  order_.clear();
  seen.axis.clear();
  seen.notes.clear();
  seen.unexplained.clear();
  seen.places.clear();
  seen.ends = {};
  seen.blur = seen.noise = seen.contrast = seen.covered = 0;
  seen.is_closed = seen.contradicts = is_part_ = is_expected_ = false;
  thinnest_ = std::numeric_limits<double>::infinity();
  seen.threshold = flexura::segment(gray, threshold, components_, blocks_, histogram_samples, inside);
  seen.reason = seen.threshold.reason;
  if (!seen.reason.empty()) return;
  seen.contrast = seen.threshold.bright - seen.threshold.dark;
}

template <typename Value>
void ArmSearch::find_axis(const Image<Value>& picture, double scale) {
  order_figures();
  if (order_.empty()) {
    seen.reason =
        fmt::format("no figure with at least {} px is {} enough", least_area, name_of(seen.threshold.figure));
    return;
  }
  is_expected_ = follow_expected(picture, scale);
  if (!is_expected_ && !follow_one_of_all(picture, scale)) return;
  order_ends();
  begin_at_base();
  note_ends();
  note_others();
  add_places();
}

// Tracks the tube from the predicted centerline. Returns false if the result does not agree with it.
template <typename Value>
bool ArmSearch::follow_expected(const Image<Value>& picture, double scale) {
  if (expected.is_empty() || is_part_) return false;
  expected.seeds(components_, width_, height_, seeds_);
  for (const TubeSeed& seed : seeds_) {
    const Run* run = components_.run_at(static_cast<int>(std::lround(seed.center.x())),
                                        static_cast<int>(std::lround(seed.center.y())));
    if (run == nullptr || components_.list[run->component].area < least_area) continue;
    followed_ = run->component;
    if (follow_from(picture, scale, components_.list[followed_], seed) && expected.agrees(seen.axis) &&
        has_expected_ends() && has_width()) {
      for (AxisSample& sample : seen.axis) sample.sigma = std::max(sample.sigma, config.least_sigma);
      return true;
    }
  }
  seen.axis.clear();
  return false;
}

// Returns whether the ends of the arm that should be visible were found.
bool ArmSearch::has_expected_ends() const {
  const std::size_t base = expected.is_reversed(seen.axis) ? 1 : 0;
  const auto is_as_expected = [&](std::size_t end) {
    return !expected.shows_end(end) || seen.ends[end == 0 ? base : 1 - base].kind != AxisEndKind::lost;
  };
  return is_as_expected(0) && is_as_expected(1);
}

// Follows the figures in their order until one agrees with the settings; if none does, uses the first tube.
template <typename Value>
bool ArmSearch::follow_one_of_all(const Image<Value>& picture, double scale) {
  constexpr std::size_t most_tries = 4;
  // The figures near the base come first, and then the largest, if they differ.
  const std::size_t tries =
      std::min(order_.size(), config.base || config.width ? 2 * most_tries : most_tries);
  std::string first_reason, contradicted;
  spare_.axis.clear();
  std::uint32_t spare = 0;
  for (std::size_t i = 0; i < tries; ++i) {
    const Component& component = components_.list[order_[i]];
    seen.reason.clear();
    if (follow(picture, scale, component)) {
      followed_ = order_[i];
      const std::string reason = contradiction();
      if (reason.empty()) return true;
      if (spare_.axis.empty()) spare_ = seen, spare = followed_, contradicted = reason;
    }
    if (i == 0) first_reason = seen.reason;
  }
  seen.reason = first_reason;
  if (spare_.axis.empty()) {
    seen.axis.clear();
    return false;
  }
  seen = spare_, followed_ = spare;
  seen.reason.clear();
  seen.contradicts = true;
  seen.notes.push_back(contradicted);
  return true;
}

// Tracks the tube of a component from the first seed that leads to both ends; if there is none, from the seed
// that leads farthest.
template <typename Value>
bool ArmSearch::follow(const Image<Value>& picture, double scale, const Component& component) {
  tube_seeds(components_, component, seeds_);
  if (seeds_.empty()) {
    seen.reason = "the figure has no end within the picture";
    return false;
  }
  const double width = seeds_.front().width;
  thinnest_ = std::min(thinnest_, std::ranges::min(seeds_, {}, &TubeSeed::width).width);
  if (static_cast<double>(component.area) < least_slenderness * width * width ||
      component.on_border > 6 * width + 12) {
    seen.reason = fmt::format(
        "the largest figure is not a tube: it has {} px, a width of about {:.0f} px, and {} px on the "
        "picture's border",
        component.area, width, component.on_border);
    return false;
  }
  best_.axis.clear();
  least_blur_ = std::numeric_limits<double>::infinity();
  try_seeds(picture, scale, component);
  if (best_.axis.empty()) {
    // If hairs form a larger part of the figure than the arm, the arm is the thickest tube.
    std::ranges::stable_sort(seeds_, std::ranges::greater{}, &TubeSeed::width);
    try_seeds(picture, scale, component);
  }
  if (best_.axis.empty()) {
    seen.axis.clear();
    seen.reason =
        fmt::format("the borders of the figure ({} px, width about {:.0f} px) cannot be tracked: {}",
                    component.area, width, reason_against_following(width));
    return false;
  }
  seen = best_;
  for (AxisSample& sample : seen.axis) sample.sigma = std::max(sample.sigma, config.least_sigma);
  return true;
}

std::string ArmSearch::reason_against_following(double width) const {
  if (std::isfinite(least_blur_) && least_blur_ > std::max(least_blurred, blurred_share * width))
    return fmt::format("their blur is about {:.0f} px", least_blur_);
  const double contrast = seen.threshold.bright - seen.threshold.dark;
  if (contrast < faint)
    return fmt::format("it is not a tube, points at the camera, or is too faint (contrast {:.0f} of 255)",
                       contrast);
  return "it is not a tube, or points at the camera";
}

// Tries the first few seeds. Stores the result of the best seed in `best_`. If two seeds agree on a tube and
// its ends, other seeds on this tube are omitted.
template <typename Value>
void ArmSearch::try_seeds(const Image<Value>& picture, double scale, const Component& component) {
  constexpr double equal = 0.02;
  bool is_confirmed = false;
  for (std::size_t i = 0; i < std::min(seeds_.size(), most_seeds); ++i) {
    if (is_confirmed && cover_.has_chord(seeds_[i].center, seeds_[i].normal)) continue;
    if (!follow_from(picture, scale, component, seeds_[i])) continue;
    const double gain = merit(seen) - (best_.is_found() ? merit(best_) : 0);
    is_confirmed = best_.is_found() && has_both_ends(seen) && std::abs(gain) < equal;
    if (!best_.is_found() || gain > 0) best_ = seen;
    if (shows_all(best_)) break;
    if (is_confirmed) cover_.set(best_.axis);
  }
}

// Tracks the tube from a seed in both directions.
template <typename Value>
bool ArmSearch::follow_from(const Image<Value>& picture, double scale, const Component& component,
                            const TubeSeed& rough) {
  const double contrast = (seen.threshold.bright - seen.threshold.dark) * scale;
  const TubeSeed place = shortest_chord(components_, rough.center, 2 * rough.width + 4);
  TubeTracker<Value> tracker(picture, seen.threshold.figure, seen.threshold.level * scale, contrast, steps_);
  tracker.stay_inside(inside);
  const auto seed = tracker.seed(place.center, place.normal, 0.5 * place.width);
  least_blur_ = std::min(least_blur_, tracker.blur());
  if (!seed) return false;
  ahead_.clear(), sections_.clear();
  const TrackEnd back = tracker.follow(*seed, -1, ahead_);
  sections_.assign(ahead_.rbegin(), ahead_.rend());
  sections_.push_back(*seed);
  TrackEnd front = TrackEnd::closed;
  if (back != TrackEnd::closed) front = tracker.follow(*seed, 1, sections_);
  if (static_cast<double>(sections_.size()) * tracker.step() < least_slenderness * 2 * seed->half_width)
    return false;
  seen.is_closed = front == TrackEnd::closed;
  const TrackEnd behind = seen.is_closed ? TrackEnd::closed : back;
  if (!curve_.fit(tracker, {behind, front}, sections_, seen)) return false;
  if (2 * std::ranges::count_if(seen.axis, &AxisSample::is_seen) < std::ssize(seen.axis)) return false;
  seen.blur = tracker.blur();
  seen.noise = tracker.noise() / scale;
  seen.contrast = tracker.contrast() / scale;
  double explained = 0;
  for (std::size_t i = 1; i < seen.axis.size(); ++i)
    explained += seen.axis[i].width * (seen.axis[i].pixel - seen.axis[i - 1].pixel).norm();
  for (const AxisEnd& end : seen.ends)
    explained += 0.25 * std::numbers::pi * end.bulge * seen.axis.back().width;
  seen.covered = explained / static_cast<double>(component.area);
  return seen.covered >= least_covered;
}

// Uses the figure that was tracked, or the largest figure.
void ArmSearch::add_unexplained(const Image<std::uint8_t>& gray) {
  if (order_.empty() || (seen.is_found() && seen.covered >= all_but_ends)) return;
  const std::uint32_t component = seen.is_found() ? followed_ : order_.front();
  const auto is_outside = [&](const BorderPoint& point) {
    const auto u = static_cast<int>(std::lround(point.pixel.x())),
               v = static_cast<int>(std::lround(point.pixel.y()));
    return inside != nullptr &&
           (u < 0 || v < 0 || u >= inside->width() || v >= inside->height() || inside->at(u, v) == 0);
  };
  constexpr double usual_blur = 0.8;  // px
  cover_.set(seen.axis);
  // The border of the figure is measured only where its pixels are not on the borders of the tube.
  constexpr double on_border = 1, close = AxisCover::along;  // px
  find_border(gray, seen.threshold, components_, component, seen.blur > 0 ? seen.blur : usual_blur,
              seen.unexplained,
              [&](const Eigen::Vector2d& pixel) { return cover_.is_border(pixel, on_border); });
  std::erase_if(seen.unexplained, [&](const BorderPoint& point) {
    return is_outside(point) || cover_.is_border(point.pixel, close);
  });
}

template bool ArmSearch::run(const Image<std::uint8_t>&, const Image<std::uint8_t>&, double,
                             const ThresholdConfig&);
template bool ArmSearch::run(const Image<std::uint16_t>&, const Image<std::uint8_t>&, double,
                             const ThresholdConfig&);

}  // namespace flexura
