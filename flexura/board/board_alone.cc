#include "flexura/board/board_alone.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "flexura/board/board_start.h"
#include "flexura/math/dense.h"
#include "flexura/math/median.h"
#include "flexura/math/so3.h"

namespace flexura {
namespace {

using Eigen::Vector2d;

BundleFit fit_from(const Intrinsics& lens, std::span<const Vector2d> points, std::span<const BoardView> views,
                   const BundleConfig& config) {
  BoardBundle start{{lens}, {Pose{}}, {}};
  for (const BoardView& view : views) {
    const auto pose = start_pose(Lens(lens), points, view.pixels.front());
    if (!pose) return {};
    start.boards.push_back(*pose);
  }
  return fit_bundle(points, views, start, config);
}

}  // namespace

double rms_of(double square_sum, std::size_t points) {
  return points > 0 ? std::sqrt(square_sum / static_cast<double>(points)) : 0;
}

CameraAlone fit_alone(std::span<const Vector2d> points, std::span<const BoardView> views, std::size_t camera,
                      const std::array<int, 2>& size, const BundleConfig& config) {
  CameraAlone alone;
  std::vector<BoardView> own;
  std::vector<Eigen::Matrix3d> homographies;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto& pixels = views[i].pixels[camera];
    const auto H = pixels.empty() ? std::nullopt : board_homography(points, pixels);
    if (!H) continue;
    own.push_back({{pixels}}), homographies.push_back(*H), alone.views.push_back(i);
  }
  if (own.size() < 2) return alone;
  Intrinsics lens = start_lens(homographies, size[0], size[1]);
  alone.fit = fit_from(lens, points, own, config);
  // A good fit has residuals of a few tenths of a pixel. A larger error indicates a wrong start.
  constexpr double bad = 2;
  for (const double focal : {0.6, 1.2, 2.5, 6.0}) {
    if (alone.fit.is_converged && rms_of(alone.fit.square_sum, alone.fit.points) < bad) break;
    lens = {
        .fx = focal * size[0], .fy = focal * size[0], .cx = 0.5 * (size[0] - 1), .cy = 0.5 * (size[1] - 1)};
    BundleFit other = fit_from(lens, points, own, config);
    const bool is_better =
        other.is_converged && (!alone.fit.is_converged || other.square_sum < alone.fit.square_sum);
    if (is_better) alone.fit = std::move(other);
  }
  return alone;
}

std::optional<Pose> start_camera(std::span<const CameraStep> steps) {
  if (steps.empty()) return std::nullopt;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (const CameraStep& step : steps) sum += step.X_1C.rotation, position += step.X_1C.position;
  return Pose{nearest_rotation(sum), position / static_cast<double>(steps.size())};
}

StepSpread step_spread(std::span<const CameraStep> steps) {
  const auto turn = [](const CameraStep& from, const CameraStep& to) {
    return so3_log(from.X_1C.rotation.transpose() * to.X_1C.rotation).norm();
  };
  const auto median_turn = [&](const CameraStep& from) {
    std::vector<double> turns;
    for (const CameraStep& to : steps) turns.push_back(turn(from, to));
    return median(std::span(turns));
  };
  const CameraStep& usual = *std::ranges::min_element(steps, {}, median_turn);
  const CameraStep& farthest =
      *std::ranges::max_element(steps, {}, [&](const CameraStep& step) { return turn(usual, step); });
  return {turn(usual, farthest), (farthest.X_1C.position - usual.X_1C.position).norm(), farthest.view};
}

}  // namespace flexura
