#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "flexura/render/ray_field.h"
#include "flexura/render/stage.h"
#include "flexura/render/tracer.h"

namespace flexura {

/// Which primitives may be seen, or have a border, in which part of the image: squares of 16 x 16 px.
class Tiles {
 public:
  static constexpr int size = 16;

  /// Sorts the stage's primitives into the tiles. Its vectors are used again from call to call.
  void build(const Stage& stage, const RayField& rays);

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  /// Those of tile (column, row), in the stage's order.
  [[nodiscard]] std::span<const Part> parts(int column, int row) const {
    const auto tile =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    return std::span(parts_).subspan(starts_[tile], starts_[tile + 1] - starts_[tile]);
  }
  /// All primitives.
  [[nodiscard]] std::span<const Part> all_parts() const { return all_; }

 private:
  int columns_ = 0, rows_ = 0;
  std::vector<Part> all_, parts_;
  std::vector<std::size_t> starts_;
  // The primitives near each block of 4 x 4 tiles in the current row of blocks.
  std::vector<std::vector<Part>> block_parts_;
};

}  // namespace flexura
