#include "flexura/vision/etalon_finder.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "flexura/math/median.h"
#include "flexura/vision/border.h"
#include "flexura/vision/edge_finder.h"
#include "flexura/vision/runs.h"

namespace flexura {
namespace {

using Eigen::Vector2d;

// A least-squares line, refitted twice without points more than three times the rms away.
std::optional<UprightLine> line_through(std::vector<Vector2d> points, double middle_row) {
  UprightLine line;
  for (int round = 0; round < 3; ++round) {
    if (points.size() < 4) return std::nullopt;
    double n = 0, sv = 0, svv = 0, su = 0, suv = 0;
    for (const Vector2d& point : points) {
      const double v = point.y() - middle_row;
      n += 1, sv += v, svv += v * v, su += point.x(), suv += point.x() * v;
    }
    const double determinant = n * svv - sv * sv;
    if (determinant < 1e-9) return std::nullopt;
    line.slope = (n * suv - sv * su) / determinant, line.at = (su - line.slope * sv) / n;
    double squares = 0;
    const auto miss = [&](const Vector2d& point) {
      return point.x() - line.at - line.slope * (point.y() - middle_row);
    };
    for (const Vector2d& point : points) squares += miss(point) * miss(point);
    line.rms = std::sqrt(squares / n), line.count = static_cast<int>(points.size());
    const double bound = std::max(3 * line.rms, 0.02);
    std::erase_if(points, [&](const Vector2d& point) { return std::abs(miss(point)) > bound; });
  }
  return line;
}

// Redness of a pixel; in a gray picture its brightness.
double redness(const Image<std::uint8_t>& picture, int u, int v) {
  if (picture.channels() != 3) return picture.at(u, v);
  return picture.at(u, v, 0) - 0.5 * (picture.at(u, v, 1) + picture.at(u, v, 2));
}

// Adds the middles of peaks in a row between two columns.
void add_peaks(const Image<std::uint8_t>& picture, int v, int first, int last, double bound,
               std::vector<Vector2d>& peaks) {
  std::vector<double> values;
  for (int u = first; u < last; ++u) values.push_back(redness(picture, u, v));
  if (values.size() < 5) return;
  std::vector<double> sorted = values;
  const double ground = median(std::span(sorted));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] - ground < bound) continue;
    std::size_t end = i;
    while (end < values.size() && values[end] - ground >= bound) ++end;
    const std::size_t from = i - std::min<std::size_t>(i, 2), to = std::min(end + 2, values.size());
    double sum = 0, first_moment = 0;
    for (std::size_t j = from; j < to; ++j) {
      sum += values[j] - ground, first_moment += (values[j] - ground) * static_cast<double>(j);
    }
    if (sum > 0) peaks.emplace_back(first + first_moment / sum, v);
    i = end;
  }
}

// Joins the peaks of many rows to lines: from row to row the nearest, if near enough.
std::vector<UprightLine> lines_through(const std::vector<Vector2d>& peaks, double middle_row, int rows) {
  std::vector<std::vector<Vector2d>> chains;
  for (const Vector2d& peak : peaks) {
    std::vector<Vector2d>* best = nullptr;
    double nearest = 2.5;
    for (auto& chain : chains) {
      const double rows_between = peak.y() - chain.back().y();
      if (rows_between <= 0 || rows_between > 12) continue;
      const double distance = std::abs(chain.back().x() - peak.x());
      if (distance < nearest) nearest = distance, best = &chain;
    }
    if (best == nullptr) best = &chains.emplace_back();
    best->push_back(peak);
  }
  std::vector<UprightLine> lines;
  for (const auto& chain : chains) {
    if (static_cast<int>(chain.size()) * 3 < rows) continue;
    if (const auto line = line_through(chain, middle_row)) lines.push_back(*line);
  }
  std::ranges::sort(lines, {}, &UprightLine::at);
  return lines;
}

// For each row of a component's box: its first column, and the one after its last.
std::vector<std::array<int, 2>> spans_of(const Components& components, const Component& component) {
  std::vector<std::array<int, 2>> spans(static_cast<std::size_t>(component.bottom - component.top + 1),
                                        {component.right + 1, component.left});
  const auto own = static_cast<std::uint32_t>(&component - components.list.data());
  for (const Run& run : components.runs) {
    if (run.component != own) continue;
    auto& [first, last] = spans[static_cast<std::size_t>(run.v - component.top)];
    first = std::min(first, run.first), last = std::max(last, run.last);
  }
  return spans;
}

// Finds where row v crosses the border near column u; `way`: outward, 1 or -1. The residual of the border
// model goes to `left`.
std::optional<Vector2d> side_of(const EdgeFinder<std::uint8_t>& edges, double u, int v, double way,
                                double room, double blur, double least_contrast, double* left = nullptr) {
  for (int i = 0; i < 4; ++i) {
    const auto fit = edges.look({u, v}, {way, 0}, blur, room);
    if (!fit || fit->contrast < least_contrast) return std::nullopt;
    u += way * std::clamp(fit->offset, -1.0, 1.0);
    if (left != nullptr) *left = fit->residual * fit->residual;
    if (std::abs(fit->offset) < 0.05) break;
  }
  return Vector2d(u, v);
}

// Finds the border of an upright figure's end, `way` 1 for the lower one. It is the mean of the columns a
// quarter of the width beside the middle, where there is no line if one is in the middle.
std::optional<double> end_edge(const EdgeFinder<std::uint8_t>& edges, const Image<std::uint8_t>& gray,
                               const EtalonObservation& seen, int way) {
  const double end = way > 0 ? seen.bottom : seen.top, room = 0.25 * (seen.bottom - seen.top);
  const double quarter =
      0.25 * (seen.right.at - seen.left.at + (seen.right.slope - seen.left.slope) * (end - seen.middle_row));
  const double least_contrast = 0.3 * (seen.threshold.bright - seen.threshold.dark);
  double sum = 0;
  for (const double side : {-1.0, 1.0}) {
    int v = way > 0 ? seen.bottom : seen.top;
    const int u = static_cast<int>(std::lround(seen.middle(v) + side * quarter));
    if (u < 0 || u >= gray.width()) return std::nullopt;
    // An end seen from above or below is round, and a camera may be rolled.
    while (v > seen.top - 1 && v < seen.bottom + 1 && gray.at(u, v) > seen.threshold.level) v -= way;
    double at = v + 0.5 * way;
    for (int i = 0; i < 4; ++i) {
      const auto fit = edges.look({u, at}, {0, way}, 0.8, room);
      if (!fit || fit->contrast < least_contrast) return std::nullopt;
      at += way * std::clamp(fit->offset, -1.0, 1.0);
      if (std::abs(fit->offset) < 0.05) break;
    }
    sum += 0.5 * at;
  }
  return sum;
}

// Where the rows between the ends' ellipses cross both sides, and the peaks between these.
struct Crossings {
  std::array<std::vector<Vector2d>, 2> sides;
  std::vector<Vector2d> peaks;
};

// Returns the blur of the sides, px, from a series, by the residuals of the border model in some rows. Empty
// if no side is found.
std::optional<double> side_blur(const BlurSeries& series, std::size_t count,
                                const EdgeFinder<std::uint8_t>& edges,
                                const std::vector<std::array<int, 2>>& spans, int top, int inset,
                                double least_contrast) {
  constexpr std::size_t desired = 24;
  std::vector<double> sum(count), left(count);
  const std::size_t rows = spans.size() - std::min(spans.size(), 2 * static_cast<std::size_t>(inset));
  for (std::size_t row = 0; row < rows; row += std::max<std::size_t>(1, rows / desired)) {
    const auto [first, last] = spans[row + static_cast<std::size_t>(inset)];
    const int v = top + inset + static_cast<int>(row);
    for (const double way : {-1.0, 1.0}) {
      const double u = (way < 0 ? first : last) - 0.5, room = 0.25 * (last - first);
      bool is_found = last > first;
      for (std::size_t i = 0; is_found && i < count; ++i)
        is_found = side_of(edges, u, v, way, room, series.at(i), least_contrast, &left[i]).has_value();
      for (std::size_t i = 0; is_found && i < count; ++i) sum[i] += left[i];
    }
  }
  if (!(std::ranges::max(sum) > 0)) return std::nullopt;
  return series.least(sum);
}

Crossings crossings_of(const Image<std::uint8_t>& picture, const Image<std::uint8_t>& gray,
                       const Threshold& threshold, const std::vector<std::array<int, 2>>& spans, int top,
                       int inset) {
  BlurredSteps steps;
  const EdgeFinder<std::uint8_t> edges(gray, threshold.figure == Figure::dark ? 1 : -1, steps,
                                       lone_border_blur);
  const double contrast = threshold.bright - threshold.dark;
  const double bound = picture.channels() == 3 ? 25 : 0.06 * contrast + 4, least_contrast = 0.3 * contrast;
  const auto blur_among = [&](const BlurSeries& series, std::size_t count) {
    return side_blur(series, count, edges, spans, top, inset, least_contrast);
  };
  Crossings found;
  const auto roughly = blur_among({}, 11);
  if (!roughly) return found;
  const double blur = blur_among({*roughly / (1.08 * 1.08), 1.08}, 5).value_or(*roughly);
  for (auto row = static_cast<std::size_t>(inset); row + static_cast<std::size_t>(inset) < spans.size();
       ++row) {
    const auto [first, last] = spans[row];
    if (last <= first) continue;
    const int v = top + static_cast<int>(row);
    const double room = 0.25 * (last - first);
    const auto left = side_of(edges, first - 0.5, v, -1, room, blur, least_contrast),
               right = side_of(edges, last - 0.5, v, 1, room, blur, least_contrast);
    if (left) found.sides[0].push_back(*left);
    if (right) found.sides[1].push_back(*right);
    const int margin = std::max(3, (last - first) / 30);
    add_peaks(picture, v, first + margin, last - margin, bound, found.peaks);
  }
  return found;
}

}  // namespace

EtalonObservation find_etalon(const Image<std::uint8_t>& picture, const Image<std::uint8_t>& gray,
                              const ThresholdConfig& config) {
  EtalonObservation seen;
  Components components;
  BlockThresholds blocks;
  seen.threshold = segment(gray, config, components, blocks);
  seen.reason = seen.threshold.reason;
  if (!seen.reason.empty()) return seen;
  if (seen.threshold.figure != Figure::dark) {
    seen.reason =
        "the figure is brighter than the background: expected a dark cylinder in front of a bright screen";
    return seen;
  }
  const auto largest = std::ranges::max_element(components.list, {}, &Component::area);
  if (largest == components.list.end() || largest->area < 200) {
    seen.reason = "there is no cylinder: the largest figure has fewer than 200 px";
    return seen;
  }
  seen.touches_border = largest->on_border > 0;
  seen.top = largest->top, seen.bottom = largest->bottom;
  seen.middle_row = 0.5 * (seen.top + seen.bottom);
  const int height = seen.bottom - seen.top + 1;
  // Skips the ends' ellipses.
  const int inset = std::max(2, height / 10);
  const Crossings found =
      crossings_of(picture, gray, seen.threshold, spans_of(components, *largest), seen.top, inset);
  const auto left = line_through(found.sides[0], seen.middle_row),
             right = line_through(found.sides[1], seen.middle_row);
  if (!left || !right) {
    seen.reason =
        fmt::format("the largest figure ({} px) does not have two straight visible sides", largest->area);
    return seen;
  }
  seen.left = *left, seen.right = *right;
  const auto width_at = [&](double v) {
    return right->at - left->at + (right->slope - left->slope) * (v - seen.middle_row);
  };
  seen.width_above = width_at(seen.top + inset), seen.width_below = width_at(seen.bottom - inset);
  if (std::max(left->rms, right->rms) > 0.05 * width_at(seen.middle_row)) {
    seen.reason = fmt::format(
        "the largest figure is not an upright cylinder: its sides deviate by {:.2g} and {:.2g} px from "
        "straight lines",
        left->rms, right->rms);
    return seen;
  }
  BlurredSteps steps;
  const EdgeFinder<std::uint8_t> edges(gray, 1, steps);
  seen.upper_edge = end_edge(edges, gray, seen, -1);
  seen.lower_edge = end_edge(edges, gray, seen, 1);
  seen.lines = lines_through(found.peaks, seen.middle_row, height - 2 * inset);
  return seen;
}

}  // namespace flexura
