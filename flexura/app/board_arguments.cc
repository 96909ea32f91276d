#include "flexura/app/board_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

#include "flexura/base/names.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"

namespace flexura {
namespace {

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Returns the value of an enumeration with this name.
template <class Enum>
Enum named(const std::string& option, const std::string& text) {
  const std::vector<std::string>& names = names_of(static_cast<const Enum*>(nullptr));
  const auto found = std::ranges::find(names, text);
  if (found == names.end())
    throw input_error(option, fmt::format("{}: expected one of \"{}\"", text_node(text).brief(),
                                          fmt::join(names, "\", \"")));
  return static_cast<Enum>(found - names.begin());
}

void add_markers(const BoardArguments& arguments, BoardTarget& board) {
  if (!board.has_markers()) {
    if (arguments.marker != 0)
      throw input_error("--marker",
                        "only boards with markers have one: expected --pattern charuco or apriltags");
    if (!arguments.family.empty())
      throw input_error("--family",
                        "only boards with markers have one: expected --pattern charuco or apriltags");
    return;
  }
  board.family =
      board.pattern == BoardPattern::charuco ? FiducialFamily::aruco_4x4 : FiducialFamily::apriltag_36h11;
  if (!arguments.family.empty()) board.family = named<FiducialFamily>("--family", arguments.family);
  const bool is_smaller = arguments.marker > 0 && arguments.marker < board.square;
  if (!is_smaller)
    throw input_error("--marker", fmt::format("{} m: expected the side of a marker with its black border, "
                                              "above 0 and below --square {:g}",
                                              arguments.marker, board.square));
  board.marker = arguments.marker;
  if (board.markers() > count_of(board.family))
    throw input_error("--board", fmt::format("{}: the board has {} markers, but the family {} has only {}",
                                             text_node(arguments.board).brief(), board.markers(),
                                             name_of(board.family), count_of(board.family)));
}

}  // namespace

BoardTarget board_of(const BoardArguments& arguments) {
  constexpr int most = 50;
  BoardTarget board;
  board.pattern = named<BoardPattern>("--pattern", arguments.pattern);
  // A picture need not show all of a board with markers.
  const int least = board.has_markers() ? 2 : 3;
  const std::size_t cross = arguments.board.find('x');
  const std::string_view text = arguments.board;
  const auto columns = whole_number(text.substr(0, cross));
  const auto rows = cross == std::string::npos ? std::nullopt : whole_number(text.substr(cross + 1));
  const auto is_size = [&](const std::optional<int>& n) { return n && *n >= least && *n <= most; };
  if (!is_size(columns) || !is_size(rows))
    throw input_error(
        "--board",
        fmt::format("{}: expected COLUMNSxROWS of {}, each from {} to {}", text_node(arguments.board).brief(),
                    board.pattern == BoardPattern::apriltags ? "markers" : "inner corners (or circles)",
                    least, most));
  board.columns = *columns, board.rows = *rows;
  constexpr double smallest = 1e-6, largest = 1000;  // m
  const bool is_a_side = arguments.square >= smallest && arguments.square <= largest;
  if (!is_a_side)
    throw input_error("--square", fmt::format("{} m: expected a number from {} to {}", arguments.square,
                                              smallest, largest));
  board.square = arguments.square;
  add_markers(arguments, board);
  return board;
}

}  // namespace flexura
