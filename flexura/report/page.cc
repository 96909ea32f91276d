#include "flexura/report/page.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstddef>

#include "embedded/figure_css.h"
#include "embedded/report_css.h"
#include "flexura/model/arm_model.h"

namespace flexura {
namespace {

// Nine digits: a micrometre in a kilometre, and half the size of all digits.
std::string json_number(double value) { return fmt::format("{:.9g}", value + 0.0); }

std::string json_array(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ",") + json_number(value);
  return '[' + text + ']';
}

// A chart's values: six digits exceed a screen's resolution.
std::string json_values(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) {
    if (!text.empty()) text += ',';
    text += std::isfinite(value) ? fmt::format("{:.6g}", value + 0.0) : "null";
  }
  return '[' + text + ']';
}

std::string unsafe_json(const ReportMotion& motion) {
  std::string text;
  for (const auto& violation : motion.violations) {
    for (const std::size_t section : violation.sections) {
      text += fmt::format("{}[{},{},{}]", text.empty() ? "" : ",", json_number(violation.start),
                          json_number(violation.end), section);
    }
  }
  return '[' + text + ']';
}

std::string chart_html(const LineChart& chart) {
  std::string names, values;
  for (const ChartSeries& one : chart.series) {
    names += fmt::format("<li class=\"{}\">{}</li>\n", chart.class_of(one), xml_escape(one.name));
    values += fmt::format("{}[{},{},{}]", values.empty() ? "" : ",", json_values(one.values),
                          json_values(one.dots), json_values(one.rings));
  }
  return fmt::format(
      "<figcaption>{0}</figcaption>\n<div class=\"chart\" role=\"group\" aria-label=\"Chart: {0}\" "
      "data-x=\"{1}\" data-y=\"{2}\" data-least=\"{3}\" data-legend=\"{4}\"{9}>\n<ul>\n{5}</ul>\n"
      "<script type=\"application/json\">{{\"x\":{6},\"marks\":{7},\"series\":[{8}]}}</script>\n</div>\n",
      xml_escape(chart.heading), xml_escape(chart.x_label), xml_escape(chart.axis_label()), chart.least,
      xml_escape(chart.legend), names, chart.is_of_run ? "null" : json_array(chart.x),
      json_array(chart.marks), values, chart.is_log ? " data-log=\"yes\"" : "");
}

}  // namespace

std::string filled(std::string_view text, const std::map<std::string, std::string, std::less<>>& values) {
  std::string out;
  for (std::size_t open = text.find("{{"); open != std::string_view::npos; open = text.find("{{")) {
    const std::size_t close = text.find("}}", open);
    out += text.substr(0, open);
    out += values.at(std::string(text.substr(open + 2, close - open - 2)));
    text.remove_prefix(close + 2);
  }
  return out += text;
}

std::string csp_hash(std::string_view hex) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string base64;
  unsigned bits = 0;
  unsigned waiting = 0;
  for (const char& digit : hex) {
    unsigned nibble = 0;
    std::from_chars(&digit, &digit + 1, nibble, 16);
    bits = (bits << 4U) | nibble;
    waiting += 4;
    if (waiting < 6) continue;
    waiting -= 6;
    base64 += digits[(bits >> waiting) & 63U];
  }
  if (waiting > 0) base64 += digits[(bits << (6 - waiting)) & 63U];
  while (base64.size() % 4 != 0) base64 += '=';
  return "'sha256-" + base64 + "'";
}

std::string figure_html(const ReportFigure& figure) {
  const auto* drawing = std::get_if<Drawing>(&figure.content);
  return fmt::format(
      "<figure id=\"picture-{}\">\n{}</figure>\n", figure.name,
      drawing != nullptr ? inline_svg(*drawing) : chart_html(std::get<LineChart>(figure.content)));
}

std::string picture_html(const ReportFigure& figure) {
  const auto* drawing = std::get_if<Drawing>(&figure.content);
  return fmt::format(
      "<figure id=\"picture-{}\">\n{}</figure>\n", figure.name,
      inline_svg(drawing != nullptr ? *drawing : chart_picture(std::get<LineChart>(figure.content))));
}

std::string plain_page(std::string_view title, std::string_view version, std::string_view main) {
  const std::string escaped = xml_escape(title);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
      "{} {}; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" href=\"data:,\">\n"
      "<title>{} - Flexura</title>\n<style>{}</style>\n<style>{}</style>\n</head>\n<body>\n<header>\n"
      "<p class=\"maker\">Flexura {}</p>\n<h1>{}</h1>\n</header>\n<main>\n{}</main>\n</body>\n</html>\n",
      csp_hash(embedded::figure_css_sha256), csp_hash(embedded::report_css_sha256), escaped,
      embedded::figure_css, embedded::report_css, xml_escape(version), escaped, main);
}

std::string table_html(const ChapterTable& table) {
  std::string html =
      "<div class=\"scroll whole\" tabindex=\"0\" role=\"region\" aria-label=\"Results\">\n<table "
      "class=\"results\">\n<thead><tr>";
  for (const std::string& column : table.columns)
    html += fmt::format("<th scope=\"col\">{}</th>", xml_escape(column));
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (const std::string& cell : row) html += fmt::format("<td>{}</td>", xml_escape(cell));
    html += "</tr>\n";
  }
  return html + "</tbody>\n</table>\n</div>\n";
}

std::string motion_json(const ReportMotion& motion) {
  const Pose& X_WB = motion.arm.X_WB;
  std::vector<double> lengths, radii, states;
  const ArmModel& model = motion.model;
  for (const Section& section : model.shaped().sections) {
    lengths.push_back(section.length);
    radii.insert(radii.end(), section.radius.begin(), section.radius.end());
  }
  for (const ArmState& command : motion.states) {
    const ArmState state = model.actuation().shape(command);
    for (std::size_t k = 0; k < state.bends.size(); ++k)
      states.insert(states.end(), {state.bends[k].x(), state.bends[k].y(), state.stretches[k]});
  }
  return fmt::format(
      R"({{"coordinates":{},"axes":{},"origin":{},"lengths":{},"radii":{},"times":{},"unsafe":{},"still":{},"states":{}}})",
      motion.tip_coordinates(), json_array({X_WB.rotation.data(), X_WB.rotation.data() + 9}),
      json_array({X_WB.position.data(), X_WB.position.data() + 3}), json_array(lengths), json_array(radii),
      json_array(motion.times), unsafe_json(motion), motion.is_still, json_array(states));
}

}  // namespace flexura
