#include "flexura/board/fiducial_finder.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

namespace flexura {
namespace {

using Eigen::Vector2d;

constexpr int cell_pixels = 8;  // Of a marker that is brought upright.

// Twice the signed area of a quadrilateral: positive for clockwise corners, as v points down.
double doubled_area(const Quad& quad) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d &a = quad[i], &b = quad[(i + 1) % 4];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

// Returns the value between pixels; the nearest border value outside.
double value_at(const cv::Mat& gray, const Vector2d& pixel) {
  const double u = std::clamp(pixel.x(), 0.0, gray.cols - 1.0),
               v = std::clamp(pixel.y(), 0.0, gray.rows - 1.0);
  const int left = std::min(static_cast<int>(u), gray.cols - 2),
            top = std::min(static_cast<int>(v), gray.rows - 2);
  const double fu = u - left, fv = v - top;
  const auto at = [&](int du, int dv) {
    return static_cast<double>(gray.at<std::uint8_t>(top + dv, left + du));
  };
  return (1 - fv) * ((1 - fu) * at(0, 0) + fu * at(1, 0)) + fv * ((1 - fu) * at(0, 1) + fu * at(1, 1));
}

// A straight line: a point and a unit direction.
struct EdgeLine {
  Vector2d point, direction;
};

std::optional<Vector2d> intersection(const EdgeLine& one, const EdgeLine& other) {
  Eigen::Matrix2d both;
  both << one.direction, -other.direction;
  constexpr double parallel = 0.1;
  if (std::abs(both.determinant()) < parallel) return std::nullopt;
  return one.point + (both.inverse() * (other.point - one.point))[0] * one.direction;
}

// Returns the position of the step from dark (inside) to bright along a line across a side, in px from the
// side, outwards: searched within `reach`, and measured in a window of `half` px to both sides.
std::optional<double> step_across(const cv::Mat& gray, const Vector2d& from, const Vector2d& outwards,
                                  double reach, double half) {
  constexpr double spacing = 0.5, least_step = 8;  // px; of 255
  double largest = 0, steepest = 0;
  for (double at = -reach; at <= reach; at += spacing) {
    const double step =
        value_at(gray, from + (at + spacing) * outwards) - value_at(gray, from + (at - spacing) * outwards);
    if (step > largest) largest = step, steepest = at;
  }
  if (largest < least_step) return std::nullopt;
  // The area below the step determines its place, independently of blur and of the places of pixels.
  constexpr double fine = 0.25;  // px
  const int count = static_cast<int>(2 * half / fine);
  std::array<double, 64> values{};
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    values[static_cast<std::size_t>(i)] =
        value_at(gray, from + (steepest - half + (i + 0.5) * fine) * outwards);
    sum += values[static_cast<std::size_t>(i)];
  }
  const auto last = static_cast<std::size_t>(count) - 1;
  const double dark = 0.5 * (values[0] + values[1]), bright = 0.5 * (values[last - 1] + values[last]);
  if (bright - dark < least_step) return std::nullopt;
  return steepest - half + fine * (count * bright - sum) / (bright - dark);
}

// Fits a straight line to the edge near a side from `a` to `b`.
std::optional<EdgeLine> edge_line(const cv::Mat& gray, const Vector2d& a, const Vector2d& b, double reach) {
  const Vector2d along = (b - a).normalized(), outwards(along.y(), -along.x());
  const double length = (b - a).norm();
  // Without the parts next to the corners, which blur rounds and other black squares may touch.
  constexpr double share = 0.15;
  constexpr int least = 4, most = 60;
  const int count = std::clamp(static_cast<int>((1 - 2 * share) * length), least, most);
  // Within the border, which is an eighth of the side or more, and the white around the marker.
  const double half = std::clamp(0.4 * length / 8, 1.25, 3.0);
  std::vector<Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const Vector2d from = a + (share + (1 - 2 * share) * (i + 0.5) / count) * (b - a);
    if (const auto off = step_across(gray, from, outwards, reach, half))
      points.emplace_back(from + *off * outwards);
  }
  if (2 * static_cast<int>(points.size()) < count) return std::nullopt;
  EdgeLine line{a, along};
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    Vector2d middle = Vector2d::Zero();
    for (const Vector2d& point : points) middle += point / static_cast<double>(points.size());
    Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
    for (const Vector2d& point : points) scatter += (point - middle) * (point - middle).transpose();
    const double angle = 0.5 * std::atan2(2 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));
    line = {middle, {std::cos(angle), std::sin(angle)}};
    // Stray edges, such as those of a shadow.
    double squares = 0;
    const auto off = [&](const Vector2d& point) {
      return (point - middle).x() * line.direction.y() - (point - middle).y() * line.direction.x();
    };
    for (const Vector2d& point : points) squares += off(point) * off(point);
    const double far = 2.5 * std::sqrt(squares / static_cast<double>(points.size())) + 1e-3;
    std::vector<Vector2d> kept;
    std::ranges::copy_if(points, std::back_inserter(kept),
                         [&](const Vector2d& p) { return std::abs(off(p)) <= far; });
    if (kept.size() == points.size() || kept.size() < 2) break;
    points = std::move(kept);
  }
  return line;
}

// Returns the cells of a quadrilateral, or nothing if its border is not black.
std::optional<std::uint64_t> cells_in(const cv::Mat& gray, const Quad& quad, int side) {
  const int cells = side + 2, size = cells * cell_pixels;
  std::array<cv::Point2f, 4> from;
  for (std::size_t i = 0; i < 4; ++i)
    from[i] = {static_cast<float>(quad[i].x()), static_cast<float>(quad[i].y())};
  const auto last = static_cast<float>(size) - 0.5F;
  const std::array<cv::Point2f, 4> to = {
      cv::Point2f{-0.5F, -0.5F}, {last, -0.5F}, {last, last}, {-0.5F, last}};
  cv::Mat upright, binary;
  cv::warpPerspective(gray, upright, cv::getPerspectiveTransform(from.data(), to.data()), {size, size});
  double low = 0, high = 0;
  cv::minMaxLoc(upright, &low, &high);
  constexpr double least_contrast = 20;
  if (high - low < least_contrast) return std::nullopt;
  cv::threshold(upright, binary, 0, 1, cv::THRESH_BINARY | cv::THRESH_OTSU);
  std::uint64_t code = 0;
  int wrong = 0;
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      // Without the cell's border, whose place is uncertain.
      constexpr int margin = 2, inner = cell_pixels - 2 * margin;
      const cv::Rect cell(column * cell_pixels + margin, row * cell_pixels + margin, inner, inner);
      const bool is_white = 2 * cv::countNonZero(binary(cell)) > inner * inner;
      const bool is_border = row == 0 || column == 0 || row == cells - 1 || column == cells - 1;
      if (is_border) {
        wrong += is_white ? 1 : 0;
      } else {
        code = code << 1U | (is_white ? 1U : 0U);
      }
    }
  }
  constexpr int most_wrong = 1;
  if (wrong > most_wrong) return std::nullopt;
  return code;
}

// Appends the dark quadrilaterals of a thresholded picture. `shrunk`: px by which they are too small on each
// side.
void append_quads(const cv::Mat& dark, double shortest, double shrunk, std::vector<Quad>& quads) {
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(dark, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  for (const auto& outline : outlines) {
    const auto length = static_cast<double>(outline.size());
    if (length < 4 * shortest) continue;
    std::vector<cv::Point> corners;
    constexpr double tolerance = 0.04;
    cv::approxPolyDP(outline, corners, tolerance * length, true);
    if (corners.size() != 4 || !cv::isContourConvex(corners)) continue;
    Quad quad;
    for (std::size_t i = 0; i < 4; ++i) quad[i] = {corners[i].x, corners[i].y};
    if (doubled_area(quad) < 0) std::swap(quad[1], quad[3]);
    double least = length;
    for (std::size_t i = 0; i < 4; ++i) least = std::min(least, (quad[i] - quad[(i + 1) % 4]).norm());
    if (least < 0.8 * shortest) continue;
    const Vector2d middle = 0.25 * (quad[0] + quad[1] + quad[2] + quad[3]);
    // Contours run through the middles of the outermost pixels.
    for (Vector2d& corner : quad)
      corner += (shrunk + 0.5) * std::numbers::sqrt2 * (corner - middle).normalized();
    quads.push_back(quad);
  }
}

std::vector<Quad> quads_in(const cv::Mat& gray, int side) {
  std::vector<Quad> quads;
  constexpr double least_cell = 1.5;  // px
  const double shortest = least_cell * (side + 2);
  const int smaller = std::min(gray.cols, gray.rows);
  for (const int part : {64, 24, 8}) {
    const int block = std::max(5, smaller / part | 1);
    if (block >= smaller) continue;
    cv::Mat dark, thin;
    constexpr double below = 7;  // Of 255: noise of even areas is no edge.
    cv::adaptiveThreshold(gray, dark, 255, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY_INV, block, below);
    append_quads(dark, shortest, 0, quads);
    // Markers whose corners touch other black squares.
    cv::erode(dark, thin, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
    append_quads(thin, shortest, 1, quads);
  }
  return quads;
}

// A marker and the distance of its corners from those of the outline.
bool is_same(const Quad& one, const Quad& other) {
  double most = 0, length = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    most = std::max(most, (one[i] - other[i]).norm());
    length = std::max(length, (one[i] - one[(i + 1) % 4]).norm());
  }
  return most < 0.2 * length;
}

}  // namespace

bool refine_quad(const cv::Mat& gray, double reach, Quad& corners) {
  // Near a wrong corner the first pass also takes other edges. The second pass begins on the right ones.
  for (int pass = 0; pass < 2; ++pass) {
    std::array<EdgeLine, 4> lines;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto line = edge_line(gray, corners[i], corners[(i + 1) % 4], reach);
      if (!line) return false;
      lines[i] = *line;
    }
    Quad refined;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto corner = intersection(lines[(i + 3) % 4], lines[i]);
      if (!corner || (*corner - corners[i]).norm() > 3 * reach) return false;
      refined[i] = *corner;
    }
    corners = refined;
  }
  return true;
}

std::vector<FoundFiducial> find_fiducials(const cv::Mat& gray, FiducialFamily family, int count) {
  const int side = side_of(family);
  std::map<int, std::vector<Quad>> found;
  for (const Quad& rough : quads_in(gray, side)) {
    const auto cells = cells_in(gray, rough, side);
    const auto match = cells ? match_fiducial(family, *cells, count) : std::nullopt;
    if (!match) continue;
    Quad quad;
    for (std::size_t i = 0; i < 4; ++i) quad[i] = rough[(i + 4 - static_cast<std::size_t>(match->turns)) % 4];
    // Other thresholds find the same marker again.
    constexpr double reach = 3;  // px
    if (!refine_quad(gray, reach, quad)) continue;
    std::vector<Quad>& same = found[match->id];
    if (std::ranges::none_of(same, [&](const Quad& other) { return is_same(quad, other); }))
      same.push_back(quad);
  }
  std::vector<FoundFiducial> result;
  for (const auto& [id, quads] : found)
    if (quads.size() == 1) result.push_back({id, quads.front()});
  return result;
}

}  // namespace flexura
