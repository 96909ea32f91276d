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

namespace flexura {

/// One camera's pictures of a board, all of one size.
struct BoardPictures {
  std::vector<std::string> names;
  std::vector<BoardObservation> observations;
  std::array<int, 2> size = {0, 0};  ///< px
};

/// Pictures at one position of a zoom.
struct ZoomGroup {
  std::optional<double> ratio, count;
  std::string folder;
};

/// The board that the command is told. InputError for none that can be found.
[[nodiscard]] BoardTarget board_of(const IntrinsicsArguments& arguments);

/// Reads pictures and looks for the board in each. InputError: fewer than two, one that cannot be read, sizes
/// that differ, more parts of a larger board than boards of this size.
[[nodiscard]] BoardPictures look_for_board(const std::vector<std::string>& files, const BoardTarget& board,
                                           const std::string& option, Progress& progress);

/// What `--zoom` says, in the order given. InputError for what is none, and for groups of which some have
/// ratios (or counts) and others not.
[[nodiscard]] std::vector<ZoomGroup> zoom_groups(const std::vector<std::string>& zooms);

/// The picture files in a folder, by name. InputError when it is none.
[[nodiscard]] std::vector<std::string> pictures_in(const std::string& folder);

/// Calibrates cameras whose pictures belong together one by one. InputError: a picture given twice.
[[nodiscard]] IntrinsicsFit fit_pictures(const IntrinsicsArguments& arguments, const BoardTarget& board,
                                         const std::vector<BoardPictures>& pictures);

}  // namespace flexura
