#include "flexura/app/board.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <ostream>

#include "flexura/app/commands.h"
#include "flexura/base/names.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/board/board_drawing.h"
#include "flexura/store/text_file.h"

namespace flexura {
namespace {

struct Paper {
  const char* name;
  double shorter, longer;  // m
};
constexpr std::array<Paper, 3> papers = {
    {{"a4", 0.210, 0.297}, {"a3", 0.297, 0.420}, {"letter", 0.2159, 0.2794}}};

// Returns the border that the search for the board needs, m.
double border_of(const BoardTarget& board) {
  return board.pattern == BoardPattern::apriltags ? board.square - board.marker : 0.5 * board.square;
}

BoardSheet sheet_of(const DrawBoardArguments& arguments, const BoardTarget& board,
                    const BoardDrawing& drawing) {
  const Eigen::Vector2d size = drawing.high - drawing.low;
  const Eigen::Vector2d whole = size.array() + 2 * border_of(board);
  if (arguments.paper == "fit") {
    constexpr double margin = 0.01;  // m, for the caption.
    return {.width = whole.x() + 2 * margin, .height = whole.y() + 2 * margin, .caption = {}};
  }
  const auto* const paper =
      std::ranges::find_if(papers, [&](const Paper& one) { return arguments.paper == one.name; });
  if (paper == papers.end())
    throw input_error("--paper", text_node(arguments.paper).brief() + ": expected a4, a3, letter or fit");
  const bool is_wide = whole.x() > whole.y();
  const BoardSheet sheet{.width = is_wide ? paper->longer : paper->shorter,
                         .height = is_wide ? paper->shorter : paper->longer,
                         .caption = {}};
  if (whole.x() > sheet.width || whole.y() > sheet.height)
    throw input_error(
        "--paper",
        fmt::format("the board needs {:.0f} x {:.0f} mm with its white border, but {} has {:.0f} x {:.0f} "
                    "mm: expected a smaller --square, or --paper fit",
                    1000 * whole.x(), 1000 * whole.y(), arguments.paper, 1000 * sheet.width,
                    1000 * sheet.height));
  return sheet;
}

// Returns the options that describe the board to `flexura intrinsics`.
std::string options_of(const BoardTarget& board) {
  std::string text = fmt::format("--board {}x{} --square {:g}", board.columns, board.rows, board.square);
  if (board.pattern != BoardPattern::chessboard) text += fmt::format(" --pattern {}", name_of(board.pattern));
  if (board.has_markers())
    text += fmt::format(" --marker {:g} --family {}", board.marker, name_of(board.family));
  return text;
}

}  // namespace

int board_command(const DrawBoardArguments& arguments, std::ostream& out) {
  const BoardTarget board = board_of(arguments);
  const std::string extension = std::filesystem::path(arguments.out).extension().string();
  if (extension != ".svg" && extension != ".pdf")
    throw input_error("--out",
                      text_node(arguments.out).brief() + ": expected a file name that ends in .svg or .pdf");
  const BoardDrawing drawing = draw_board(board);
  BoardSheet sheet = sheet_of(arguments, board, drawing);
  sheet.caption = "print at 100 %, measure the squares: " + options_of(board);
  write_new_file(arguments.out, extension == ".svg" ? svg_of(drawing, sheet) : pdf_of(drawing, sheet));
  out << fmt::format("board: {}, {:g} x {:g} mm\n", arguments.out, 1000 * sheet.width, 1000 * sheet.height)
      << fmt::format("calibrate: flexura intrinsics IMAGE... {}\n", options_of(board));
  return exit_done;
}

}  // namespace flexura
