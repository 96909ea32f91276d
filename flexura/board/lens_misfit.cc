#include "flexura/board/lens_misfit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace flexura {

using Eigen::Vector2d;

bool LensMisfit::is_systematic() const {
  constexpr double visible = 0.5;  // px
  return rms > visible && likeness > 0.5;
}

std::string LensMisfit::reason(const FittedLens& lens) const {
  // A bent board leaves less than this.
  constexpr double surely_radial = 0.1;
  return fmt::format(
      "the lens model does not fit{}: the residuals of {:.3g} px are correlated between neighbouring points: "
      "expected {}another lens model than {}",
      radial_share > surely_radial ? "" : ", or the board is not flat", rms,
      lens.distortion < static_cast<int>(Distortion::size_of(lens.model))
          ? "more coefficients of distortion, or "
          : "",
      name_of(lens.model));
}

LensMisfit lens_misfit(std::span<const Vector2d> points, std::span<const BoardView> views,
                       const BoardBundle& bundle, std::size_t camera) {
  const Lens lens(bundle.lenses[camera]);
  const Vector2d middle(lens.intrinsics().cx, lens.intrinsics().cy);
  std::vector<std::pair<double, double>> radial;  // Distance from the middle and outward residual, px.
  double squares = 0, neighbours = 0, products = 0;
  for (std::size_t view = 0; view < views.size() && view < bundle.boards.size(); ++view) {
    const auto& pixels = views[view].pixels[camera];
    if (pixels.empty()) continue;
    const Pose X_CB = bundle.cameras[camera].inverse() * bundle.boards[view];
    Vector2d last = Vector2d::Zero();
    bool has_last = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!is_seen(pixels[i])) {
        has_last = false;
        continue;
      }
      const auto pixel = lens.project(X_CB.position + X_CB.rotation.leftCols<2>() * points[i]);
      if (!pixel) break;
      const Vector2d residual = pixels[i] - *pixel, outward = pixels[i] - middle;
      squares += residual.squaredNorm();
      radial.emplace_back(outward.norm(), residual.dot(outward) / std::max(outward.norm(), 1e-9));
      if (has_last) {
        products += residual.dot(last);
        neighbours += 0.5 * (residual.squaredNorm() + last.squaredNorm());
      }
      last = residual, has_last = true;
    }
  }
  LensMisfit misfit;
  if (!(squares > 0)) return misfit;
  misfit.rms = std::sqrt(squares / static_cast<double>(radial.size()));
  misfit.likeness = neighbours > 0 ? products / neighbours : 0;
  std::ranges::sort(radial);
  constexpr std::size_t rings = 10;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const std::size_t from = ring * radial.size() / rings, to = (ring + 1) * radial.size() / rings;
    double sum = 0;
    for (std::size_t i = from; i < to; ++i) sum += radial[i].second;
    if (to > from) misfit.radial_share += sum * sum / static_cast<double>(to - from) / squares;
  }
  return misfit;
}

LensMisfit worst_misfit(std::span<const Vector2d> points, std::span<const BoardView> views,
                        const BoardBundle& bundle) {
  LensMisfit worst;
  for (std::size_t camera = 0; camera < bundle.lenses.size(); ++camera) {
    const LensMisfit own = lens_misfit(points, views, bundle, camera);
    if (own.rms > worst.rms) worst = own;
  }
  return worst;
}

}  // namespace flexura
