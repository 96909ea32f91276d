#include "flexura/vision/rim_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "flexura/math/median.h"

namespace flexura {
namespace {

// Beyond this many standard deviations, a rim is not searched; px at most.
constexpr double searched = 2.5;
constexpr int farthest = 60;
// Least standard deviations of the light of tube and surroundings: noise and shading, of 255.
constexpr double least_inside = 5, least_outside = 7;
// Shares of pixels that are no outliers.
constexpr float inliers_inside = 0.9F, inliers_outside = 0.6F;

// Returns the brightness at a pixel by bilinear interpolation.
float between(const Image<std::uint8_t>& plane, int u, int v, float right, float down) {
  const auto top = plane.row(v), bottom = plane.row(v + 1);
  const auto at = static_cast<std::size_t>(u);
  const float above = static_cast<float>(top[at]) + right * static_cast<float>(top[at + 1] - top[at]);
  const float below =
      static_cast<float>(bottom[at]) + right * static_cast<float>(bottom[at + 1] - bottom[at]);
  return above + down * (below - above);
}

}  // namespace

void RimLight::Moments::add(const Values& value, std::size_t planes) {
  ++count;
  for (std::size_t c = 0; c < planes; ++c) {
    const double one = value[c];
    sum[c] += one, square[c] += one * one;
  }
}

void RimLight::Moments::add(const Moments& other, double sign, std::size_t planes) {
  count += sign * other.count;
  for (std::size_t c = 0; c < planes; ++c) sum[c] += sign * other.sum[c], square[c] += sign * other.square[c];
}

RimLight::Normal RimLight::normal_of(const Moments& moments, double least_sigma) const {
  constexpr double levels = 256;
  Normal normal;
  double scale = 1;
  for (std::size_t c = 0; c < planes_; ++c) {
    const double mean = moments.sum[c] / moments.count;
    const double variance = std::max(moments.square[c] / moments.count - mean * mean, 0.0);
    const double sigma = std::sqrt(variance + least_sigma * least_sigma);
    normal.mean[c] = static_cast<float>(mean);
    normal.factor[c] = static_cast<float>(1 / (std::numbers::sqrt2 * sigma));
    scale *= levels / (sigma * std::sqrt(2 * std::numbers::pi));
  }
  normal.scale = static_cast<float>(scale);
  return normal;
}

void RimLight::sample(std::span<const Image<std::uint8_t>> planes, const Image<std::uint8_t>& inside,
                      const ExpectedSection& section, std::size_t rim, Profile& profile) {
  const ExpectedRim& at = section.rims[rim];
  profile.reach = std::clamp(static_cast<int>(std::ceil(searched * section.reach + 1)), 2, farthest);
  profile.inner = std::clamp(static_cast<int>(0.4 * section.width), 2, 8);
  profile.outer = std::clamp(static_cast<int>(0.5 * section.width), 3, 8);
  profile.first = values_.size();
  profile.is_seen = at.is_visible && at.pixel.allFinite();
  const int width = planes[0].width(), height = planes[0].height();
  for (int j = 0; j < profile.count(); ++j) {
    const Eigen::Vector2d place = at.pixel + (j + 0.5 - profile.reach - profile.inner) * at.outward;
    Values value = {};
    const bool is_in = profile.is_seen && place.x() >= 0 && place.y() >= 0 && place.x() < width - 1 &&
                       place.y() < height - 1;
    bool is_known = false;
    if (is_in) {
      const int u = static_cast<int>(place.x()), v = static_cast<int>(place.y());
      is_known = inside.values().empty() || inside.row(v)[static_cast<std::size_t>(u)] != 0;
      for (std::size_t c = 0; c < planes_; ++c)
        value[c] =
            between(planes[c], u, v, static_cast<float>(place.x() - u), static_cast<float>(place.y() - v));
    }
    values_.push_back(value), is_known_.push_back(is_known ? 1 : 0);
  }
  // One number more, for the sums.
  values_.push_back({}), is_known_.push_back(0);
}

// Pixels within the tube wherever it is, up to 1.5 standard deviations, are its own; pixels beyond the search
// are the surroundings'. Something before the tube differs from most of its sections, and does not count.
void RimLight::add_moments(std::span<const ExpectedSection> sections) {
  constexpr double surely = 1.5, blurred = 1;
  own_.assign(sections.size(), {});
  inside_.assign(sections.size() + 1, {}), middle_ = inside_;
  outside_.fill(inside_);
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const ExpectedSection& section = sections[i];
    Moments& own = own_[i];
    Moments middle;
    for (std::size_t rim = 0; rim < 2; ++rim) {
      const Profile& one = profile(i, rim);
      Moments beyond;
      for (int j = 0; j < one.count(); ++j) {
        const auto at = one.first + static_cast<std::size_t>(j);
        if (is_known_[at] == 0) continue;
        const double x = j + 0.5 - one.reach - one.inner, depth = -x / section.width;
        if (x < -(surely * section.reach + blurred) && depth <= 0.5) own.add(values_[at], planes_);
        if (depth > 0.25 && depth <= 0.5) middle.add(values_[at], planes_);
        if (x > one.reach) beyond.add(values_[at], planes_);
      }
      outside_[rim][i + 1] = outside_[rim][i];
      outside_[rim][i + 1].add(beyond, 1, planes_);
    }
    middle_[i + 1] = middle_[i];
    middle_[i + 1].add(middle, 1, planes_);
  }
  leave_out_strangers();
  for (std::size_t i = 0; i < sections.size(); ++i) {
    inside_[i + 1] = inside_[i];
    inside_[i + 1].add(own_[i], 1, planes_);
  }
}

void RimLight::leave_out_strangers() {
  constexpr double of_normal = 1.4826, least = 8, most = 4;
  for (std::size_t c = 0; c < planes_; ++c) {
    means_.clear();
    for (const Moments& own : own_)
      if (own.count > 0) means_.push_back(own.sum[c] / own.count);
    if (means_.empty()) return;
    const double middle = median(std::span(means_));
    for (double& mean : means_) mean = std::abs(mean - middle);
    const double spread = std::max(of_normal * median(std::span(means_)), least);
    for (Moments& own : own_)
      if (own.count > 0 && std::abs(own.sum[c] / own.count - middle) > most * spread) own = {};
  }
}

// The nearest sections with enough sure pixels; without any, what is in the middle of the expected tube.
RimLight::Moments RimLight::inside_near(std::size_t section) const {
  constexpr double enough = 60;
  const std::size_t count = inside_.size() - 1;
  for (const auto* sums : {&inside_, &middle_}) {
    for (std::size_t near = 6;; near *= 2) {
      Moments moments = (*sums)[std::min(section + near + 1, count)];
      moments.add((*sums)[section - std::min(section, near)], -1, planes_);
      if (moments.count >= enough || (near >= count && moments.count >= 8)) return moments;
      if (near >= count) break;
    }
  }
  return {};
}

RimLight::Moments RimLight::outside_near(std::size_t section, std::size_t rim) const {
  constexpr std::size_t near = 2;
  const std::vector<Moments>& sums = outside_[rim];
  Moments moments = sums[std::min(section + near + 1, sums.size() - 1)];
  moments.add(sums[section - std::min(section, near)], -1, planes_);
  return moments;
}

float RimLight::log_ratio(const Values& value, const Normal& tube, const Normal& around) const {
  constexpr float most = 4;
  float off_tube = 0, off_around = 0;
  for (std::size_t c = 0; c < planes_; ++c) {
    const float a = (value[c] - tube.mean[c]) * tube.factor[c],
                b = (value[c] - around.mean[c]) * around.factor[c];
    off_tube += a * a, off_around += b * b;
  }
  const float by_tube = inliers_inside * tube.scale * std::exp(-off_tube) + (1 - inliers_inside),
              by_around = inliers_outside * around.scale * std::exp(-off_around) + (1 - inliers_outside);
  return std::clamp(std::log(by_tube / by_around), -most, most);
}

void RimLight::measure(std::span<const Image<std::uint8_t>> planes, const Image<std::uint8_t>& inside,
                       std::span<const ExpectedSection> sections, bool keeps_light) {
  planes_ = std::min(planes.size(), most_planes);
  profiles_.assign(2 * sections.size(), {});
  values_.clear(), is_known_.clear();
  for (std::size_t i = 0; i < sections.size(); ++i)
    for (std::size_t rim = 0; rim < 2; ++rim)
      sample(planes, inside, sections[i], rim, profiles_[2 * i + rim]);
  if (!keeps_light) add_moments(sections);
  sums_.assign(values_.size(), 0);
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Moments own = inside_near(i);
    for (std::size_t rim = 0; rim < 2; ++rim) {
      Profile& one = profiles_[2 * i + rim];
      const Moments beyond = outside_near(i, rim);
      constexpr double few = 3;
      if (own.count < few || beyond.count < few) one.is_seen = false;
      if (!one.is_seen) continue;
      const Normal tube = normal_of(own, least_inside), around = normal_of(beyond, least_outside);
      float sum = 0;
      for (int j = 0; j < one.count(); ++j) {
        const auto at = one.first + static_cast<std::size_t>(j);
        if (is_known_[at] != 0) sum += log_ratio(values_[at], tube, around);
        sums_[at + 1] = sum;
      }
    }
  }
}

}  // namespace flexura
