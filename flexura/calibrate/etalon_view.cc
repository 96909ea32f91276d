#include "flexura/calibrate/etalon_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "flexura/vision/picture_file.h"
#include "flexura/vision/runs.h"
#include "flexura/vision/threshold.h"

namespace flexura {
namespace {

// Finds the centroid of the largest figure, whatever its shape.
void find_centroid(const Image<std::uint8_t>& gray, EtalonView& view) {
  Components components;
  BlockThresholds blocks;
  const Threshold threshold = segment(gray, {}, components, blocks);
  if (!threshold.reason.empty() || threshold.figure != Figure::dark || components.list.empty()) return;
  const auto largest = std::ranges::max_element(components.list, {}, &Component::area);
  const auto own = static_cast<std::uint32_t>(largest - components.list.begin());
  Eigen::Vector2d sum(0, 0);
  double count = 0;
  for (const Run& run : components.runs) {
    if (run.component != own) continue;
    const double n = run.last - run.first;
    sum += n * Eigen::Vector2d(0.5 * (run.first + run.last - 1), run.v);
    count += n;
  }
  constexpr double fewest = 50;  // px
  if (count < fewest) return;
  view.centroid = sum / count;
  view.is_too_large = (largest->left == 0 && largest->right == gray.width() - 1) ||
                      (largest->top == 0 && largest->bottom == gray.height() - 1);
}

// Computes angles around the vertical from the three positions on the row of the principal point.
void find_bearing(const EtalonObservation& seen, const UprightLine& line, const Lens& lens, double radius,
                  EtalonView& view) {
  const double v = lens.intrinsics().cy;
  const auto at = [&](const UprightLine& side) { return side.at + side.slope * (v - seen.middle_row); };
  const auto angle = [&](double u) {
    const auto ray = lens.unproject({u, v});
    return ray ? std::atan(ray->x()) : 0.0;
  };
  const double left = angle(at(seen.left)), right = angle(at(seen.right)), red = angle(at(line));
  view.sight = 0.5 * (left + right);
  const double share = std::sin(0.5 * (right - left));  // radius over distance
  view.distance = radius / share;
  view.magnification = lens.intrinsics().fx / view.distance;
  // Law of sines in the triangle of camera, axis and line: sin(off) / r = sin(off + around) / D.
  const auto around = [&](double off) {
    return std::asin(std::clamp(std::sin(off) / share, -1.0, 1.0)) - off;
  };
  view.bearing = -around(red - view.sight);
  view.line = at(line) - 0.5 * (at(seen.left) + at(seen.right));
  view.middle = 0.5 * (at(seen.left) + at(seen.right)) - lens.intrinsics().cx;
  view.width = at(seen.right) - at(seen.left);
  view.bearing_by_px = std::abs(1 / (view.magnification * radius / (1 - share)));
}

// Computes vertical angles, from the ends and the taper.
void find_climb(const EtalonObservation& seen, const Lens& lens, EtalonView& view) {
  const double v = 0.5 * (*seen.upper_edge + *seen.lower_edge);
  view.height = v - lens.intrinsics().cy;
  const auto ray = lens.unproject({seen.middle(v), v});
  view.drop = ray ? std::atan(ray->y()) : 0;
  view.taper = seen.width_above - seen.width_below;
  // Widths are inverse to depths; the ends of the measured part, 4/5 of the height, differ in depth by 2 y
  // sin(climb).
  const double part = 0.8 * (*seen.lower_edge - *seen.upper_edge) / view.magnification;
  const double relative = view.taper / (0.5 * (seen.width_above + seen.width_below));
  view.climb = std::asin(std::clamp(relative * view.distance / part, -0.9, 0.9));
  view.climb_by_px = view.distance / part / view.width;
}

}  // namespace

std::optional<Eigen::Vector2d> dark_centroid(const Image<std::uint8_t>& picture) {
  EtalonView view;
  find_centroid(picture.channels() == 1 ? picture : gray_picture(picture), view);
  return view.centroid;
}

EtalonView view_etalon(const Image<std::uint8_t>& picture, const Intrinsics& intrinsics, double radius) {
  EtalonView view;
  const Image<std::uint8_t> gray = picture.channels() == 1 ? picture : gray_picture(picture);
  find_centroid(gray, view);
  EtalonObservation& seen = view.observation = find_etalon(picture, gray);
  if (!seen.reason.empty()) {
    view.reason = seen.reason;
  } else if (seen.touches_border) {
    view.reason = "the picture's border cuts the cylinder";
  } else if (!seen.upper_edge || !seen.lower_edge) {
    view.reason = "the cylinder's ends are not visible";
  } else if (seen.lines.empty()) {
    view.reason = picture.channels() == 3
                      ? "no red line is visible on the cylinder"
                      : "no red line is visible on the cylinder: gray pictures hardly show red lines";
  }
  if (!view.reason.empty()) return view;
  const double middle = seen.middle(seen.middle_row);
  const auto line = std::ranges::min_element(
      seen.lines, {}, [&](const UprightLine& one) { return std::abs(one.at - middle); });
  const Lens lens(intrinsics);
  find_bearing(seen, *line, lens, radius, view);
  find_climb(seen, lens, view);
  view.roll = std::atan(0.5 * (seen.left.slope + seen.right.slope));
  return view;
}

}  // namespace flexura
