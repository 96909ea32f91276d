#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flexura/app/intrinsics_pictures.h"
#include "flexura/base/node.h"
#include "flexura/board/board_target.h"
#include "flexura/board/intrinsics_fit.h"

namespace flexura {

// What `flexura intrinsics` prints (docs/intrinsics.md), part by part.

[[nodiscard]] Node board_node(const BoardTarget& board);

/// One camera: its numbers with standard deviations and covariance, and each of its pictures.
[[nodiscard]] Node camera_node(const std::string& name, const BoardPictures& pictures,
                               const IntrinsicsFit& fit, std::size_t camera, int distortion);

/// Where the second camera stands in the first.
[[nodiscard]] Node pair_node(const IntrinsicsFit& fit);

/// What else there is to know: pictures that fit badly, numbers that the pictures do not tell.
[[nodiscard]] std::vector<std::string> notes_of(const std::vector<BoardPictures>& cameras,
                                                const IntrinsicsFit& fit);

/// Adds what became of held-out views, if there are any.
void add_held_out(const IntrinsicsFit& fit, Node::Table& answer);

}  // namespace flexura
