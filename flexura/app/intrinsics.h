#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "flexura/app/board_arguments.h"

namespace flexura {

/// Arguments of `flexura intrinsics`.
struct IntrinsicsArguments : BoardArguments {
  std::vector<std::string>
      images;  ///< Pictures of one camera. Either `images`, or `left` and `right`, or `zooms` are given.
  std::vector<std::string> left, right;  ///< Pictures of two cameras, taken at the same times.
  /// Folders of pictures of one camera at several zooms: RATIO[@COUNT]=FOLDER or @COUNT=FOLDER.
  std::vector<std::string> zooms;
  std::string lens = "brown";  ///< Lens model, or "best": the one that explains the pictures best.
  std::optional<std::int64_t>
      distortion;  ///< Number of distortion coefficients to fit; empty: all of the lens model.
  std::optional<std::int64_t>
      hold_out;  ///< N: every Nth view is excluded from the fit and tests it; empty: no view is excluded.
  std::vector<std::string> names;  ///< Camera names.
  std::vector<double> position;    ///< p_WC of the first camera, m: three numbers; empty: the origin.
  std::vector<double> rotation;    ///< Quaternion (w, x, y, z) of R_WC of the first camera; empty: identity.
  std::string out;                 ///< File of measured cameras to write; "": no file.
  std::string rig;                 ///< Rig file to write, which experiments can include; "": no file.
  std::string rig_from;  ///< Experiment whose cameras are copied into the rig file; "": no experiment.
  bool json = false;     ///< Whether to print one JSON document with all results instead of a table.
};

/// Calibrates cameras from pictures of a board and prints the result as a table, or with `json` as one JSON
/// document (docs/intrinsics.md). Shows its progress on `err`. Returns exit_missed if the pictures do not
/// determine the cameras. Throws InputError for bad input, and std::runtime_error if a file cannot be
/// written.
int intrinsics_command(const IntrinsicsArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace flexura
