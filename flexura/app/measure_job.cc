#include "flexura/app/measure_job.h"

#include <cmath>
#include <cstddef>

#include "flexura/base/degree.h"
#include "flexura/base/table.h"

namespace flexura {

double rounded(double value, double parts) { return std::round(value * parts) / parts; }
double px(double value) { return rounded(value, 1e4); }

Node pixel_pair(const Eigen::Vector2d& value) {
  return {Node::Array{number_node(px(value.x())), number_node(px(value.y()))}, {}};
}

Node circle_node(const std::optional<CircleFit>& fit) {
  if (!fit || !fit->is_curved()) return {};
  return TableMaker()
      .add("center", pixel_pair(fit->center))
      .add("radius", number_node(px(fit->radius)))
      .add("rms", number_node(fit->rms))
      .add("sigma", number_node(std::sqrt(fit->covariance(2, 2))))
      .add("arc_deg", number_node(fit->arc / degree))
      .add("misfit_correlation", number_node(rounded(fit->misfit_correlation, 1e3)))
      .add("verified", {fit->is_circle(), {}})
      .add("detectable_tilt_deg", number_node(fit->detectable_tilt / degree))
      .take();
}

bool is_on_ellipse(const std::optional<EllipseFit>& fit) {
  constexpr double roughest = 0.03;
  return fit && fit->rms < roughest * fit->semi_axes.y();
}

Node ellipse_node(const std::optional<EllipseFit>& fit) {
  if (!is_on_ellipse(fit)) return {};
  const Eigen::Matrix<double, 5, 1> sigma = fit->covariance.diagonal().cwiseMax(0).cwiseSqrt();
  const auto pair = [](double a, double b) { return Node{Node::Array{number_node(a), number_node(b)}, {}}; };
  return TableMaker()
      .add("center", pixel_pair(fit->center))
      .add("semi_axes", pixel_pair(fit->semi_axes))
      .add("angle_deg", number_node(fit->angle / degree))
      .add("rms", number_node(fit->rms))
      .add("sigma", TableMaker()
                        .add("center", pair(sigma[0], sigma[1]))
                        .add("semi_axes", pair(sigma[2], sigma[3]))
                        .add("angle_deg", number_node(sigma[4] / degree))
                        .take())
      .take();
}

void add_threshold(const Threshold& threshold, TableMaker& answer) {
  answer.add("threshold", number_node(threshold.level)).add("method", text_node(name_of(threshold.method)));
  if (threshold.reason.empty()) answer.add("figure", text_node(name_of(threshold.figure)));
}

}  // namespace flexura
