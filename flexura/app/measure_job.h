#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexura/app/canvas.h"
#include "flexura/app/measure.h"
#include "flexura/base/image.h"
#include "flexura/base/node.h"
#include "flexura/vision/conic.h"
#include "flexura/vision/picture_file.h"
#include "flexura/vision/threshold.h"

// Functions that measure one kind of object in a picture. Each function adds to the answer and returns
// whether the object was found.
namespace flexura {

inline constexpr PenColor axis_color = {255, 40, 40}, border_color = {40, 200, 60},
                          marker_color = {60, 120, 255}, fit_color = {255, 170, 0};

/// Returns the value rounded to a multiple of 1 / parts, which keeps files short.
[[nodiscard]] double rounded(double value, double parts);
/// Returns the value rounded to 1e-4 px.
[[nodiscard]] double px(double value);

/// Returns [u, v], px, with both values rounded.
[[nodiscard]] Node pixel_pair(const Eigen::Vector2d& value);
/// Returns whether points are roughly on an ellipse: their rms distance is within 3 % of the shorter
/// semi-axis.
[[nodiscard]] bool is_on_ellipse(const std::optional<EllipseFit>& fit);
/// Returns the fields of a circle fit that docs/vision.md describes; null without a fit.
[[nodiscard]] Node circle_node(const std::optional<CircleFit>& fit);
/// Returns the fields of an ellipse fit that docs/vision.md describes; null without a fit.
[[nodiscard]] Node ellipse_node(const std::optional<EllipseFit>& fit);

/// Builds a table whose members keep the order in which they are added.
class TableMaker {
 public:
  TableMaker& add(const std::string& key, Node node) {
    members_.push_back({key, {}, std::move(node)});
    return *this;
  }
  Node take() { return {std::move(members_), {}}; }

 private:
  Node::Table members_;
};

/// Adds the keys `threshold`, `method` and `figure` to `answer`.
void add_threshold(const Threshold& threshold, TableMaker& answer);

/// A picture to be measured, its settings and its outputs.
struct Job {
  const Photograph& photograph;
  const Image<std::uint8_t>& gray;
  const MeasureConfig& config;
  TableMaker& answer;
  Canvas* canvas;  ///< Drawing of the measurements; null: draw nothing.
};

bool measure_arm(const Job& job);
bool measure_circle(const Job& job);
bool measure_etalon(const Job& job);

}  // namespace flexura
