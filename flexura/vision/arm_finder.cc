#include "flexura/vision/arm_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "flexura/base/table.h"
#include "flexura/vision/axis_curve.h"
#include "flexura/vision/border.h"
#include "flexura/vision/eight_bits.h"
#include "flexura/vision/picture_file.h"
#include "flexura/vision/runs.h"
#include "flexura/vision/tube_seeds.h"
#include "flexura/vision/tube_tracker.h"

namespace flexura {
namespace {

// Limits of the border model. Borders with more blur (px, or as a share of the arm's width) are not modelled.
// Arms of less contrast may be lost in noise.
constexpr double least_blurred = 2, blurred_share = 0.12, faint = 30;

// Number of pixels that suffice for the histogram. The borders are measured separately.
constexpr std::size_t histogram_samples = 12288;

// Smaller figures are ignored as dust.
constexpr std::int64_t least_area = 24;

// Smallest ratio of length to width of a tube.
constexpr double least_slenderness = 2.5;

// If an axis covers less than this fraction of its figure, it is an edge of the figure, not an arm.
constexpr double least_covered = 0.3;

constexpr std::size_t most_tries = 4, most_seeds = 4;

// If the axis covers more than this fraction, the rest is due to the ends and noise.
constexpr double all_but_ends = 0.95;

// Returns whether a point of the border belongs to the axis: its distance from the axis is half the width.
bool is_explained(const BorderPoint& point, const std::vector<AxisSample>& axis) {
  constexpr double close = 1.5;  // px, across and along the axis.
  return std::ranges::any_of(axis, [&](const AxisSample& sample) {
    const Eigen::Vector2d off = point.pixel - sample.pixel;
    const double across = std::abs(off.dot(sample.normal));
    return std::abs(across - 0.5 * sample.width) < close &&
           off.squaredNorm() < across * across + close * close;
  });
}

// Score of an axis: the covered share of the figure and the number of known ends.
double merit(const ArmObservation& seen) {
  const auto is_known = [](const AxisEnd& end) { return end.kind != AxisEndKind::lost; };
  return std::min(seen.covered, 1.0) + 0.2 * static_cast<double>(std::ranges::count_if(seen.ends, is_known));
}

// Returns whether no other seed can give a better result.
bool shows_all(const ArmObservation& seen) {
  constexpr double whole = 0.85;
  const auto is_lost = [](const AxisEnd& end) { return end.kind == AxisEndKind::lost; };
  return seen.covered > whole && (seen.is_closed || std::ranges::none_of(seen.ends, is_lost));
}

double scale_of(const Image<std::uint8_t>&, int) { return 1; }
double scale_of(const Image<std::uint16_t>&, int white) { return white / 255.0; }

}  // namespace

const std::vector<std::string>& names_of(const AxisEndKind*) {
  static const std::vector<std::string> names = {"free", "border", "lost"};
  return names;
}

struct ArmFinder::Work {
  ArmFinderConfig config;
  ArmObservation seen, best;
  Components components;
  BlockThresholds blocks;
  Image<std::uint8_t> bytes;  // Of a picture with more bits.
  std::vector<std::uint32_t> order;
  std::uint32_t followed = 0;  // The component that is the arm.
  std::vector<TubeSeed> seeds;
  std::vector<CrossSection> ahead, sections;
  BlurredSteps steps;
  AxisCurve curve;
  double least_blur = 0;  // Of the places from which a component was followed, px.

  [[nodiscard]] std::string reason_against_following(double width) const;
  void segment(const Image<std::uint8_t>& gray);
  template <typename Value>
  void find_axis(const Image<Value>& picture, double scale);
  template <typename Value>
  bool follow(const Image<Value>& picture, double scale, const Component& component);
  template <typename Value>
  void try_seeds(const Image<Value>& picture, double scale, const Component& component);
  template <typename Value>
  bool follow_from(const Image<Value>& picture, double scale, const Component& component,
                   const TubeSeed& rough);
  void order_ends();
  void note_others();
  void add_unexplained(const Image<std::uint8_t>& gray);
  void add_places();
};

ArmFinder::ArmFinder(ArmFinderConfig config) : work_(std::make_unique<Work>()) {
  work_->config = std::move(config);
}
ArmFinder::~ArmFinder() = default;
ArmFinder::ArmFinder(ArmFinder&&) noexcept = default;
ArmFinder& ArmFinder::operator=(ArmFinder&&) noexcept = default;

void ArmFinder::Work::segment(const Image<std::uint8_t>& gray) {
  if (gray.channels() != 1)
    throw std::invalid_argument(
        fmt::format("a picture with {} channels: expected a gray picture", gray.channels()));
  order.clear();
  seen.axis.clear();
  seen.notes.clear();
  seen.unexplained.clear();
  seen.places.clear();
  seen.ends = {};
  seen.blur = seen.noise = seen.contrast = seen.covered = 0;
  seen.is_closed = false;
  seen.threshold = flexura::segment(gray, config.threshold, components, blocks, histogram_samples);
  seen.reason = seen.threshold.reason;
  if (!seen.reason.empty()) return;
  seen.contrast = seen.threshold.bright - seen.threshold.dark;
}

template <typename Value>
void ArmFinder::Work::find_axis(const Image<Value>& picture, double scale) {
  order.clear();
  for (std::uint32_t i = 0; i < components.list.size(); ++i)
    if (components.list[i].area >= least_area) order.push_back(i);
  std::ranges::stable_sort(order, std::ranges::greater{},
                           [&](std::uint32_t i) { return components.list[i].area; });
  if (order.empty()) {
    seen.reason =
        fmt::format("no figure with at least {} px is {} enough", least_area, name_of(seen.threshold.figure));
    return;
  }
  std::string first_reason;
  for (std::size_t i = 0; i < std::min(order.size(), most_tries); ++i) {
    const Component& component = components.list[order[i]];
    seen.reason.clear();
    if (follow(picture, scale, component)) {
      followed = order[i];
      note_others();
      add_places();
      return;
    }
    if (i == 0) first_reason = seen.reason;
  }
  seen.reason = first_reason;
}

// Tracks the tube of a component from the first seed that leads to both ends; if there is none, from the seed
// that leads farthest.
template <typename Value>
bool ArmFinder::Work::follow(const Image<Value>& picture, double scale, const Component& component) {
  tube_seeds(components, component, seeds);
  if (seeds.empty()) {
    seen.reason = "the figure has no end within the picture";
    return false;
  }
  const double width = seeds.front().width;
  if (static_cast<double>(component.area) < least_slenderness * width * width ||
      component.on_border > 6 * width + 12) {
    seen.reason = fmt::format(
        "the largest figure is not a tube: it has {} px, a width of about {:.0f} px, and {} px on the "
        "picture's border",
        component.area, width, component.on_border);
    return false;
  }
  best.axis.clear();
  least_blur = std::numeric_limits<double>::infinity();
  try_seeds(picture, scale, component);
  if (best.axis.empty()) {
    // If hairs form a larger part of the figure than the arm, the arm is the thickest tube.
    std::ranges::stable_sort(seeds, std::ranges::greater{}, &TubeSeed::width);
    try_seeds(picture, scale, component);
  }
  if (best.axis.empty()) {
    seen.axis.clear();
    seen.reason =
        fmt::format("the borders of the figure ({} px, width about {:.0f} px) cannot be tracked: {}",
                    component.area, width, reason_against_following(width));
    return false;
  }
  seen = best;
  for (AxisSample& sample : seen.axis) sample.sigma = std::max(sample.sigma, config.least_sigma);
  order_ends();
  return true;
}

std::string ArmFinder::Work::reason_against_following(double width) const {
  if (std::isfinite(least_blur) && least_blur > std::max(least_blurred, blurred_share * width))
    return fmt::format("their blur is about {:.0f} px", least_blur);
  const double contrast = seen.threshold.bright - seen.threshold.dark;
  if (contrast < faint)
    return fmt::format("it is not a tube, points at the camera, or is too faint (contrast {:.0f} of 255)",
                       contrast);
  return "it is not a tube, or points at the camera";
}

// Tries the first few seeds. Stores the result of the best seed in `best`.
template <typename Value>
void ArmFinder::Work::try_seeds(const Image<Value>& picture, double scale, const Component& component) {
  for (std::size_t i = 0; i < std::min(seeds.size(), most_seeds); ++i) {
    if (!follow_from(picture, scale, component, seeds[i])) continue;
    if (best.axis.empty() || merit(seen) > merit(best)) best = seen;
    if (shows_all(seen)) break;
  }
}

// Tracks the tube from a seed in both directions.
template <typename Value>
bool ArmFinder::Work::follow_from(const Image<Value>& picture, double scale, const Component& component,
                                  const TubeSeed& rough) {
  const double contrast = (seen.threshold.bright - seen.threshold.dark) * scale;
  const TubeSeed place = shortest_chord(components, rough.center, 2 * rough.width + 4);
  TubeTracker<Value> tracker(picture, seen.threshold.figure, seen.threshold.level * scale, contrast, steps);
  const auto seed = tracker.seed(place.center, place.normal, 0.5 * place.width);
  least_blur = std::min(least_blur, tracker.blur());
  if (!seed) return false;
  ahead.clear(), sections.clear();
  const TrackEnd back = tracker.follow(*seed, -1, ahead);
  sections.assign(ahead.rbegin(), ahead.rend());
  sections.push_back(*seed);
  TrackEnd front = TrackEnd::closed;
  if (back != TrackEnd::closed) front = tracker.follow(*seed, 1, sections);
  if (static_cast<double>(sections.size()) * tracker.step() < least_slenderness * 2 * seed->half_width)
    return false;
  seen.is_closed = front == TrackEnd::closed;
  const TrackEnd behind = seen.is_closed ? TrackEnd::closed : back;
  if (!curve.fit(tracker, {behind, front}, sections, seen)) return false;
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

void ArmFinder::Work::order_ends() {
  auto& [base, tip] = seen.ends;
  bool is_reversed = false;
  if (config.base) {
    is_reversed = (tip.pixel - *config.base).norm() < (base.pixel - *config.base).norm();
  } else if ((base.kind == AxisEndKind::border) != (tip.kind == AxisEndKind::border)) {
    is_reversed = tip.kind == AxisEndKind::border;
  } else {
    is_reversed = tip.pixel.y() > base.pixel.y();
  }
  if (is_reversed) {
    std::swap(base, tip);
    std::ranges::reverse(seen.axis);
    for (AxisSample& sample : seen.axis) sample.normal = -sample.normal;
  }
  if (seen.is_closed) {
    seen.notes.emplace_back("the tube is closed and has no ends");
    return;
  }
  for (const AxisEnd& end : seen.ends) {
    const char* name = &end == &base ? "base" : "tip";
    if (end.kind == AxisEndKind::border)
      seen.notes.push_back(fmt::format("the picture's border cuts the arm at its {}", name));
    if (end.kind == AxisEndKind::lost)
      seen.notes.push_back(
          fmt::format("at ({:.1f}, {:.1f}) the arm's borders are no longer visible: the arm is beside "
                      "another figure, or points at the camera",
                      end.pixel.x(), end.pixel.y()));
  }
}

void ArmFinder::Work::note_others() {
  const auto measured = std::ranges::find_if(order, [&](std::uint32_t i) {
    const Eigen::Vector2d middle = seen.axis[seen.axis.size() / 2].pixel;
    const Run* run = components.run_at(static_cast<int>(std::lround(middle.x())),
                                       static_cast<int>(std::lround(middle.y())));
    return run != nullptr && run->component == i;
  });
  const double area = measured == order.end() ? 0 : static_cast<double>(components.list[*measured].area);
  std::size_t others = 0;
  for (const std::uint32_t i : order)
    if ((measured == order.end() || i != *measured) &&
        static_cast<double>(components.list[i].area) > 0.2 * area)
      ++others;
  if (others > 0)
    seen.notes.push_back(fmt::format("{} other figure{} of similar size: the largest tube was measured",
                                     others, others > 1 ? "s" : ""));
  if (seen.covered < 0.8)
    seen.notes.push_back(fmt::format(
        "the tube covers {:.0f} % of the silhouette: something touches the tube, or the tube crosses itself",
        100 * seen.covered));
}

// Adds enough places to test whether a shape covers the figure. Parts thinner than a third of the arm may
// have none.
void ArmFinder::Work::add_places() {
  constexpr double about = 120;
  double width = 0;
  for (const AxisSample& sample : seen.axis) width += sample.width / static_cast<double>(seen.axis.size());
  const auto area = static_cast<double>(components.list[followed].area);
  const auto spacing = static_cast<int>(std::clamp(std::sqrt(area / about), 1.0, std::max(1.0, width / 3)));
  strew(components, followed, spacing, seen.places);
}

// Uses the figure that was tracked, or the largest figure.
void ArmFinder::Work::add_unexplained(const Image<std::uint8_t>& gray) {
  if (order.empty() || (seen.is_found() && seen.covered >= all_but_ends)) return;
  const std::uint32_t component = seen.is_found() ? followed : order.front();
  constexpr double usual_blur = 0.8;  // px
  find_border(gray, seen.threshold, components, component, seen.blur > 0 ? seen.blur : usual_blur,
              seen.unexplained);
  std::erase_if(seen.unexplained, [&](const BorderPoint& point) { return is_explained(point, seen.axis); });
}

const ArmObservation& ArmFinder::find(const Image<std::uint8_t>& gray) {
  work_->segment(gray);
  if (work_->seen.reason.empty()) work_->find_axis(gray, scale_of(gray, 255));
  work_->add_unexplained(gray);
  return work_->seen;
}

const ArmObservation& ArmFinder::find(const Image<std::uint16_t>& gray, int white) {
  Work& work = *work_;
  work.bytes = eight_bits(gray, white);
  work.segment(work.bytes);
  if (work.seen.reason.empty()) work.find_axis(gray, scale_of(gray, white));
  work.add_unexplained(work.bytes);
  return work.seen;
}

const ArmObservation& ArmFinder::find(const Picture& picture, int white) {
  const auto* words = std::get_if<Image<std::uint16_t>>(&picture);
  if (words != nullptr)
    return words->channels() == 1 ? find(*words, white) : find(gray_picture(*words), white);
  const auto& bytes = std::get<Image<std::uint8_t>>(picture);
  if (white != 255) return find(eight_bits(picture, white), 255);
  return bytes.channels() == 1 ? find(bytes) : find(gray_picture(bytes));
}

const ArmObservation& ArmFinder::find(const Photograph& photograph) {
  const ArmFinderConfig asked = work_->config;
  if (photograph.is_mask) work_->config.least_sigma = std::max(asked.least_sigma, mask_sigma);
  const bool has_words = !photograph.words.values().empty();
  const ArmObservation& seen = has_words ? find(gray_picture(photograph.words), photograph.white)
                                         : find(gray_picture(photograph.bytes));
  work_->config = asked;
  return seen;
}

}  // namespace flexura
