#include "flexura/board/board_target.h"

#include <Eigen/Core>
#include <string>
#include <vector>

namespace flexura {

const std::vector<std::string>& names_of(const BoardPattern*) {
  static const std::vector<std::string> names = {"chessboard", "circles", "asymmetric-circles"};
  return names;
}

std::vector<Eigen::Vector2d> BoardTarget::points() const {
  std::vector<Eigen::Vector2d> points;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int across = pattern == BoardPattern::asymmetric_circles ? 2 * column + row % 2 : column;
      points.emplace_back(square * across, square * row);
    }
  }
  return points;
}

bool BoardTarget::is_ambiguous() const {
  switch (pattern) {
    case BoardPattern::chessboard:
      return (columns + rows) % 2 == 0;
    case BoardPattern::circles:
      return true;
    case BoardPattern::asymmetric_circles:
      return rows % 2 == 0;
  }
  return true;
}

}  // namespace flexura
