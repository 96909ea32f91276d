#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "flexura/kinematics/inverse_objective.h"
#include "flexura/math/dense.h"

namespace flexura {
namespace {

class ObjectiveMinimum {
 public:
  ObjectiveMinimum(BoundedDescent& descent, const ObjectiveScale& scale) : descent_(descent), scale_(scale) {}

  // Makes a Newton step, downhill where the preference is concave on the surface (a saddle is left to either
  // side). Returns false if x is at the minimum.
  bool step(Eigen::VectorXd& x) {
    constexpr double level = 1e-5;  // A curvature below this counts as zero.
    constexpr double still = 1e-9;
    const Slope here = slope(x);
    if (here.tangents.cols() == 0) return false;
    const auto second = curvature(x, here.tangents);
    if (!second) return false;
    const auto [values, vectors] = symmetric_eigen(*second);
    const Eigen::MatrixXd axes = here.tangents * vectors;
    const Eigen::VectorXd slopes = axes.transpose() * here.gradient;
    Eigen::VectorXd way = Eigen::VectorXd::Zero(x.size());
    for (Eigen::Index k = 0; k < slopes.size(); ++k) {
      way -= slopes[k] / std::max(std::abs(values[k]), level) * axes.col(k);
    }
    constexpr double nudge = 0.02;
    const bool is_ridge = values[0] < -level && way.norm() < nudge;
    if (is_ridge) way += nudge * (slopes[0] > 0.0 ? -1.0 : 1.0) * axes.col(0);
    const double length = way.norm();
    if (length < still) return false;
    constexpr double longest = 0.5;
    if (length > longest) way *= longest / length;
    return go(x, way);
  }

 private:
  struct Slope {
    Eigen::MatrixXd tangents;  // Orthonormal columns: directions along the surface of solutions.
    Eigen::VectorXd gradient;  // Gradient of half the preference, in relative values, along the surface.
  };

  [[nodiscard]] double objective(const Eigen::VectorXd& x) const { return scale_.relative(x).squaredNorm(); }

  // At the bounds that hold x, the surface follows them.
  Slope slope(const Eigen::VectorXd& x) {
    constexpr double on_the_bound = 1e-9;
    descent_.problem.linearise(x, descent_.r, descent_.J);
    const Eigen::Index rows = descent_.J.rows();
    Eigen::MatrixXd normals(rows + static_cast<Eigen::Index>(descent_.bounds.size()), x.size());
    normals.topRows(rows) = descent_.J * scale_.range.asDiagonal();
    Eigen::Index count = rows;
    for (const Bound& bound : descent_.bounds) {
      const double reach = on_the_bound * (bound.high - bound.low);
      const double value = bound.size == 1 ? x[bound.at] : x.segment<2>(bound.at).norm();
      const bool is_held = value >= bound.high - reach || (bound.size == 1 && value <= bound.low + reach);
      if (!is_held) continue;
      normals.row(count).setZero();
      normals.row(count).segment(bound.at, bound.size) = x.segment(bound.at, bound.size) / value;
      ++count;
    }
    Slope result{.tangents = orthogonal_complement(normals.topRows(count).transpose(), 1e-9), .gradient = {}};
    result.gradient = result.tangents * (result.tangents.transpose() * scale_.relative(x));
    return result;
  }

  // Returns the solution reached by a step in relative values.
  std::optional<Eigen::VectorXd> moved(const Eigen::VectorXd& x, const Eigen::VectorXd& step) {
    constexpr DescentLimits back{.iterations = 12, .slope = 1e-6};
    Eigen::VectorXd there = x + scale_.range.cwiseProduct(step);
    project(descent_.bounds, there);
    if (descent_.descend(back, there) != Descent::met) return std::nullopt;
    return there;
  }

  // Returns the second derivatives of half the preference along the surface, by differences; std::nullopt if
  // they do not exist.
  std::optional<Eigen::MatrixXd> curvature(const Eigen::VectorXd& x, const Eigen::MatrixXd& tangents) {
    constexpr double h = 1e-4;
    Eigen::MatrixXd result(tangents.cols(), tangents.cols());
    for (Eigen::Index k = 0; k < tangents.cols(); ++k) {
      const auto after = moved(x, h * tangents.col(k));
      const auto before = moved(x, -h * tangents.col(k));
      if (!after || !before) return std::nullopt;
      result.col(k) = tangents.transpose() * (slope(*after).gradient - slope(*before).gradient) / (2.0 * h);
    }
    return 0.5 * (result + result.transpose());
  }

  // Moves x along `way` as far as it leads down; returns false if it does not.
  bool go(Eigen::VectorXd& x, const Eigen::VectorXd& way) {
    constexpr double least_gain = 1e-14;
    const double enough = (1.0 - least_gain) * objective(x);
    for (double part = 1.0; part > 1e-3; part *= 0.5) {
      const auto next = moved(x, part * way);
      if (!next || !(objective(*next) < enough)) continue;
      x = *next;
      return true;
    }
    return false;
  }

  BoundedDescent& descent_;
  const ObjectiveScale& scale_;
};

}  // namespace

void run_down_to_minimum(BoundedDescent& descent, const ObjectiveScale& scale, Eigen::VectorXd& x) {
  // Sections bent by a full turn need the most steps, because their direction has little influence and the
  // objective has long valleys.
  constexpr int most_steps = 200;
  ObjectiveMinimum minimum(descent, scale);
  for (int i = 0; i < most_steps && minimum.step(x); ++i) {
  }
}

}  // namespace flexura
