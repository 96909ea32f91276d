#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// Text made safe for XML and HTML, in content and in quoted attributes: & < > " ' become references; bytes
/// that are not UTF-8 and characters that XML forbids become U+FFFD.
[[nodiscard]] std::string xml_escape(std::string_view text);

/// A page coordinate with at most three decimals, as short as can be ("12.5", "0", never "-0").
[[nodiscard]] std::string page_number(double value);

/// "x y" of a page point.
[[nodiscard]] std::string page_point(const Eigen::Vector2d& point);

/// A fixed number of decimals; what rounds to zero has no sign.
[[nodiscard]] std::string fixed(double value, int decimals);

/// The vertices of an open polyline that keep it within `tolerance` of every point (Douglas and Peucker
/// 1973); the first and last point stay.
[[nodiscard]] std::vector<Eigen::Vector2d> simplified(const std::vector<Eigen::Vector2d>& points,
                                                      double tolerance);

/// Path data "M x y L x y ..." through the points, none when there are no points.
[[nodiscard]] std::string polyline_path(const std::vector<Eigen::Vector2d>& points);

/// An attribute of an element; the value is escaped when written.
struct XmlAttribute {
  std::string_view name;
  std::string value;
};

/// Writes nested elements. What is opened is closed at the latest by text().
class XmlWriter {
 public:
  using Attributes = std::initializer_list<XmlAttribute>;

  void open(std::string_view tag, Attributes attributes = {});
  void close();
  void leaf(std::string_view tag, Attributes attributes = {});
  /// An element with escaped text in it.
  void leaf(std::string_view tag, Attributes attributes, std::string_view content);
  /// A one-line text at a page point. `css_class` holds "middle" or "end" for another anchor than the start.
  void label(const Eigen::Vector2d& at, std::string_view css_class, std::string_view content);
  void circle(const Eigen::Vector2d& at, std::string_view css_class, double radius);
  void rect(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, std::string_view css_class);
  /// Everything written so far, with all elements closed.
  [[nodiscard]] std::string text();

 private:
  void start(std::string_view tag, Attributes attributes);

  std::string out_;
  std::vector<std::string> open_;
};

/// A finished picture, styled by the classes of figure.css.
struct Drawing {
  double width = 0.0;   ///< Page units (px at scale 1).
  double height = 0.0;  ///< Page units.
  std::string label;    ///< What the picture shows, for those who do not see it.
  std::string body;     ///< SVG elements.
};

/// A file of its own, with its style and a white page.
[[nodiscard]] std::string standalone_svg(const Drawing& drawing);

/// An element for an HTML page, which brings the style.
[[nodiscard]] std::string inline_svg(const Drawing& drawing);

}  // namespace flexura
