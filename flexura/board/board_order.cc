#include "flexura/board/board_order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "flexura/math/so3.h"

namespace flexura {
namespace {

using Eigen::Vector2d;

// Motion X_BB' of the board's frame that makes the points of an order the points of the board's own order.
Pose motion_of(std::span<const Vector2d> points, const PointOrder& order) {
  const Vector2d from = points[1] - points[0], to = points[order[1]] - points[order[0]];
  const double angle = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
  Pose motion;
  motion.rotation = so3_exp({0, 0, angle});
  const Vector2d moved = motion.rotation.topLeftCorner<2, 2>() * points[0];
  motion.position.head<2>() = points[order[0]] - moved;
  return motion;
}

}  // namespace

void put_in_order(const PointOrder& order, std::vector<Vector2d>& pixels) {
  std::vector<Vector2d> ordered;
  ordered.reserve(pixels.size());
  for (const std::size_t point : order) ordered.push_back(pixels[point]);
  pixels = std::move(ordered);
}

std::vector<OrderChoice> order_choices(std::span<const Vector2d> points, const CameraAlone& first,
                                       const CameraAlone& other, std::span<const PointOrder> orders) {
  struct Candidate {
    std::vector<Pose> X_1C;  // For each order.
    double depth = 1;        // Distance of the board, m.
    std::size_t view = 0;
  };
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < first.views.size(); ++i) {
    const auto same = std::ranges::find(other.views, first.views[i]);
    if (same == other.views.end()) continue;
    const Pose &X_1B = first.fit.bundle.boards[i],
               &X_CB = other.fit.bundle.boards[static_cast<std::size_t>(same - other.views.begin())];
    Candidate& candidate = candidates.emplace_back();
    candidate.view = *same;
    candidate.depth = std::max(X_1B.position.norm(), 1e-9);
    for (const PointOrder& order : orders)
      candidate.X_1C.push_back(X_1B * (X_CB * motion_of(points, order)).inverse());
  }
  std::vector<OrderChoice> choices;
  for (const Candidate& guess : candidates) {
    for (const Pose& X_1C : guess.X_1C) {
      OrderChoice choice;
      for (const Candidate& candidate : candidates) {
        const auto apart = [&](const Pose& own) {
          return so3_log(X_1C.rotation.transpose() * own.rotation).norm() +
                 (own.position - X_1C.position).norm() / candidate.depth;
        };
        const auto nearest = std::ranges::min_element(candidate.X_1C, {}, apart);
        choice.steps.push_back({candidate.view, *nearest});
        choice.orders.push_back(static_cast<std::size_t>(nearest - candidate.X_1C.begin()));
        choice.spread += apart(*nearest) / static_cast<double>(candidates.size());
      }
      const auto same = std::ranges::find(choices, choice.orders, &OrderChoice::orders);
      if (same == choices.end()) {
        choices.push_back(std::move(choice));
      } else {
        same->spread = std::min(same->spread, choice.spread);
      }
    }
  }
  std::ranges::stable_sort(choices, {}, &OrderChoice::spread);
  return choices;
}

void put_in_best_order(std::span<const Vector2d> points, std::span<const PointOrder> orders,
                       const BoardBundle& bundle, std::size_t reference, const Pose& X_1B, BoardView& view) {
  for (std::size_t camera = 0; camera < view.pixels.size(); ++camera) {
    if (camera == reference || view.pixels[camera].empty() || orders.size() < 2) continue;
    const std::vector<Vector2d> seen = view.pixels[camera];
    std::vector<Vector2d> best = seen;
    double least = std::numeric_limits<double>::infinity();
    for (const PointOrder& order : orders) {
      view.pixels[camera] = seen;
      put_in_order(order, view.pixels[camera]);
      const auto sum = square_sum(points, view, bundle, camera, X_1B);
      if (sum && *sum < least) least = *sum, best = view.pixels[camera];
    }
    view.pixels[camera] = std::move(best);
  }
}

}  // namespace flexura
