#include "flexura/board/board_target.h"

#include <Eigen/Core>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace flexura {

const std::vector<std::string>& names_of(const BoardPattern*) {
  static const std::vector<std::string> names = {"chessboard", "circles", "asymmetric-circles", "charuco",
                                                 "apriltags"};
  return names;
}

std::vector<Eigen::Vector2d> BoardTarget::points() const {
  std::vector<Eigen::Vector2d> points;
  if (pattern == BoardPattern::apriltags) {
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const Eigen::Vector2d corner(square * column, square * row);
        for (const Eigen::Vector2d& step : {Eigen::Vector2d(0, 0), {1, 0}, {1, 1}, {0, 1}})
          points.emplace_back(corner + marker * step);
      }
    }
    return points;
  }
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int across = pattern == BoardPattern::asymmetric_circles ? 2 * column + row % 2 : column;
      points.emplace_back(square * across, square * row);
    }
  }
  return points;
}

std::vector<std::vector<std::size_t>> BoardTarget::equal_orders() const {
  const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) *
                     (pattern == BoardPattern::apriltags ? 4 : 1);
  std::vector<std::vector<std::size_t>> orders(1, std::vector<std::size_t>(count));
  std::iota(orders[0].begin(), orders[0].end(), std::size_t{0});
  if (!is_ambiguous()) return orders;
  orders.emplace_back(orders[0].rbegin(), orders[0].rend());
  if (columns != rows || pattern == BoardPattern::asymmetric_circles) return orders;
  const auto side = static_cast<std::size_t>(columns);
  std::vector<std::size_t> quarter;
  for (std::size_t row = 0; row < side; ++row)
    for (std::size_t column = 0; column < side; ++column) quarter.push_back(column * side + (side - 1 - row));
  orders.emplace_back(quarter.rbegin(), quarter.rend());
  orders.push_back(std::move(quarter));
  return orders;
}

bool BoardTarget::is_ambiguous() const {
  switch (pattern) {
    case BoardPattern::chessboard:
      return (columns + rows) % 2 == 0;
    case BoardPattern::circles:
      return true;
    case BoardPattern::asymmetric_circles:
      return rows % 2 == 0;
    case BoardPattern::charuco:
    case BoardPattern::apriltags:
      return false;
  }
  return true;
}

int BoardTarget::markers() const {
  if (pattern == BoardPattern::apriltags) return columns * rows;
  // Half of the squares, less the corner if it is black.
  return pattern == BoardPattern::charuco ? (columns + 1) * (rows + 1) / 2 : 0;
}

}  // namespace flexura
