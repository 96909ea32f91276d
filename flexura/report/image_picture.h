#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "flexura/report/svg.h"

namespace flexura {

/// A group of lines in an image, with one entry in the legend.
struct ImageOutline {
  /// One line with its points, px, and its style classes in addition to those of the outline.
  struct Line {
    std::vector<Eigen::Vector2d> points;
    std::string css_class = {};
  };

  std::string name;  ///< Name in the legend.
  std::string css_class;
  std::vector<Line> lines;
};

/// Content of an image of `width` by `height` px, drawn as lines.
struct ImagePlot {
  std::string heading;
  std::string legend;  ///< Title of the legend; may be empty.
  int width = 0, height = 0;
  std::vector<ImageOutline> outlines;
  /// The image as a data URL, "data:image/jpeg;base64,...". If the data URL is given, the whole image is
  /// shown behind the outlines.
  std::string background = {};
};

/// Draws the part of the image that contains the outlines. Both axes have the same scale, with columns to the
/// right and rows downwards.
[[nodiscard]] Drawing image_picture(const ImagePlot& plot);

}  // namespace flexura
