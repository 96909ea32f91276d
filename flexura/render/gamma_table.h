#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flexura {

/// Lookup table of gamma-corrected levels: floor(top x^(1/gamma) + 1/2) of a float x from 0 to 1, exactly as
/// in double precision.
class GammaTable {
 public:
  GammaTable() = default;
  /// `top` is the highest level, at most 65535. Takes a few milliseconds above 8 bits.
  GammaTable(double gamma, int top);

  [[nodiscard]] bool empty() const { return starts_.empty(); }

  [[nodiscard]] std::uint16_t level(float x) const {
    const std::uint32_t piece = std::bit_cast<std::uint32_t>(x) >> shift_;
    std::size_t level = piece < first_piece_ ? 0 : starts_[piece - first_piece_];
    while (x >= thresholds_[level]) ++level;
    return static_cast<std::uint16_t>(level);
  }

 private:
  int shift_ = 0;                      // Floats that agree down to this bit form a piece.
  std::uint32_t first_piece_ = 0;      // Piece of the first threshold.
  std::vector<std::uint16_t> starts_;  // By piece: the level at its beginning.
  std::vector<float> thresholds_;      // By level: the smallest float beyond it.
};

}  // namespace flexura
