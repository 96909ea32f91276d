#include "flexura/app/intrinsics_units.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "flexura/math/median.h"

namespace flexura {
namespace {

// Returns the name and size of the unit in which a length of this many metres was probably given.
struct LengthUnit {
  const char* name;
  double factor;  // Divide by it to get metres.
};
LengthUnit probable_unit(double length, double usual) {
  return length / 1000 > 0.1 * usual ? LengthUnit{"mm", 1000} : LengthUnit{"cm", 100};
}

}  // namespace

std::vector<std::string> unit_notes(const IntrinsicsArguments& arguments, const BoardTarget& board,
                                    const IntrinsicsFit& fit) {
  constexpr double largest_board = 3, usual_board = 0.3, farthest = 100;  // m, m, distances of the boards
  std::vector<std::string> notes;
  std::vector<double> distances;
  for (const std::optional<Pose>& pose : fit.boards)
    if (pose) distances.push_back(pose->position.norm());
  if (distances.empty()) return notes;
  const double distance = median(std::span(distances));
  const double width = board.square * std::max(board.columns, board.rows);
  if (width > largest_board) {
    const LengthUnit unit = probable_unit(width, usual_board);
    notes.push_back(
        fmt::format("with --square {:.4g} m the board is {:.3g} m wide and {:.3g} m from the camera: if the "
                    "number is in {}, divide it by {:g}: --square {:.4g}",
                    board.square, width, distance, unit.name, unit.factor, board.square / unit.factor));
  }
  if (arguments.position.size() == 3) {
    const double far = Eigen::Vector3d(arguments.position.data()).norm();
    if (far > farthest * distance) {
      const LengthUnit unit = probable_unit(far, 10 * distance);
      notes.push_back(fmt::format(
          "--position is {:.4g} m from the origin, but the boards are {:.3g} m from the camera: if "
          "its numbers are in {}, divide them by {:g}",
          far, distance, unit.name, unit.factor));
    }
  }
  return notes;
}

}  // namespace flexura
