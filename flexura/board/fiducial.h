#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flexura {

/// Families of square black-and-white markers. Each marker of a family has a number. A marker has a black
/// border, one cell wide, around a square of black and white cells.
enum class FiducialFamily { aruco_4x4, aruco_5x5, aruco_6x6, apriltag_36h11 };
const std::vector<std::string>& names_of(const FiducialFamily*);

/// Returns the number of cells in a row of a marker, without its border.
[[nodiscard]] int side_of(FiducialFamily family);
/// Returns the number of markers of a family.
[[nodiscard]] int count_of(FiducialFamily family);
/// Returns the largest number of wrong cells with which a marker is still accepted.
[[nodiscard]] int most_errors_of(FiducialFamily family);

/// Returns the cells of marker `id`, row by row: 1 for white cells, the last cell in the least significant
/// bit. `id` must be from 0 to count_of() - 1.
[[nodiscard]] std::uint64_t code_of(FiducialFamily family, int id);

/// Returns whether a cell of marker `id` is black. Rows and columns count from the upper left cell of the
/// border, from 0 to side_of() + 1.
[[nodiscard]] bool is_black_cell(FiducialFamily family, int id, int row, int column);

/// A marker that was recognised by its cells.
struct FiducialMatch {
  int id = 0;
  int turns =
      0;  ///< Number of clockwise quarter turns that bring the cells into the marker's upright orientation.
  int errors = 0;  ///< Number of wrong cells.
};

/// Recognises a marker among those with numbers below `count`, in any of four orientations. `cells` are as in
/// code_of(). Returns std::nullopt if each marker differs from `cells` in more than most_errors_of() cells.
[[nodiscard]] std::optional<FiducialMatch> match_fiducial(FiducialFamily family, std::uint64_t cells,
                                                          int count);

}  // namespace flexura
