#include <fmt/format.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "flexura/app/measure_job.h"
#include "flexura/vision/border.h"

namespace flexura {
namespace {

using Eigen::Vector2d;

// Returns whether much of a figure's border lies near the circle or the ellipse.
bool is_round(const std::optional<CircleFit>& circle, const std::optional<EllipseFit>& ellipse,
              const std::vector<Vector2d>& used, const FigureBorder& figure) {
  // A few points always fit some circle.
  constexpr std::size_t fewest = 12;
  if (used.size() < fewest) return false;
  constexpr double least_share = 0.4, roughest = 0.03;
  if (static_cast<double>(used.size()) < least_share * static_cast<double>(figure.points.size()))
    return false;
  // The points must cover a third of it: straight sides fit some long ellipse.
  constexpr double least_around = 1.0 / 3;
  return (circle && circle->rms < roughest * circle->radius &&
          circle->arc > least_around * 2 * std::numbers::pi) ||
         (is_on_ellipse(ellipse) && share_around(*ellipse, used) > least_around);
}

}  // namespace

bool measure_circle(const Job& job) {
  const FigureBorder figure = largest_figure(job.gray, job.config.finder.threshold);
  add_threshold(figure.threshold, job.answer);
  std::vector<Vector2d> points;
  points.reserve(figure.points.size());
  for (const BorderPoint& point : figure.points) points.push_back(point.pixel);
  const std::optional<EllipseFit> ellipse = fit_ellipse_to_most(points);
  const std::optional<CircleFit> circle = fit_circle(points);
  const bool is_found = figure.reason.empty() && is_round(circle, ellipse, points, figure);
  job.answer.add("found", {is_found, {}});
  if (!is_found) {
    job.answer.add("reason", text_node(figure.reason.empty() ? "no circle or ellipse fits the largest figure"
                                                             : figure.reason));
    return false;
  }
  std::vector<std::string> notes;
  if (figure.touches_border) notes.emplace_back("the picture's border cuts the figure");
  if (points.size() < figure.points.size())
    notes.push_back(fmt::format("{} of {} border points are excluded because they are not on the curve",
                                figure.points.size() - points.size(), figure.points.size()));
  job.answer.add("notes", texts_node(notes))
      .add("area", {figure.area, {}})
      .add("blur", number_node(figure.blur))
      .add("points", {static_cast<std::int64_t>(points.size()), {}})
      .add("circle", circle_node(circle))
      .add("ellipse", ellipse_node(ellipse));
  if (job.canvas != nullptr) {
    for (const Vector2d& point : points) job.canvas->line(point, point, border_color);
    if (ellipse) job.canvas->ellipse(*ellipse, fit_color);
  }
  return true;
}

}  // namespace flexura
