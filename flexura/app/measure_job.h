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

// Measuring one picture for one thing: each adds to the answer and says whether it was found.
namespace flexura {

inline constexpr PenColor axis_color = {255, 40, 40}, border_color = {40, 200, 60},
                          marker_color = {60, 120, 255}, fit_color = {255, 170, 0};

/// To a whole number of so many parts of one: files stay short.
[[nodiscard]] double rounded(double value, double parts);
/// To 1e-4 px.
[[nodiscard]] double px(double value);

/// [u, v], px.
[[nodiscard]] Node pixel_pair(const Eigen::Vector2d& value);
/// Whether points lie on an ellipse by and large: within 3 % of its shorter semi-axis, root mean square.
[[nodiscard]] bool is_on_ellipse(const std::optional<EllipseFit>& fit);
/// As docs/vision.md has them; null where there is none.
[[nodiscard]] Node circle_node(const std::optional<CircleFit>& fit);
[[nodiscard]] Node ellipse_node(const std::optional<EllipseFit>& fit);

/// Members in the order in which they are added.
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

/// Adds `threshold`, `method` and `figure`.
void add_threshold(const Threshold& threshold, TableMaker& answer);

/// A picture on its way to being measured.
struct Job {
  const Photograph& photograph;
  const Image<std::uint8_t>& gray;
  const MeasureConfig& config;
  TableMaker& answer;
  Canvas* canvas;  ///< Null: nothing is drawn.
};

bool measure_arm(const Job& job);
bool measure_circle(const Job& job);
bool measure_etalon(const Job& job);

}  // namespace flexura
