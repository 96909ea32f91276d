#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "flexura/report/svg.h"

namespace flexura {

/// Lines in an image that belong together.
struct ImageOutline {
  /// One line: its points, px, and its style classes beside the outline's.
  struct Line {
    std::vector<Eigen::Vector2d> points;
    std::string css_class = {};
  };

  std::string name;  ///< For the legend.
  std::string css_class;
  std::vector<Line> lines;
};

/// What an image of `width` by `height` px shows, as lines.
struct ImagePlot {
  std::string heading;
  std::string legend;  ///< What the outlines are; may be empty.
  int width = 0, height = 0;
  std::vector<ImageOutline> outlines;
  /// The image itself, "data:image/jpeg;base64,..."; then all of it is shown, and drawn below the outlines.
  std::string background = {};
};

/// Draws the part of the image in which the outlines are, at one scale along both axes: columns to the right,
/// rows downwards.
[[nodiscard]] Drawing image_picture(const ImagePlot& plot);

}  // namespace flexura
