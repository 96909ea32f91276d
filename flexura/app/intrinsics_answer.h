#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/app/intrinsics_pictures.h"
#include "flexura/base/node.h"
#include "flexura/board/board_target.h"
#include "flexura/board/intrinsics_fit.h"

namespace flexura {

// The parts of the answer that `flexura intrinsics` prints (docs/intrinsics.md).

[[nodiscard]] Node board_node(const BoardTarget& board);

/// Returns one camera's parameters with their standard deviations and covariance, and the results for each of
/// its pictures. `distortion` is the number of fitted distortion coefficients; empty: all of the lens model.
[[nodiscard]] Node camera_node(const std::string& name, const BoardPictures& pictures,
                               const IntrinsicsFit& fit, std::size_t camera,
                               std::optional<std::int64_t> distortion);

/// Returns the results of all compared lens models, and which one was chosen.
[[nodiscard]] Node models_node(const LensComparison& lenses);

/// Returns the pose of the second camera relative to the first.
[[nodiscard]] Node pair_node(const IntrinsicsFit& fit);

/// Returns notes on pictures that fit badly and parameters that the pictures do not determine.
[[nodiscard]] std::vector<std::string> notes_of(const std::vector<BoardPictures>& cameras,
                                                const IntrinsicsFit& fit);

/// Adds the results of the views that were excluded from the fit, if there are any.
void add_held_out(const IntrinsicsFit& fit, Node::Table& answer);

}  // namespace flexura
