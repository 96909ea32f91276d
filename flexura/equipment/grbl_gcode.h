#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

// G-code as a simulated controller reads it.
namespace flexura {

/// Modal settings, which remain valid for the following lines.
struct GrblModes {
  int motion = 0;                ///< Motion mode: 0 for G0, 1 for G1, 80 for none.
  int plane = 17;                ///< Plane: 17 to 19 for G17 to G19.
  bool is_absolute = true;       ///< Whether positions are absolute (G90), not relative (G91).
  bool is_inverse_time = false;  ///< Whether the feed is an inverse time (G93), not a speed (G94).
  double unit = 1;               ///< Unit of lengths, mm: 1 for G21, 25.4 for G20.
  std::size_t system = 0;        ///< Work coordinate system: 0 for G54.
  double feed = 0;               ///< Feed, mm/min.
};

/// A line of G-code.
struct GrblBlock {
  std::vector<double> g, m;                 ///< Numbers of the G and M words.
  std::vector<std::optional<double>> axes;  ///< Number in the word of each axis.
  std::optional<double> feed, p, l, line;   ///< Numbers in the words F, P, L, N.

  [[nodiscard]] bool has_axes() const;
  /// Returns true if the line has this G word.
  [[nodiscard]] bool has(double word) const;
};

/// Reads a line. `axes`: number of axes. Spaces and comments are ignored. For an invalid line, returns the
/// code N of `error:N`.
[[nodiscard]] std::variant<GrblBlock, int> parse_gcode(std::string_view line, std::size_t axes);

}  // namespace flexura
