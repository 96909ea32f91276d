#include "flexura/report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "embedded/figure_css.h"

namespace flexura {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";

// Number of bytes of a character that starts with `first`, 0 where none does.
std::size_t bytes_announced(unsigned first) {
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4) return 0;
  if (first < 0xE0) return 2;
  return first < 0xF0 ? 3 : 4;
}

// Number of bytes of the valid UTF-8 character at the start of `text`; 0 when there is none.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  const std::size_t size = bytes_announced(first);
  if (size == 0 || size > text.size()) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return 0;
  }
  // Overlong forms, surrogates and what lies beyond U+10FFFF differ from good characters in the second byte.
  if (size >= 3) {
    const unsigned second = byte(1);
    if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F)) return 0;
    if ((first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F)) return 0;
  }
  return size;
}

bool forbidden_in_xml(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (first < 0x20) return first != '\t' && first != '\n' && first != '\r';
  return character == "\x7F" || character == "\xEF\xBF\xBE" || character == "\xEF\xBF\xBF";
}

}  // namespace

std::string xml_escape(std::string_view text) {
  std::string out;
  out.reserve(text.size() + text.size() / 8);
  while (!text.empty()) {
    const std::size_t size = character_bytes(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(size, 1));
    text.remove_prefix(character.size());
    if (size == 0 || forbidden_in_xml(character)) {
      out += replacement;
    } else if (character == "&") {
      out += "&amp;";
    } else if (character == "<") {
      out += "&lt;";
    } else if (character == ">") {
      out += "&gt;";
    } else if (character == "\"") {
      out += "&quot;";
    } else if (character == "'") {
      out += "&#39;";
    } else {
      out += character;
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
