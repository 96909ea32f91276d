#pragma once

#include <map>
#include <string>
#include <string_view>

#include "flexura/report/motion.h"

namespace flexura {

/// `text` with each {{name}} replaced by values[name], as it is; what is put in is not looked at again.
/// A name without a value is a std::out_of_range.
[[nodiscard]] std::string filled(std::string_view text,
                                 const std::map<std::string, std::string, std::less<>>& values);

/// What a content security policy calls a text whose SHA-256 is `hex`: 'sha256-BASE64'.
[[nodiscard]] std::string csp_hash(std::string_view hex);

/// A figure's element: a picture as it is; of a chart its heading and legend, and its numbers as JSON, of
/// which the page's script makes a plot.
[[nodiscard]] std::string figure_html(const ReportFigure& figure);

/// The motion as JSON for the page's script: numbers only, so it can stand inside a script element.
[[nodiscard]] std::string motion_json(const ReportMotion& motion);

}  // namespace flexura
