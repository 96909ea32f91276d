#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "flexura/report/svg.h"

namespace flexura {

/// Lines in an image that belong together.
struct ImageOutline {
  /// One line: its points, px, and its style classes in addition to the outline's.
  struct Line {
    std::vector<Eigen::Vector2d> points;
    std::string css_class = {};
  };

  std::string name;  ///< For the legend.
  std::string css_class;
  std::vector<Line> lines;
};

/// Content of an image of `width` by `height` px, as lines.
struct ImagePlot {
  std::string heading;
  std::string legend;  ///< Meaning of the outlines; may be empty.
  int width = 0, height = 0;
  std::vector<ImageOutline> outlines;
  /// The image itself, "data:image/jpeg;base64,...". If given, the whole image is shown, below the outlines.
  std::string background = {};
};

/// Draws the part of the image with the outlines, at one scale along both axes: columns to the right, rows
/// downwards.
[[nodiscard]] Drawing image_picture(const ImagePlot& plot);

}  // namespace flexura
