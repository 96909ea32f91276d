#pragma once

#include <string>

#include "flexura/board/board_target.h"

namespace flexura {

/// Description of a calibration board on the command line.
struct BoardArguments {
  std::string board;  ///< Board size in points, or in markers of `apriltags`: COLUMNSxROWS.
  double square = 0;  ///< Side of a square, or distance between rows, m.
  std::string pattern = "chessboard";
  double marker = 0;   ///< Side of the markers, m; only for boards with markers. 0: not given.
  std::string family;  ///< Family of the markers; "": the usual one of the pattern.
};

/// Returns the board that the arguments describe. Throws InputError for a board that cannot be detected.
[[nodiscard]] BoardTarget board_of(const BoardArguments& arguments);

}  // namespace flexura
