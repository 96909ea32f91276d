#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "flexura/report/svg.h"

namespace flexura {

/// One line's name, and the style classes of the line.
struct LegendEntry {
  std::string name;
  std::string css_class;
};

/// Draws a legend in rows from the page point `corner` (top left) on, no further right than `right`: a title
/// that may be empty, then the entries. Returns its height, page units.
double draw_legend(XmlWriter& svg, const std::string& title, const std::vector<LegendEntry>& entries,
                   const Eigen::Vector2d& corner, double right);

}  // namespace flexura
