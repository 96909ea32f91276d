#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "flexura/app/intrinsics.h"
#include "flexura/base/progress.h"
#include "flexura/board/board_finder.h"
#include "flexura/board/board_target.h"
#include "flexura/board/intrinsics_fit.h"
#include "flexura/board/lens_comparison.h"
#include "flexura/camera/distortion.h"

namespace flexura {

/// One camera's pictures of a board. All pictures have the same size.
struct BoardPictures {
  std::vector<std::string> names;
  std::vector<BoardObservation> observations;
  std::array<int, 2> size = {0, 0};  ///< Width and height, px.
  std::vector<int> orientations;     ///< Orientation stated in each file, from 1 to 8 (EXIF); 1: not turned.
};

/// Pictures at one position of a zoom.
struct ZoomGroup {
  std::optional<double> ratio, count;
  std::string folder;
};

/// Reads pictures and detects the board in each of them. Throws InputError for fewer than two pictures, for
/// unreadable pictures, and for pictures of different sizes. Also throws InputError if most of the pictures
/// show a board with more points than `board`.
[[nodiscard]] BoardPictures look_for_board(const std::vector<std::string>& files, const BoardTarget& board,
                                           const std::string& option, Progress& progress);

/// Parses the values of `--zoom`, in the order given. Throws InputError for malformed values, and if only
/// some of the groups have ratios (or counts).
[[nodiscard]] std::vector<ZoomGroup> zoom_groups(const std::vector<std::string>& zooms);

/// Returns the picture files in a folder, sorted by name. Throws InputError if the path is not a folder.
[[nodiscard]] std::vector<std::string> pictures_in(const std::string& folder);

/// Returns the lens model of `--lens`; empty for "best". Throws InputError for an unknown one.
[[nodiscard]] std::optional<LensModel> lens_model_of(const IntrinsicsArguments& arguments);

/// Calibrates one camera, or two cameras whose pictures with equal index were taken at the same time. Throws
/// InputError if a picture is given twice. Requires a lens model, not "best".
[[nodiscard]] IntrinsicsFit fit_pictures(const IntrinsicsArguments& arguments, const BoardTarget& board,
                                         const std::vector<BoardPictures>& pictures);
/// As fit_pictures(), with each lens model for `--lens best`; otherwise the result has one trial.
[[nodiscard]] LensComparison compare_pictures(const IntrinsicsArguments& arguments, const BoardTarget& board,
                                              const std::vector<BoardPictures>& pictures);

}  // namespace flexura
