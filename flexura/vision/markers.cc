#include "flexura/vision/markers.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "flexura/math/median.h"
#include "flexura/math/small_cholesky.h"
#include "flexura/vision/arm_skin.h"
#include "flexura/vision/marker_texture.h"
#include "flexura/vision/spots.h"

namespace flexura {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr std::size_t middle_line = ArmSkin::middle_line, lines = ArmSkin::lines.size();

// Smallest difference of brightness or colour between markers and arm, of 255.
constexpr double least_difference = 14;

// Returns whether a stretch is background: at an end of the arm, the blur mixes it into the last pixels.
bool is_ground(const Stretch& stretch, std::size_t size) {
  constexpr std::size_t most = 3;
  return (stretch.first == 0 && stretch.last <= most) ||
         (stretch.last == size && stretch.first + most >= size);
}

// The part of a marker on one line: its middle and length from the moments of its difference from the
// surrounding skin.
struct Part {
  double middle = 0, length = 0, height = 0, sigma = 0;
};
using Parts = std::array<std::optional<Part>, lines>;

// Finds a band's parts on all lines.
class BandFinder {
 public:
  BandFinder(const ArmSkin& skin, double bound, double noise)
      : skin_(skin), bound_(0.5 * bound), noise_(noise) {
    for (std::size_t line = 0; line < lines; ++line) {
      own_[line] = median_color(skin.colors[line]);
      stretches_[line] = stretches(skin.colors[line], own_[line], bound_);
    }
  }
  [[nodiscard]] const Vector3d& own() const { return own_[middle_line]; }

  // From the middle line outwards: the next parts are those adjacent to a band's parts.
  [[nodiscard]] Parts parts_of(const Stretch& stretch, const Vector3d& direction) const {
    Parts parts;
    parts[middle_line] = part_of(middle_line, stretch, direction);
    if (!parts[middle_line]) return parts;
    const std::size_t middle = (stretch.first + stretch.last) / 2;
    const double reach = 0.35 * skin_.half_widths[middle] + 1.5;
    for (const int side : {-1, 1}) {
      double place = parts[middle_line]->middle;
      for (std::size_t step = 1; step <= middle_line; ++step) {
        const std::size_t line = side < 0 ? middle_line - step : middle_line + step;
        const Stretch* near = nearest(stretches_[line], place);
        if (near == nullptr || std::abs(middle_of(*near) - place) > reach) continue;
        parts[line] = part_of(line, *near, direction);
        if (parts[line]) place = parts[line]->middle;
      }
    }
    return parts;
  }

 private:
  static double middle_of(const Stretch& stretch) {
    return 0.5 * static_cast<double>(stretch.first + stretch.last - 1);
  }
  static const Stretch* nearest(const std::vector<Stretch>& of, double place) {
    const auto best = std::ranges::min_element(
        of, {}, [&](const Stretch& stretch) { return std::abs(middle_of(stretch) - place); });
    return best == of.end() ? nullptr : &*best;
  }

  [[nodiscard]] std::optional<Part> part_of(std::size_t line, const Stretch& near,
                                            const Vector3d& direction) const {
    const std::vector<Vector3d>& colors = skin_.colors[line];
    constexpr std::size_t margin = 4;
    if (near.first < margin || near.last + margin > colors.size()) return std::nullopt;
    const std::size_t from = near.first - margin, to = near.last + margin;
    const double before = (colors[from] + colors[from + 1]).dot(direction) / 2;
    const double after = (colors[to - 1] + colors[to - 2]).dot(direction) / 2;
    double sum = 0, first = 0, most = 0;
    for (std::size_t i = from; i < to; ++i) {
      const double share = static_cast<double>(i - from) / static_cast<double>(to - 1 - from);
      const double value = colors[i].dot(direction) - before - share * (after - before);
      sum += value, first += value * static_cast<double>(i), most = std::max(most, value);
    }
    if (most < bound_ || sum <= 0) return std::nullopt;
    const auto n = static_cast<double>(to - from);
    const Part part{first / sum, sum / most, most, noise_ * std::sqrt(n * n * n / 12) / sum};
    if (part.middle < static_cast<double>(from) || part.middle > static_cast<double>(to)) return std::nullopt;
    return part;
  }

  const ArmSkin& skin_;
  double bound_, noise_;
  std::array<Vector3d, lines> own_;
  std::array<std::vector<Stretch>, lines> stretches_;
};

// Removes parts much longer, shorter or fainter than those around the middle: they belong to another marker,
// or lie beside a round one. Returns whether the rest is a band.
bool keep_alike(Parts& parts) {
  std::array<double, 3> lengths{}, heights{};
  std::size_t count = 0;
  for (std::size_t i = middle_line - 1; i <= middle_line + 1; ++i)
    if (parts[i]) lengths[count] = parts[i]->length, heights[count++] = parts[i]->height;
  if (count == 0) return false;
  const double length = median(std::span(lengths.data(), count)),
               height = median(std::span(heights.data(), count));
  for (auto& part : parts)
    if (part && (part->length > 1.6 * length || part->length < 0.6 * length || part->height < 0.4 * height))
      part.reset();
  if (std::ranges::count_if(parts, [](const auto& part) { return part.has_value(); }) < 5) return false;
  const auto is_alike = [&](const auto& part) {
    return !part || (part->length > 0.8 * length && part->length < 1.25 * length);
  };
  // A round one is shorter towards its sides.
  return (parts.front() && parts.back()) ||
         ((parts.front() || parts.back()) && parts[1] && parts[lines - 2]) ||
         std::ranges::all_of(parts, is_alike);
}

// Least-squares fit middle(y) = x + bulge h sqrt(1 - y^2) + tilt y over the available parts. A straight arm
// has no tilt; it shifts x only if the parts are asymmetric.
struct BandFit {
  double along = 0, bulge = 0, tilt = 0;
  double misfit = 0;      // Standard deviation of the parts' middles from the fit, px.
  double part_sigma = 0;  // Expected value of `misfit`, px.
  double gain = 0;        // Standard deviation of x relative to that of a part.
  double mean_front = 0;  // Mean of h sqrt(1 - y^2), px.
};
BandFit fitted(const Parts& parts, double half_width) {
  const auto row_of = [&](std::size_t line) {
    const double y = ArmSkin::lines[line];
    return Vector3d(1, half_width * std::sqrt(1 - y * y), y);
  };
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  double count = 0, variance = 0, square = 0;
  BandFit fit;
  for (std::size_t i = 0; i < lines; ++i) {
    if (!parts[i]) continue;
    const Vector3d row = row_of(i);
    normal += row * row.transpose(), right += parts[i]->middle * row;
    variance += parts[i]->sigma * parts[i]->sigma, ++count;
    fit.mean_front += row[1];
  }
  const Vector3d solution = solve_definite(normal, right);
  for (std::size_t i = 0; i < lines; ++i) {
    if (!parts[i]) continue;
    const double miss = parts[i]->middle - row_of(i).dot(solution);
    square += miss * miss;
  }
  fit.along = solution[0], fit.bulge = solution[1], fit.tilt = solution[2];
  fit.misfit = std::sqrt(square / (count - 3)), fit.part_sigma = std::sqrt(variance / count);
  fit.gain = std::sqrt(normal.inverse()(0, 0)), fit.mean_front /= count;
  return fit;
}

// Combines the parts of a band. Omits the outermost part of one side if that belongs to something else.
MarkerObservation band_of(Parts parts, double half_width) {
  BandFit fit = fitted(parts, half_width);
  if (fit.misfit > 2 * fit.part_sigma &&
      std::ranges::count_if(parts, [](const auto& part) { return part.has_value(); }) > 5) {
    const Parts all = parts;
    const BandFit whole = fit;
    for (const std::size_t line : {std::size_t{0}, lines - 1}) {
      if (!all[line]) continue;
      Parts fewer = all;
      fewer[line].reset();
      const BandFit other = fitted(fewer, half_width);
      if (other.misfit < 0.4 * whole.misfit && other.misfit < fit.misfit) fit = other, parts = fewer;
    }
  }
  MarkerObservation band;
  double count = 0;
  for (const auto& part : parts)
    if (part) band.length += part->length, ++count;
  band.length /= count;
  band.bulge = std::clamp(fit.bulge, -1.0, 1.0);
  const double beyond = (fit.bulge - band.bulge) * fit.mean_front;
  band.along = fit.along + beyond;
  // A misfit counts if it is larger than chance explains.
  const double part_sigma = fit.misfit > 1.2 * fit.part_sigma ? fit.misfit : fit.part_sigma;
  // Where the arm bends within its width, the parts tilt by a pixel or more. Half of that is the error of x,
  // as measured on random arms.
  const double bent = 0.5 * fit.tilt * std::min(std::abs(fit.tilt), 1.0);
  band.sigma = std::sqrt(std::pow(fit.gain * part_sigma, 2) + beyond * beyond + bent * bent);
  return band;
}

// Returns whether the signal drops inside a stretch of the middle line: two markers merged by blur.
bool has_dip(const std::vector<Vector3d>& colors, const Stretch& stretch, const Vector3d& own, double noise) {
  const auto size = [&](std::size_t i) { return (colors[i] - own).norm(); };
  double most = 0, before = 0, after = 0, deepest = 0;
  std::size_t top = stretch.first;
  for (std::size_t i = stretch.first; i < stretch.last; ++i)
    if (size(i) > most) most = size(i), top = i;
  // From both ends to the top it should only rise.
  for (std::size_t i = stretch.first; i < top; ++i)
    before = std::max(before, size(i)), deepest = std::max(deepest, before - size(i));
  for (std::size_t i = stretch.last - 1; i > top; --i)
    after = std::max(after, size(i)), deepest = std::max(deepest, after - size(i));
  return deepest > std::max(0.3 * most, 8 * noise);
}

void look_for_merged(std::vector<MarkerObservation>& markers) {
  for (const bool are_bands : {true, false}) {
    std::vector<double> lengths;
    lengths.reserve(markers.size());
    for (const MarkerObservation& marker : markers)
      if (marker.is_band == are_bands) lengths.push_back(marker.length);
    if (lengths.size() < 2) continue;
    std::ranges::sort(lengths);
    // With only two markers, the shorter length is the usual length of a single marker.
    const double usual = lengths[lengths.size() < 4 ? (lengths.size() - 1) / 2 : lengths.size() / 2];
    for (MarkerObservation& marker : markers)
      if (marker.is_band == are_bands && marker.length > 1.8 * usual) marker.may_be_merged = true;
  }
}

void look_for_gaps(MarkerObservations& found) {
  const std::vector<MarkerObservation>& markers = found.markers;
  // The markers behind the gaps; markers side by side have no gap between them.
  std::vector<std::size_t> ends;
  std::vector<double> gaps;
  ends.reserve(markers.size()), gaps.reserve(markers.size());
  for (std::size_t i = 1; i < markers.size(); ++i) {
    const double gap = markers[i].along - markers[i - 1].along;
    if (gap > 0.5 * std::min(markers[i].length, markers[i - 1].length))
      ends.push_back(i), gaps.push_back(gap);
  }
  if (gaps.size() < 3) return;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    // The spacing changes slowly where the arm turns away: compare with the neighbouring gaps.
    const double before = i > 0 ? gaps[i - 1] : gaps[i + 1],
                 after = i + 1 < gaps.size() ? gaps[i + 1] : gaps[i - 1];
    if (gaps[i] > 1.7 * std::max(before, after))
      found.notes.push_back(
          fmt::format("a marker may be missing between markers {} and {}", ends[i], ends[i] + 1));
  }
}

// Adds notes on stretches of another colour that are neither bands nor among the spots.
void note_left_out(const std::vector<Stretch>& others, const std::vector<MarkerObservation>& spots,
                   std::vector<std::string>& notes) {
  const auto is_spot = [&](const Stretch& stretch) {
    return std::ranges::any_of(spots, [&](const MarkerObservation& spot) {
      return spot.along + spot.length > static_cast<double>(stretch.first) &&
             spot.along - spot.length < static_cast<double>(stretch.last);
    });
  };
  const auto dropped = std::ranges::count_if(others, [&](const Stretch& other) { return !is_spot(other); });
  if (dropped > 0)
    notes.push_back(
        fmt::format("{} spot{} of another colour omitted: at an end of the arm, half hidden, touching "
                    "another spot, or too small to be a marker",
                    dropped, dropped > 1 ? "s" : ""));
}

}  // namespace

MarkerObservations find_markers(const Image<std::uint8_t>& picture, const ArmObservation& arm,
                                bool with_spots) {
  MarkerObservations found;
  if (arm.axis.size() < 8) return found;
  const ArmSkin skin(picture, arm);
  if (skin.size() < 12) return found;
  // On a thinner arm the background affects every pixel.
  constexpr double thinnest = 4;  // px
  std::vector<double> half_widths = skin.half_widths;
  const double thickness = 2 * median(std::span(half_widths));
  if (thickness < thinnest) {
    found.notes.push_back(
        fmt::format("the arm is {:.1f} px thick: markers are not searched below {} px", thickness, thinnest));
    return found;
  }
  double bound = std::max(least_difference, 5 * arm.noise);
  if (const auto texture = texture_of(skin, thickness, bound)) {
    // A marker must stand out from the texture even at half of the bound, where its parts are compared.
    constexpr double stands_out = 2.5;
    bound = std::max(bound, stands_out * texture->contrast);
    found.notes.push_back(
        fmt::format("the arm's surface has a texture ({} periods of {:.1f} px): only spots that differ "
                    "2.5 times as much as the texture count as markers",
                    texture->count, texture->period));
    if (texture_of(skin, thickness, bound)) return found;
  }
  const BandFinder finder(skin, bound, arm.noise);
  std::vector<Stretch> bands, others;
  for (const Stretch& stretch : stretches(skin.colors[middle_line], finder.own(), bound)) {
    if (is_ground(stretch, skin.size())) continue;
    const std::size_t middle = (stretch.first + stretch.last) / 2;
    const Vector3d color = skin.colors[middle_line][middle];
    Parts parts = finder.parts_of(stretch, (color - finder.own()).normalized());
    if (!keep_alike(parts)) {
      others.push_back(stretch);
      continue;
    }
    MarkerObservation band = band_of(parts, skin.half_widths[middle]);
    if (!std::isfinite(band.sigma)) continue;  // The arm is no wider than a line at this position.
    band.pixel = skin.at(band.along);
    band.color = color;
    band.may_be_merged = has_dip(skin.colors[middle_line], stretch, finder.own(), arm.noise);
    found.markers.push_back(band);
    bands.push_back(stretch);
  }
  std::vector<MarkerObservation> spots;
  if (with_spots) spots = find_spots(picture, arm, skin, bands, bound);
  found.markers.insert(found.markers.end(), spots.begin(), spots.end());
  if (with_spots) note_left_out(others, spots, found.notes);
  std::ranges::stable_sort(found.markers, {}, &MarkerObservation::along);
  look_for_merged(found.markers);
  look_for_gaps(found);
  return found;
}

}  // namespace flexura
