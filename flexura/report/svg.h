#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// Returns text escaped for XML and HTML, for content and quoted attributes. The characters & < > " ' become
/// character references. Bytes that are not UTF-8 and characters that XML forbids become U+FFFD.
[[nodiscard]] std::string xml_escape(std::string_view text);

/// Returns a page coordinate with at most three decimals, as short as possible ("12.5", "0", never "-0").
[[nodiscard]] std::string page_number(double value);

/// Returns "x y" for a page point.
[[nodiscard]] std::string page_point(const Eigen::Vector2d& point);

/// Returns a number with `decimals` decimals; zero has no sign.
[[nodiscard]] std::string fixed(double value, int decimals);

/// Returns the vertices of an open polyline within `tolerance` of every point (Douglas and Peucker 1973). The
/// first and last point are kept.
[[nodiscard]] std::vector<Eigen::Vector2d> simplified(const std::vector<Eigen::Vector2d>& points,
                                                      double tolerance);

/// Returns path data "M x y L x y ..." through the points, or "" without points.
[[nodiscard]] std::string polyline_path(const std::vector<Eigen::Vector2d>& points);

/// An attribute of an element. The value is escaped when it is written.
struct XmlAttribute {
  std::string_view name;
  std::string value;
};

/// Writes nested elements. text() closes all open elements.
class XmlWriter {
 public:
  using Attributes = std::initializer_list<XmlAttribute>;

  void open(std::string_view tag, Attributes attributes = {});
  void close();
  void leaf(std::string_view tag, Attributes attributes = {});
  /// Writes an element with escaped text in it.
  void leaf(std::string_view tag, Attributes attributes, std::string_view content);
  /// Writes a one-line text at a page point. The anchor is the text's start, unless `css_class` contains
  /// "middle" or "end".
  void label(const Eigen::Vector2d& at, std::string_view css_class, std::string_view content);
  void circle(const Eigen::Vector2d& at, std::string_view css_class, double radius);
  void rect(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, std::string_view css_class);
  /// Returns everything written so far, with all elements closed.
  [[nodiscard]] std::string text();

 private:
  void start(std::string_view tag, Attributes attributes);

  std::string out_;
  std::vector<std::string> open_;
};

/// A complete picture. The classes of figure.css define its style.
struct Drawing {
  double width = 0.0;   ///< Width, page units (px at scale 1).
  double height = 0.0;  ///< Height, page units.
  std::string label;    ///< Description of the picture for screen readers.
  std::string body;     ///< SVG elements.
};

/// Returns the drawing as a separate SVG file with its style and a white background.
[[nodiscard]] std::string standalone_svg(const Drawing& drawing);

/// Returns the drawing as an element for an HTML page that contains the style sheet figure.css.
[[nodiscard]] std::string inline_svg(const Drawing& drawing);

}  // namespace flexura
