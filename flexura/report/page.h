#pragma once

#include <map>
#include <string>
#include <string_view>

#include "flexura/report/motion.h"

namespace flexura {

/// Returns `text` with each {{name}} replaced by values[name]. The values are not escaped, and names in them
/// are not replaced. Throws std::out_of_range for a name without a value.
[[nodiscard]] std::string filled(std::string_view text,
                                 const std::map<std::string, std::string, std::less<>>& values);

/// Returns the source expression 'sha256-BASE64' of a content security policy for a text with the SHA-256
/// `hex`.
[[nodiscard]] std::string csp_hash(std::string_view hex);

/// Returns a page with the report's styles that loads no other file and runs no script. `title` and `version`
/// are any texts; `main` is the HTML of its main part.
[[nodiscard]] std::string plain_page(std::string_view title, std::string_view version, std::string_view main);

/// Returns the HTML element of a figure as a picture.
[[nodiscard]] std::string picture_html(const ReportFigure& figure);

/// Returns the HTML element of a figure. A drawing is an SVG picture. A chart is its heading, legend and
/// numbers as JSON, which the page's script plots.
[[nodiscard]] std::string figure_html(const ReportFigure& figure);

/// Returns the HTML element of a table, in a frame that scrolls if the page is narrower than the table.
[[nodiscard]] std::string table_html(const ChapterTable& table);

/// Returns the motion as JSON for the page's script. The JSON contains only numbers, so that it is valid
/// inside a script element.
[[nodiscard]] std::string motion_json(const ReportMotion& motion);

}  // namespace flexura
