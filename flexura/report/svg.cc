#include "flexura/report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "embedded/figure_css.h"
#include "flexura/base/utf8.h"

namespace flexura {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";

}  // namespace

std::string xml_escape(std::string_view text) {
  const bool is_good = is_utf8(text);
  std::string out;
  out.reserve(text.size() + text.size() / 8);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const auto byte = static_cast<unsigned char>(c);
    const bool is_blank = c == '\t' || c == '\n' || c == '\r';
    const std::string_view three = text.substr(i, 3);
    if (three == "\xEF\xBF\xBE" || three == "\xEF\xBF\xBF") {
      out += replacement;
      i += 2;
    } else if ((byte < 0x20 && !is_blank) || byte == 0x7F || (byte >= 0x80 && !is_good)) {
      out += replacement;
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\'') {
      out += "&#39;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string fixed(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text[0] == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string page_number(double value) {
  std::string text = fixed(value, 3);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string page_point(const Eigen::Vector2d& point) {
  return page_number(point.x()) + ' ' + page_number(point.y());
}

std::vector<Eigen::Vector2d> simplified(const std::vector<Eigen::Vector2d>& points, double tolerance) {
  if (points.size() < 3) return points;
  std::vector<bool> kept(points.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> spans = {{0, points.size() - 1}};
  while (!spans.empty()) {
    const auto [first, last] = spans.back();
    spans.pop_back();
    const Eigen::Vector2d& start = points[first];
    const Eigen::Vector2d chord = points[last] - start;
    double farthest = tolerance;
    std::size_t split = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const Eigen::Vector2d offset = points[i] - start;
      const double along = std::clamp(offset.dot(chord) / std::max(chord.squaredNorm(), 1e-300), 0.0, 1.0);
      const double distance = (offset - along * chord).norm();
      if (distance > farthest) {
        farthest = distance;
        split = i;
      }
    }
    if (split == first) continue;
    kept[split] = true;
    spans.emplace_back(first, split);
    spans.emplace_back(split, last);
  }
  std::vector<Eigen::Vector2d> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (kept[i]) out.push_back(points[i]);
  }
  return out;
}

std::string polyline_path(const std::vector<Eigen::Vector2d>& points) {
  std::string path;
  for (const Eigen::Vector2d& point : points) path += (path.empty() ? "M" : "L") + page_point(point);
  return path;
}

void XmlWriter::start(std::string_view tag, Attributes attributes) {
  out_ += fmt::format("<{}", tag);
  for (const XmlAttribute& attribute : attributes) {
    out_ += fmt::format(" {}=\"{}\"", attribute.name, xml_escape(attribute.value));
  }
}

void XmlWriter::open(std::string_view tag, Attributes attributes) {
  start(tag, attributes);
  out_ += '>';
  open_.emplace_back(tag);
}

void XmlWriter::close() {
  out_ += fmt::format("</{}>\n", open_.back());
  open_.pop_back();
}

void XmlWriter::leaf(std::string_view tag, Attributes attributes) {
  start(tag, attributes);
  out_ += "/>\n";
}

void XmlWriter::leaf(std::string_view tag, Attributes attributes, std::string_view content) {
  start(tag, attributes);
  out_ += fmt::format(">{}</{}>\n", xml_escape(content), tag);
}

void XmlWriter::label(const Eigen::Vector2d& at, std::string_view css_class, std::string_view content) {
  leaf("text", {{"x", page_number(at.x())}, {"y", page_number(at.y())}, {"class", std::string(css_class)}},
       content);
}

void XmlWriter::circle(const Eigen::Vector2d& at, std::string_view css_class, double radius) {
  leaf("circle", {{"class", std::string(css_class)},
                  {"cx", page_number(at.x())},
                  {"cy", page_number(at.y())},
                  {"r", page_number(radius)}});
}

void XmlWriter::rect(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, std::string_view css_class) {
  leaf("rect", {{"class", std::string(css_class)},
                {"x", page_number(corner.x())},
                {"y", page_number(corner.y())},
                {"width", page_number(size.x())},
                {"height", page_number(size.y())}});
}

std::string XmlWriter::text() {
  while (!open_.empty()) close();
  return out_;
}

std::string standalone_svg(const Drawing& drawing) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "class=\"figure\">\n"
      "<title>{2}</title>\n<style>\n{3}</style>\n<rect class=\"sheet\" width=\"{0}\" "
      "height=\"{1}\"/>\n{4}</svg>\n",
      page_number(drawing.width), page_number(drawing.height), xml_escape(drawing.label),
      embedded::figure_css, drawing.body);
}

std::string inline_svg(const Drawing& drawing) {
  return fmt::format(
      "<svg class=\"figure\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n{}</svg>\n",
      page_number(drawing.width), page_number(drawing.height), xml_escape(drawing.label), drawing.body);
}

}  // namespace flexura
