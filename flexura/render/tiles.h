#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "flexura/render/ray_field.h"
#include "flexura/render/stage.h"
#include "flexura/render/tracer.h"

namespace flexura {

/// Lists, for each tile of 16 x 16 px, the primitives that may be visible or have a border there. A list is
/// computed only when the list is needed for the first time.
class Tiles {
 public:
  static constexpr int size = 16;

  /// Starts a new frame and reuses memory. `stage` and `rays` must outlive the queries.
  void build(const Stage& stage, const RayField& rays);

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  /// Returns the primitives of tile (column, row), in the stage's order.
  [[nodiscard]] std::span<const Part> parts(int column, int row) const;
  /// Returns all primitives.
  [[nodiscard]] std::span<const Part> all_parts() const { return all_; }

 private:
  // The primitives near a square of tiles that starts at (column, row).
  struct List {
    bool is_known = false;
    std::span<const Part> parts;
  };
  // Memory for lists, which do not move until clear().
  class Room {
   public:
    // Returns a vector with capacity for `parts` more elements.
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
