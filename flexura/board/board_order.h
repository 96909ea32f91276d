#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/board/board_alone.h"
#include "flexura/board/board_bundle.h"
#include "flexura/math/pose.h"

namespace flexura {

/// Order of a board's points. Point i of this order is point order[i] of the board's own order.
using PointOrder = std::vector<std::size_t>;

/// Brings the pixels of one picture into another order.
void put_in_order(const PointOrder& order, std::vector<Eigen::Vector2d>& pixels);

/// Poses of a camera relative to the first camera, for one choice of the orders in which the camera counts
/// the board's points.
struct OrderChoice {
  std::vector<CameraStep> steps;    ///< One pose for each view in which both cameras saw the board.
  std::vector<std::size_t> orders;  ///< Index of the order that brings the camera's pixels of this view into
                                    ///< the first camera's order, for each step.
  /// Disagreement of the views about the pose: mean rotation, rad, plus mean distance in distances of the
  /// board.
  double spread = 0;
};

/// Returns the choices of orders, the most consistent first. The pose from each view and order is a
/// hypothesis. The hypothesis determines the orders in all other views. `orders` has the orders in which the
/// board looks the same, the board's own order first. Empty if there is no common view.
[[nodiscard]] std::vector<OrderChoice> order_choices(std::span<const Eigen::Vector2d> points,
                                                     const CameraAlone& first, const CameraAlone& other,
                                                     std::span<const PointOrder> orders);

/// Brings the pixels of all cameras except `reference` into the order that fits the board at X_1B best.
void put_in_best_order(std::span<const Eigen::Vector2d> points, std::span<const PointOrder> orders,
                       const BoardBundle& bundle, std::size_t reference, const Pose& X_1B, BoardView& view);

}  // namespace flexura
