#include "flexura/estimate/correspondence.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

namespace flexura {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct SeenRay {
  Eigen::Vector3d eye, direction;  // W; of any length.
  std::size_t point = 0;           // Index of the point in the observation.
};

std::vector<SeenRay> rays_of(const Observation& seen) {
  std::vector<SeenRay> rays;
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    const auto ab = seen.view.lens.unproject(seen.points[i].pixel);
    if (!ab) continue;
    rays.push_back(
        {seen.view.X_WC.position, seen.view.X_WC.rotation * Eigen::Vector3d(ab->x(), ab->y(), 1), i});
  }
  return rays;
}

double focal_length(const Observation& seen) {
  return 0.5 * (seen.view.lens.intrinsics().fx + seen.view.lens.intrinsics().fy);
}

// The cheapest path through a table of costs from its first row and column to its last. A curve that is cut
// may begin or end anywhere on the other one.
class Alignment {
 public:
  Alignment(std::size_t rows, std::size_t columns)
      : rows_(rows),
        columns_(columns),
        costs_(rows * columns),
        totals_(rows * columns, infinity),
        from_(rows * columns, none) {}

  double& cost(std::size_t i, std::size_t j) { return costs_[i * columns_ + j]; }

  // Fills `pairs`, from the start on. `is_free`: whether the path may start or end away from the corner.
  void solve(std::array<bool, 2> is_free, std::vector<std::array<std::size_t, 2>>& pairs) {
    for (std::size_t i = 0; i < rows_; ++i)
      for (std::size_t j = 0; j < columns_; ++j) enter(i, j, is_free[0]);
    std::array<std::size_t, 2> at{rows_ - 1, columns_ - 1};
    if (is_free[1]) at = cheapest_end();
    for (;;) {
      pairs.push_back(at);
      const std::uint8_t step = from_[at[0] * columns_ + at[1]];
      if (step == none) break;
      at[0] -= step & 1u, at[1] -= step >> 1u;
    }
    std::ranges::reverse(pairs);
  }

 private:
  static constexpr std::uint8_t none = 0;  // Otherwise 1: back by a row, 2: by a column, 3: by both.

  void enter(std::size_t i, std::size_t j, bool is_free_start) {
    const std::size_t here = i * columns_ + j;
    double least = (i == 0 && j == 0) || (is_free_start && (i == 0 || j == 0)) ? 0 : infinity;
    const auto consider = [&](std::size_t before, std::uint8_t step) {
      if (totals_[before] < least) least = totals_[before], from_[here] = step;
    };
    if (i > 0 && j > 0) consider(here - columns_ - 1, 3);
    if (i > 0) consider(here - columns_, 1);
    if (j > 0) consider(here - 1, 2);
    totals_[here] = least + costs_[here];
  }

  // In the last row or column, by the mean cost of the path: a short path has no advantage.
  [[nodiscard]] std::array<std::size_t, 2> cheapest_end() const {
    std::array<std::size_t, 2> best{rows_ - 1, columns_ - 1};
    double least = infinity;
    const auto consider = [&](std::size_t i, std::size_t j) {
      const double mean = totals_[i * columns_ + j] / static_cast<double>(i + j + 1);
      if (mean < least) least = mean, best = {i, j};
    };
    for (std::size_t i = rows_ / 2; i < rows_; ++i) consider(i, columns_ - 1);
    for (std::size_t j = columns_ / 2; j < columns_; ++j) consider(rows_ - 1, j);
    return best;
  }

  std::size_t rows_, columns_;
  std::vector<double> costs_, totals_;
  std::vector<std::uint8_t> from_;
};

// Returns the midpoint of two rays where they are nearest; empty for parallel rays.
std::optional<Eigen::Vector3d> meeting_of(const SeenRay& a, const SeenRay& b) {
  const double aa = a.direction.squaredNorm(), bb = b.direction.squaredNorm(),
               ab = a.direction.dot(b.direction);
  const double determinant = aa * bb - ab * ab;
  constexpr double parallel = 1e-12;
  if (!(determinant > parallel * aa * bb)) return std::nullopt;
  const Eigen::Vector3d between = b.eye - a.eye;
  const double da = between.dot(a.direction), db = between.dot(b.direction);
  const Eigen::Vector3d on_a = a.eye + (bb * da - ab * db) / determinant * a.direction;
  const Eigen::Vector3d on_b = b.eye + (ab * da - aa * db) / determinant * b.direction;
  return 0.5 * (on_a + on_b);
}

}  // namespace

std::vector<SpacePoint> correspondence(const Observation& a, const Observation& b) {
  const std::vector<SeenRay> left = rays_of(a), right = rays_of(b);
  if (left.empty() || right.empty()) return {};
  const Eigen::Vector3d baseline = b.view.X_WC.position - a.view.X_WC.position;
  const double scale = 0.5 * (focal_length(a) + focal_length(b));
  Alignment alignment(left.size(), right.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    // The epipolar plane of the left ray; sine of the right ray's angle to it.
    const Eigen::Vector3d normal = baseline.cross(left[i].direction).normalized();
    for (std::size_t j = 0; j < right.size(); ++j) {
      const double off = scale * normal.dot(right[j].direction) / right[j].direction.norm();
      alignment.cost(i, j) = off * off;
    }
  }
  const auto is_cut = [&](std::size_t end) { return !a.ends[end] || !b.ends[end]; };
  std::vector<std::array<std::size_t, 2>> pairs;
  alignment.solve({is_cut(0), is_cut(1)}, pairs);
  std::vector<SpacePoint> points;
  for (const auto& [i, j] : pairs)
    if (const auto point = meeting_of(left[i], right[j]))
      points.push_back({*point, {left[i].point, right[j].point}});
  return points;
}

}  // namespace flexura
