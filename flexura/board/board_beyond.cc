#include "flexura/board/board_beyond.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace flexura {
namespace {

using Eigen::Vector2d;
using Line = std::vector<Vector2d>;

// The three outermost lines of points at one side of a board, from the border inwards.
using Side = std::array<Line, 3>;

std::vector<Side> sides_of(const BoardTarget& board, const std::vector<Vector2d>& pixels) {
  const auto at = [&](int column, int row) {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(board.columns) +
                  static_cast<std::size_t>(column)];
  };
  std::vector<Side> sides;
  for (const bool is_last : {false, true}) {
    Side columns, rows;
    for (int k = 0; k < 3; ++k) {
      const auto line = static_cast<std::size_t>(k);
      for (int row = 0; row < board.rows; ++row)
        columns[line].push_back(at(is_last ? board.columns - 1 - k : k, row));
      for (int column = 0; column < board.columns; ++column)
        rows[line].push_back(at(column, is_last ? board.rows - 1 - k : k));
    }
    sides.push_back(columns), sides.push_back(rows);
  }
  return sides;
}

// Returns the line that the parabola through a side's lines predicts this many steps inwards.
Line line_at(const Side& side, double inwards) {
  const double first = 0.5 * (inwards - 1) * (inwards - 2), second = inwards * (2 - inwards),
               third = 0.5 * inwards * (inwards - 1);
  Line line;
  for (std::size_t i = 0; i < side[0].size(); ++i)
    line.emplace_back(first * side[0][i] + second * side[1][i] + third * side[2][i]);
  return line;
}

// Returns the mean brightness around a position; empty outside the picture.
std::optional<double> brightness(const Image<std::uint8_t>& gray, const Vector2d& pixel) {
  const bool is_inside =
      pixel.x() >= 1 && pixel.y() >= 1 && pixel.x() <= gray.width() - 2 && pixel.y() <= gray.height() - 2;
  if (!is_inside) return std::nullopt;
  const int u = static_cast<int>(std::lround(pixel.x())), v = static_cast<int>(std::lround(pixel.y()));
  double sum = 0;
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du) sum += gray.at(u + du, v + dv);
  return sum / 9;
}

// Returns the brightness at the positions of a line where the pattern alternates: between the points of a
// chessboard; at circles and between them. Empty unless the picture shows all of them.
std::vector<double> pattern_along(const Image<std::uint8_t>& gray, BoardPattern pattern, const Line& line) {
  std::vector<double> values;
  for (std::size_t i = 0; i < line.size(); ++i) {
    std::vector<Vector2d> places;
    if (pattern != BoardPattern::chessboard) places.push_back(line[i]);
    if (i > 0) places.emplace_back(0.5 * (line[i] + line[i - 1]));
    for (const Vector2d& place : places) {
      const auto value = brightness(gray, place);
      if (!value) return {};
      values.push_back(*value);
    }
  }
  return values;
}

bool goes_on(const Image<std::uint8_t>& gray, BoardPattern pattern, const Side& side) {
  // On a chessboard, corresponding squares are two lines apart: those between the outermost points, and those
  // beyond the squares that every board has around these points. Of the latter only the near part is used, as
  // a board's outermost squares are often cut. For circles it is the next line.
  const bool is_chessboard = pattern == BoardPattern::chessboard;
  const auto inside = pattern_along(gray, pattern, line_at(side, is_chessboard ? 0.5 : 0)),
             beyond = pattern_along(gray, pattern, line_at(side, is_chessboard ? -1.25 : -1));
  if (inside.empty() || beyond.empty()) return false;
  double middle = 0;
  for (const double value : inside) middle += value / static_cast<double>(inside.size());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  struct Contrast {
    double least_bright = infinity, most_dark = -infinity;
    void add(double value, bool is_bright) {
      double& bound = is_bright ? least_bright : most_dark;
      bound = is_bright ? std::min(bound, value) : std::max(bound, value);
    }
    [[nodiscard]] double value() const { return least_bright - most_dark; }
  };
  Contrast here, there;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    here.add(inside[i], inside[i] > middle);
    there.add(beyond[i], inside[i] > middle);
  }
  // On the boards of opencv-doc, parts have a contrast ratio of 0.8 and more, whole boards of 0.1 and less.
  return there.value() > 0.5 * here.value();
}

}  // namespace

bool goes_on(const Image<std::uint8_t>& gray, const BoardTarget& board,
             const std::vector<Eigen::Vector2d>& pixels) {
  if (board.pattern == BoardPattern::asymmetric_circles) return false;
  return std::ranges::any_of(sides_of(board, pixels),
                             [&](const Side& side) { return goes_on(gray, board.pattern, side); });
}

}  // namespace flexura
