#include "flexura/board/fiducial.h"

#include <algorithm>
#include <bit>
#include <string>
#include <vector>

namespace flexura {
namespace {

bool is_white(std::uint64_t cells, int side, int row, int column) {
  return (cells >> static_cast<unsigned>(side * side - 1 - (row * side + column)) & 1U) != 0;
}

// Returns the cells after a clockwise quarter turn.
std::uint64_t turned(std::uint64_t cells, int side) {
  std::uint64_t result = 0;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      result = result << 1U | (is_white(cells, side, side - 1 - column, row) ? 1U : 0U);
  return result;
}

}  // namespace

const std::vector<std::string>& names_of(const FiducialFamily*) {
  static const std::vector<std::string> names = {"4x4", "5x5", "6x6", "36h11"};
  return names;
}

bool is_black_cell(FiducialFamily family, int id, int row, int column) {
  const int side = side_of(family);
  if (row < 1 || column < 1 || row > side || column > side) return true;
  return !is_white(code_of(family, id), side, row - 1, column - 1);
}

std::optional<FiducialMatch> match_fiducial(FiducialFamily family, std::uint64_t cells, int count) {
  const int side = side_of(family), most = most_errors_of(family);
  std::optional<FiducialMatch> best;
  for (int turns = 0; turns < 4; ++turns, cells = turned(cells, side)) {
    for (int id = 0; id < std::min(count, count_of(family)); ++id) {
      const int errors = std::popcount(cells ^ code_of(family, id));
      if (errors <= most && (!best || errors < best->errors)) best = FiducialMatch{id, turns, errors};
    }
  }
  return best;
}

}  // namespace flexura
