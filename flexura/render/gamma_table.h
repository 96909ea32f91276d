#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flexura {

/// Lookup table of gamma-encoded levels: floor(top x^(1/gamma) + 1/2) for a float x from 0 to 1. The results
/// equal the results in double precision.
class GammaTable {
 public:
  GammaTable() = default;
  /// `top` is the highest level, at most 65535. Construction takes a few milliseconds for more than 8 bits.
  GammaTable(double gamma, int top);

  [[nodiscard]] bool empty() const { return starts_.empty(); }

  [[nodiscard]] std::uint16_t level(float x) const {
    const std::uint32_t piece = std::bit_cast<std::uint32_t>(x) >> shift_;
    std::size_t level = piece < first_piece_ ? 0 : starts_[piece - first_piece_];
    while (x >= thresholds_[level]) ++level;
    return static_cast<std::uint16_t>(level);
  }

 private:
  int shift_ = 0;                      // Floats that agree in all bits from this bit up form a piece.
  std::uint32_t first_piece_ = 0;      // Piece that contains the first threshold.
  std::vector<std::uint16_t> starts_;  // For each piece, the level at its beginning.
  std::vector<float> thresholds_;      // For each level, the smallest float with a higher level.
};

}  // namespace flexura
