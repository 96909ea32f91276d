#include "flexura/board/board_alone.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
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

// Fits first with fewer distortion coefficients, because a lens with wrong coefficients may not show all
// points, and then with all.
BundleFit fit_in_stages(BoardBundle start, std::span<const Vector2d> points, std::span<const BoardView> views,
                        const BundleConfig& config, std::initializer_list<int> coefficients) {
  for (const int count : coefficients) {
    if (count >= config.distortion) continue;
    BundleConfig stage = config;
    stage.distortion = count, stage.least_gain = std::max(1e-4, config.least_gain);
    BundleFit fit = fit_bundle(points, views, start, stage);
    if (fit.points > 0) start = std::move(fit.bundle);
  }
  return fit_bundle(points, views, start, config);
}

BundleFit fit_from(const Intrinsics& lens, std::span<const Vector2d> points, std::span<const BoardView> views,
                   const BundleConfig& config, std::initializer_list<int> coefficients = {}) {
  BoardBundle start{{lens}, {Pose{}}, {}};
  for (const BoardView& view : views) {
    const auto pose = start_pose(Lens(lens), points, view.pixels.front());
    if (!pose) return {};
    start.boards.push_back(*pose);
  }
  return fit_in_stages(std::move(start), points, views, config, coefficients);
}

// Returns a rational lens close to a lens of another model.
Intrinsics as_rational(Intrinsics lens) {
  const Distortion given = lens.distortion;
  lens.distortion = Distortion(LensModel::rational);
  if (given.model() == LensModel::fisheye) {
    // atan(r) / r is about (15 + 4 r^2) / (15 + 9 r^2).
    lens.distortion[0] = 4.0 / 15 + given[0], lens.distortion[5] = 9.0 / 15;
  } else {
    std::ranges::copy(given, lens.distortion.begin());
  }
  return lens;
}

}  // namespace

double rms_of(double square_sum, std::size_t points) {
  return points > 0 ? std::sqrt(square_sum / static_cast<double>(points)) : 0;
}

CameraAlone fit_alone(std::span<const Vector2d> points, std::span<const BoardView> views, std::size_t camera,
                      const std::array<int, 2>& size, LensModel model, const BundleConfig& config) {
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
  // A good fit has residuals of a few tenths of a pixel. A larger error indicates a wrong start.
  constexpr double bad = 2;
  const auto is_good = [&] {
    return alone.fit.is_converged && rms_of(alone.fit.square_sum, alone.fit.points) < bad;
  };
  const auto consider = [&](BundleFit other) {
    const bool is_better =
        other.is_converged && (!alone.fit.is_converged || other.square_sum < alone.fit.square_sum);
    if (is_better || alone.fit.points == 0) alone.fit = std::move(other);
  };
  const auto lens_with = [&](double focal) {
    return Intrinsics{.fx = focal * size[0],
                      .fy = focal * size[0],
                      .cx = 0.5 * (size[0] - 1),
                      .cy = 0.5 * (size[1] - 1),
                      .distortion = Distortion(model)};
  };
  switch (model) {
    case LensModel::brown:
      consider(fit_from(start_lens(homographies, size[0], size[1]), points, own, config));
      for (const double focal : {0.6, 1.2, 2.5, 6.0})
        if (!is_good()) consider(fit_from(lens_with(focal), points, own, config));
      break;
    case LensModel::rational:
      // It has local minima. The models with fewer coefficients lead to the best one.
      for (const LensModel simpler : {LensModel::brown, LensModel::fisheye}) {
        // as_rational() uses the first six coefficients.
        if (simpler == LensModel::fisheye && config.distortion < 6) continue;
        BundleConfig first = config;
        first.distortion = std::min(config.distortion, static_cast<int>(Distortion::size_of(simpler)));
        BundleFit start = fit_alone(points, views, camera, size, simpler, first).fit;
        if (start.points == 0) continue;
        start.bundle.lenses.front() = as_rational(start.bundle.lenses.front());
        consider(fit_in_stages(std::move(start.bundle), points, own, config, {5, 6}));
      }
      break;
    case LensModel::fisheye:
      // Homographies do not describe its pictures.
      for (const double focal : {0.45, 0.3, 0.7, 1.2}) {
        if (!is_good()) consider(fit_from(lens_with(focal), points, own, config, {0}));
        if (!is_good()) consider(fit_from(lens_with(focal), points, own, config));
      }
      break;
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
