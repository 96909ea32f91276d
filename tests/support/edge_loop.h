#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "flexura/control/contour_images.h"
#include "flexura/control/image_law.h"
#include "flexura/control/limiter.h"
#include "tests/support/servo_loop.h"

namespace flexura {

/// The same loop as servo(), of the edges of both images, six places along the arm; derivatives and normals
/// are those of the arm that the cameras are believed to see.
inline ServoEnd servo_by_edges(const ServoLoop& loop, const ArmState& start, const ArmState& target,
                               double seconds) {
  ServoEnd ended;
  const ImageLaw law(loop.arm, {.rate = loop.rate, .damping = 0.002, .most_step = loop.most_step});
  CommandLimiter limiter(loop.arm, {.step = servo_step, .looks_ahead = false}, start);
  ContourImages contours(loop.arm, {1.0 / 6, 2.0 / 6, 3.0 / 6, 4.0 / 6, 5.0 / 6, 1});
  const ArmState wanted = loop.mechanism(target);
  ContourImage at;
  std::array<Eigen::Matrix2Xd, 2> desired, seen, normals;
  const auto look = [&](const ArmState& state, std::array<Eigen::Matrix2Xd, 2>& pixels) {
    contours.set(state);
    for (std::size_t i = 0; i < 2; ++i) {
      if (!contours.see(loop.truth[i], at)) return false;
      pixels[i] = at.pixels;
      if (&pixels == &desired) normals[i] = at.normals;
    }
    return true;
  };
  if (!look(wanted, desired)) return ended.is_lost = true, ended;
  const Eigen::Index rows = contours.count();
  Eigen::VectorXd error(2 * rows);
  Eigen::MatrixXd by_state(2 * rows, contours.columns());
  for (int k = 0; k < static_cast<int>(seconds / servo_step); ++k) {
    const ArmState now = loop.mechanism(limiter.sent());
    if (shape_error(loop.arm, now, wanted) > 0.02) ended.settled = k * servo_step;
    if (!look(now, seen)) return ended.is_lost = true, ended;
    contours.set(limiter.sent());
    for (std::size_t i = 0; i < 2; ++i) {
      const Eigen::Index first = static_cast<Eigen::Index>(i) * rows;
      if (!contours.see(loop.model[i], at)) return ended.is_lost = true, ended;
      contour_error(at, seen[i], desired[i], normals[i], error.segment(first, rows));
      contours.derive(loop.model[i], at, by_state.middleRows(first, rows));
    }
    (void)limiter.next(law.step(limiter.sent(), error, law.by_variables(by_state), servo_step).asked);
  }
  ended.error = shape_error(loop.arm, loop.mechanism(limiter.sent()), wanted);
  return ended;
}

}  // namespace flexura
