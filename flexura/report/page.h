#pragma once

#include <map>
#include <string>
#include <string_view>

#include "flexura/report/motion.h"

namespace flexura {

/// Returns `text` with each {{name}} replaced by values[name], unescaped and not replaced again. Throws
/// std::out_of_range for a name without a value.
[[nodiscard]] std::string filled(std::string_view text,
                                 const std::map<std::string, std::string, std::less<>>& values);

/// Returns the name in a content security policy of a text with the SHA-256 `hex`: 'sha256-BASE64'.
[[nodiscard]] std::string csp_hash(std::string_view hex);

/// Returns a figure's element. For a picture it is the picture; for a chart its heading, legend and numbers
/// as JSON, which the page's script plots.
[[nodiscard]] std::string figure_html(const ReportFigure& figure);

/// Returns a table's element, in a frame that scrolls if the page is narrower.
[[nodiscard]] std::string table_html(const ChapterTable& table);

/// Returns the motion as JSON for the page's script: only numbers, so that it is valid inside a script
/// element.
[[nodiscard]] std::string motion_json(const ReportMotion& motion);

}  // namespace flexura
