#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace flexura {

/// Arguments of `flexura intrinsics`.
struct IntrinsicsArguments {
  std::vector<std::string> images;       ///< Pictures of one camera; or
  std::vector<std::string> left, right;  ///< of two cameras, taken at the same times; or
  /// folders of one camera at several zooms: RATIO[@COUNT]=FOLDER or @COUNT=FOLDER.
  std::vector<std::string> zooms;
  std::string board;  ///< Board size in points: COLUMNSxROWS.
  double square = 0;  ///< Side of a square, m.
  std::string pattern = "chessboard";
  std::int64_t distortion = 5;           ///< Number of distortion coefficients to fit, of k1, k2, p1, p2, k3.
  std::optional<std::int64_t> hold_out;  ///< If N, every Nth view is held out of the fit.
  std::vector<std::string> names;        ///< Camera names.
  std::vector<double> position;          ///< p_WC of the first camera, m: three numbers; empty: the origin.
  std::vector<double> rotation;  ///< R_WC of the first camera as (w, x, y, z); empty: the world's axes.
  std::string out;               ///< File of measured cameras to write; "": no file.
  std::string rig;               ///< File for experiments to include; "": no file.
  std::string rig_from;          ///< Experiment whose cameras the rig file takes; "": no experiment.
  bool json = false;             ///< Print one JSON document with everything, not a table.
};

/// Calibrates cameras from pictures of a board and prints the result as a table, or with `json` as one JSON
/// document (docs/intrinsics.md). Shows its progress on `err`. Returns exit_missed if the pictures do not
/// determine the cameras. Throws InputError for bad input, and std::runtime_error if the system refuses a
/// file.
int intrinsics_command(const IntrinsicsArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace flexura
