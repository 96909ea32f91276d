#pragma once

#include <iosfwd>
#include <string>

#include "flexura/app/board_arguments.h"

namespace flexura {

/// Arguments of `flexura board`.
struct DrawBoardArguments : BoardArguments {
  std::string out;  ///< New file: .svg or .pdf.
  std::string paper =
      "fit";  ///< Size of the sheet: "a4", "a3", "letter", or "fit" for the board with its border.
};

/// Writes a calibration board as a file to print, and prints how to calibrate with it. Throws InputError for
/// a board that cannot be detected or does not fit on the paper, and std::runtime_error if the file cannot be
/// written.
int board_command(const DrawBoardArguments& arguments, std::ostream& out);

}  // namespace flexura
