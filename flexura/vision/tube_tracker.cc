#include "flexura/vision/tube_tracker.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

namespace flexura {
namespace {

using Eigen::Vector2d;

// Factor of the fading memory per pixel for position, direction and curvature.
constexpr double memory_of_pixel = 0.7;

// Edges with less than this fraction of the usual contrast, or with more than this multiple, do not belong to
// the tube.
constexpr double least_share = 0.55, most_share = 1.8;

// The shading of a round tube is nearly linear from the border to the middle.
constexpr double even_share = 1.0;

constexpr std::size_t most_sections = 200000;

Vector2d across(const Vector2d& tangent) { return {-tangent.y(), tangent.x()}; }
Vector2d along(const Vector2d& normal) { return {normal.y(), -normal.x()}; }

}  // namespace

template <typename Value>
struct TubeTracker<Value>::State {
  Vector2d position = {0, 0}, tangent = {1, 0};
  double curvature = 0;  // Curvature, positive if the tangent rotates from u towards v, 1/px.
  double half_width = 0, widening = 0;
  int blind = 0, in_ground = 0;  // Sections since a border was last visible; of these, in the background.
  int one_sided = 0;
  bool is_at_border = false;  // Whether samples of a border would be outside the picture.

  void advance(double step) {
    position += step * tangent + 0.5 * curvature * step * step * across(tangent);
    tangent = (tangent + curvature * step * across(tangent)).normalized();
    half_width += widening * step;
  }
  void correct(const Gains& gains, double sideways, double wider, bool is_whole) {
    const Vector2d normal = across(tangent);
    position += gains.position * sideways * normal;
    tangent = (tangent + gains.direction * sideways * normal).normalized();
    curvature = std::clamp(curvature + gains.curvature * sideways, -1 / half_width, 1 / half_width);
    if (!is_whole) return;
    half_width += gains.width * wider;
    widening = std::clamp(widening + gains.widening * wider, -0.1, 0.1);
  }
};

template <typename Value>
TubeTracker<Value>::Gains::Gains(double step) {
  // A fading memory of three states (N. Morrison, "Introduction to sequential smoothing and prediction",
  // 1969).
  const double memory = std::pow(memory_of_pixel, step), forgotten = 1 - memory;
  position = 1 - memory * memory * memory;
  direction = 1.5 * (1 - memory * memory) * forgotten / step;
  curvature = forgotten * forgotten * forgotten / (step * step);
  width = std::min(0.8, 0.4 * step), widening = 0.03;
}

template <typename Value>
TubeTracker<Value>::TubeTracker(const Image<Value>& picture, Figure figure, double level, double contrast,
                                BlurredSteps& steps)
    : edges_(picture, figure == Figure::dark ? 1 : -1, steps),
      level_(level),
      contrast_(contrast),
      noise_(0.02 * contrast) {}

template <typename Value>
bool TubeTracker<Value>::is_figure(const Vector2d& pixel) const {
  return edges_.holds(pixel) && edges_.sign() * (level_ - edges_.at(pixel)) > 0;
}

template <typename Value>
bool TubeTracker<Value>::is_in_view(const Vector2d& pixel) const {
  return edges_.holds(pixel) &&
         (inside_ == nullptr || inside_->at(static_cast<int>(std::lround(pixel.x())),
                                            static_cast<int>(std::lround(pixel.y()))) != 0);
}

// Finds the border near `from` along `outward`; `normal` is the border's normal. The search is repeated from
// the found position until it converges.
template <typename Value>
auto TubeTracker<Value>::look(const Vector2d& from, const Vector2d& outward, const Vector2d& normal,
                              double half_width, double capture) -> Look {
  double offset = 0;
  const double unit = std::max(1.0, blur_), room = even_share * half_width;
  for (int i = 0; i < 6; ++i) {
    const auto fit = edges_.look(from + offset * outward, normal, blur_, room);
    if (!fit) return {std::nullopt, true};
    if (fit->contrast < (i == 0 ? 0.2 : least_share) * contrast_) return {};
    offset += std::clamp(fit->offset, -1.1 * unit, 1.1 * unit) / outward.dot(normal);
    if (std::abs(offset) > capture) return {};
    if (std::abs(fit->offset) > 0.25 * unit) continue;
    if (fit->contrast < least_share * contrast_ || fit->contrast > most_share * contrast_) return {};
    if (fit->residual > 0.06 * fit->contrast + 3 * noise_) return {};
    contrast_ += 0.02 * (fit->contrast - contrast_);
    noise_ += 0.02 * (fit->residual - noise_);
    sigma_ += 0.02 * (fit->sigma - sigma_);
    return {offset, false};
  }
  return {};
}

template <typename Value>
void TubeTracker<Value>::guess_blur(const CrossSection& section) {
  // The steepest slope of a blurred step is contrast / (sqrt(2 pi) blur).
  double sum = 0;
  int count = 0;
  for (const double side : {1.0, -1.0}) {
    const Vector2d outward = side * section.normal, edge = section.center + section.half_width * outward;
    const double reach = std::min(12.0, 1.5 * section.half_width);
    double steepest = 0;
    for (double x = -reach; x < reach; x += 0.5) {
      const Vector2d here = edge + x * outward, next = here + 0.5 * outward;
      if (!edges_.holds(here) || !edges_.holds(next)) continue;
      steepest = std::max(steepest, edges_.sign() * 2 * (edges_.at(next) - edges_.at(here)));
    }
    if (steepest > 0) sum += contrast_ / (std::sqrt(2 * std::numbers::pi) * steepest), ++count;
  }
  if (count > 0) blur_ = std::clamp(sum / count, 0.5, 0.6 * section.half_width + 0.4);
}

template <typename Value>
void TubeTracker<Value>::measure_blur(std::span<const CrossSection> sections) {
  constexpr std::size_t desired = 10;
  constexpr std::size_t count = 5;
  const BlurSeries series{blur_ / (1.25 * 1.25), 1.25};
  // Residuals of the model by blur, around the known value.
  std::array<double, count> left{};
  for (std::size_t i = 0; i < sections.size(); i += std::max<std::size_t>(1, sections.size() / desired)) {
    const CrossSection& section = sections[i];
    if (!section.is_whole()) continue;
    for (const double side : {1.0, -1.0}) {
      const Vector2d outward = side * section.normal, from = section.center + section.half_width * outward;
      for (std::size_t j = 0; j < count; ++j) {
        const auto fit = edges_.look(from, outward, series.at(j), even_share * section.half_width);
        if (fit) left[j] += std::min(fit->residual * fit->residual, noise_ * noise_ * 9);
      }
    }
  }
  if (std::ranges::min(left) > 0) blur_ = series.least(left);
}

template <typename Value>
std::optional<CrossSection> TubeTracker<Value>::seed(const Vector2d& center, const Vector2d& normal,
                                                     double half_width) {
  CrossSection section{center, normal.normalized(), half_width, {false, false}};
  guess_blur(section);
  const double capture = std::max(2.5, 2 * blur_);
  std::array<double, 2> offsets{};
  for (std::size_t i = 0; i < 2; ++i) {
    const Vector2d outward = (i == 0 ? 1 : -1) * section.normal;
    const Look found = look(center + half_width * outward, outward, outward, half_width, capture);
    if (!found.offset) return std::nullopt;
    offsets[i] = *found.offset;
  }
  section.center += 0.5 * (offsets[0] - offsets[1]) * section.normal;
  section.half_width += 0.5 * (offsets[0] + offsets[1]);
  section.is_seen = {true, true};
  step_ = std::clamp(0.25 * section.half_width, 1.0, 2.0);
  return section.half_width > 0.5 ? std::optional(section) : std::nullopt;
}

// Measures the tube at its predicted position and corrects the state.
template <typename Value>
CrossSection TubeTracker<Value>::meet(State& state, const Gains& gains, int way) {
  const Vector2d normal = across(state.tangent);
  const double blind_reach = state.blind > 2 ? 1.0 + 0.05 * step_ * state.blind : 0.0;
  const double unit = std::max(1.0, blur_), capture = (1.5 + blind_reach) * unit;
  std::array<Look, 2> found;
  for (std::size_t i = 0; i < 2; ++i) {
    const Vector2d outward = (i == 0 ? 1 : -1) * normal;
    found[i] = look(state.position + state.half_width * outward, outward,
                    (outward - state.widening * state.tangent).normalized(), state.half_width, capture);
  }
  state.is_at_border = found[0].is_outside || found[1].is_outside;
  CrossSection section{state.position, way * normal, state.half_width, {false, false}};
  if (found[0].offset && found[1].offset) {
    const double wider = 0.5 * (*found[0].offset + *found[1].offset);
    // After a stretch without borders, this may be another tube: check the width.
    if (std::abs(wider) >= 0.25 * state.half_width + 0.3) return section;
    const double sideways = 0.5 * (*found[0].offset - *found[1].offset);
    section.center += sideways * normal, section.half_width += wider;
    section.is_seen = {true, true};
    state.correct(gains, sideways, wider, true);
  } else if (state.blind <= 2 && (found[0].offset || found[1].offset)) {
    const bool is_first = found[0].offset.has_value();
    const double sideways = is_first ? *found[0].offset : -*found[1].offset;
    if (std::abs(sideways) >= 0.6 * unit) return section;
    section.center += sideways * normal;
    section.is_seen[is_first == (way > 0) ? 0 : 1] = true;
    state.correct(gains, 0.5 * sideways, 0, false);
  }
  return section;
}

// Counts the sections since borders were visible.
template <typename Value>
void TubeTracker<Value>::count(State& state, const CrossSection& section) const {
  const bool any = section.is_seen[0] || section.is_seen[1];
  state.one_sided = any && !section.is_whole() ? state.one_sided + 1 : 0;
  state.blind = any ? 0 : state.blind + 1;
  if (!section.is_whole()) state.widening = 0;
  if (any) state.in_ground = 0;
  if (!any && !is_figure(state.position)) ++state.in_ground;
}

// Returns the reason to stop, if borders have been missing for too long.
template <typename Value>
std::optional<TrackEnd> TubeTracker<Value>::stop(const State& state) const {
  const double width = 2 * state.half_width;
  if (state.in_ground * step_ > 1.5 * width + 3) return TrackEnd::free;
  if (state.blind * step_ > 7 * width + 10 || state.one_sided * step_ > 10 * width + 20)
    return state.in_ground > 0 ? TrackEnd::free : TrackEnd::lost;
  if (state.is_at_border && state.blind * step_ > width + 6) return TrackEnd::border;
  return std::nullopt;
}

template <typename Value>
TrackEnd TubeTracker<Value>::follow(const CrossSection& seed, int way, std::vector<CrossSection>& sections) {
  const std::size_t first = sections.size();
  State state;
  state.position = seed.center, state.tangent = way * along(seed.normal), state.half_width = seed.half_width;
  const Vector2d start = seed.center, start_tangent = state.tangent;
  std::size_t last_seen = first;  // One past the last section with a visible border.
  std::optional<TrackEnd> end;
  const Gains gains(step_);
  while (!end && sections.size() - first < most_sections) {
    state.advance(step_);
    if (!is_in_view(state.position)) {
      end = TrackEnd::border;
      break;
    }
    sections.push_back(meet(state, gains, way));
    count(state, sections.back());
    if (state.blind == 0) last_seen = sections.size();
    end = stop(state);
    const double length = static_cast<double>(sections.size() - first) * step_;
    const bool is_back = (state.position - start).norm() < 0.75 * step_ + 0.5;
    if (!end && is_back && length > 8 * state.half_width && state.tangent.dot(start_tangent) > 0.9)
      end = TrackEnd::closed;
  }
  sections.resize(last_seen);
  return end.value_or(TrackEnd::lost);
}

template <typename Value>
void TubeTracker<Value>::refine(CrossSection& section, double widening) {
  const Vector2d slant = widening * along(section.normal);
  std::array<double, 2> offsets{};
  for (std::size_t i = 0; i < 2; ++i) {
    if (!section.is_seen[i]) continue;
    const Vector2d outward = (i == 0 ? 1 : -1) * section.normal;
    const Look found = look(section.center + section.half_width * outward, outward,
                            (outward - slant).normalized(), section.half_width, 1.2 * std::max(1.0, blur_));
    section.is_seen[i] = found.offset.has_value();
    if (found.offset) offsets[i] = *found.offset;
  }
  if (section.is_whole()) {
    section.center += 0.5 * (offsets[0] - offsets[1]) * section.normal;
    section.half_width += 0.5 * (offsets[0] + offsets[1]);
  } else {
    section.center += (offsets[0] - offsets[1]) * section.normal;
  }
}

template class TubeTracker<std::uint8_t>;
template class TubeTracker<std::uint16_t>;

}  // namespace flexura
