#include "flexura/report/legend.h"

#include <fmt/format.h>

#include <string_view>

namespace flexura {
namespace {

constexpr double row_height = 22.0;
constexpr double swatch_width = 20.0;

double text_width(std::string_view text) { return 7.8 * static_cast<double>(text.size()); }

}  // namespace

double draw_legend(XmlWriter& svg, const std::string& title, const std::vector<LegendEntry>& entries,
                   const Eigen::Vector2d& corner, double right) {
  double x = corner.x();
  double y = corner.y() + 16.0;
  if (!title.empty()) {
    svg.label({x, y}, "tick", title);
    x += text_width(title) + 10.0;
  }
  const double indent = x;
  for (const LegendEntry& entry : entries) {
    const double width = swatch_width + 6.0 + text_width(entry.name) + 10.0;
    if (x + width > right) {
      x = indent;
      y += row_height;
    }
    svg.leaf(
        "path",
        {{"class", "line " + entry.css_class},
         {"d", fmt::format("M{} {}h{}", page_number(x), page_number(y - 5.0), page_number(swatch_width))}});
    svg.label({x + swatch_width + 6.0, y}, "", entry.name);
    x += width;
  }
  return y + 10.0 - corner.y();
}

}  // namespace flexura
