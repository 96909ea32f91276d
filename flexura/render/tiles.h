#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "flexura/render/ray_field.h"
#include "flexura/render/stage.h"
#include "flexura/render/tracer.h"

namespace flexura {

/// Which primitives may be seen, or have a border, in which part of the image: squares of 16 x 16 px, each
/// looked into when it is first asked for.
class Tiles {
 public:
  static constexpr int size = 16;

  /// Forgets the frame before. Its vectors are used again from call to call; `stage` and `rays` must stay.
  void build(const Stage& stage, const RayField& rays);

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  /// Those of tile (column, row), in the stage's order.
  [[nodiscard]] std::span<const Part> parts(int column, int row) const;
  /// All primitives.
  [[nodiscard]] std::span<const Part> all_parts() const { return all_; }

 private:
  // The primitives near a square of so many tiles from (column, row) on.
  struct List {
    bool is_known = false;
    std::span<const Part> parts;
  };
  // Room for lists, which stay where they are until it is cleared.
  class Room {
   public:
    // Where to add up to so many parts.
    std::vector<Part>& with(std::size_t parts);
    void clear();

   private:
    std::vector<std::vector<Part>> chunks_;
    std::size_t current_ = 0;
  };
  std::span<const Part> fill(List& list, std::span<const Part> from, int column, int row, int tiles) const;

  const Stage* stage_ = nullptr;
  const RayField* rays_ = nullptr;
  int columns_ = 0, rows_ = 0;
  std::vector<Part> all_;
  mutable std::vector<List> tiles_, blocks_;
  mutable Room room_;
};

}  // namespace flexura
