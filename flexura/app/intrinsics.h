#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace flexura {

/// What `flexura intrinsics` is told.
struct IntrinsicsArguments {
  std::vector<std::string> images;       ///< Of one camera; or
  std::vector<std::string> left, right;  ///< of two, taken at the same times; or
  std::vector<std::string> zooms;  ///< of one at several zooms: RATIO[@COUNT]=FOLDER or @COUNT=FOLDER each.
  std::string board;               ///< COLUMNSxROWS of points.
  double square = 0;               ///< m
  std::string pattern = "chessboard";
  std::int64_t distortion = 5;           ///< How many of k1, k2, p1, p2, k3.
  std::optional<std::int64_t> hold_out;  ///< Every Nth view is left out of the fit.
  std::vector<std::string> names;        ///< Of the cameras.
  std::vector<double> position;          ///< p_WC of the first camera, three numbers; none: the origin.
  std::vector<double> rotation;  ///< R_WC of the first camera as (w, x, y, z); none: the world's axes.
  std::string out;               ///< A file of measured cameras to write; "" for none.
  std::string rig;               ///< A file for experiments to include; "" for none.
  std::string rig_from;          ///< An experiment whose cameras the rig file takes; "" for none.
  bool json = false;             ///< Print one JSON document with everything, not a table.
};

/// Calibrates cameras from pictures of a board and prints what is known then as a table, or with `json` as
/// one JSON document (docs/intrinsics.md). Shows its progress on `err`. Returns exit_missed when the pictures
/// do not tell it. InputError for bad input; std::runtime_error when the system refuses a file.
int intrinsics_command(const IntrinsicsArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace flexura
