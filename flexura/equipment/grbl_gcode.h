#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

// G-code as a simulated controller reads it.
namespace flexura {

/// Settings that stay in force from line to line.
struct GrblModes {
  int motion = 0;                ///< G0, G1, or 80 for none.
  int plane = 17;                ///< G17 to G19.
  bool is_absolute = true;       ///< G90, or G91.
  bool is_inverse_time = false;  ///< G93, or G94.
  double unit = 1;               ///< mm: 1 for G21, 25.4 for G20.
  std::size_t system = 0;        ///< Work coordinate system: 0 for G54.
  double feed = 0;               ///< mm/min
};

/// A line of G-code.
struct GrblBlock {
  std::vector<double> g, m;                 ///< Numbers of the G and M words.
  std::vector<std::optional<double>> axes;  ///< Number of each axis's word.
  std::optional<double> feed, p, l, line;   ///< Numbers of the words F, P, L, N.

  [[nodiscard]] bool has_axes() const;
  /// Returns true if the line has this G word.
  [[nodiscard]] bool has(double word) const;
};

/// Reads a line. `axes`: the number of axes. Spaces and comments are left out. Returns the code of an
/// `error:N` for a line that breaks a rule.
[[nodiscard]] std::variant<GrblBlock, int> parse_gcode(std::string_view line, std::size_t axes);

}  // namespace flexura
