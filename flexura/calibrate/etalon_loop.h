#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "flexura/calibrate/etalon_view.h"
#include "flexura/calibrate/look_loop.h"

namespace flexura {

/// What both ways with the cylinder begin with: the paper's special starting conditions, as far as commands
/// can set them up. Refuses cameras that look from one side, zooms to x1, and knows where the target is.
[[nodiscard]] LookLoop::Trouble begin_with_etalon(LookLoop& loop);

/// Calibrates with the calibration cylinder (section 3.4): of both cameras horizontal orientation and
/// positioning, then vertical, until all four hold in one picture, and again with the principal point that a
/// longer focal length tells: where things stay; zoom; then, of the heads' positions around, those whose axes
/// are the most nearly orthogonal. Steps are in proportion to what is missing, and shrink.
class EtalonLoop {
 public:
  explicit EtalonLoop(LookLoop& loop) : loop_(loop) {}
  [[nodiscard]] LookLoop::Trouble run();

 private:
  struct Offset;
  [[nodiscard]] LookLoop::Trouble look(std::size_t i);
  [[nodiscard]] LookLoop::Trouble align(std::size_t i);
  [[nodiscard]] LookLoop::Trouble center(std::size_t i);
  [[nodiscard]] LookLoop::Trouble into_view(std::size_t i);
  [[nodiscard]] std::array<Offset, 4> offsets(std::size_t i) const;
  [[nodiscard]] Intrinsics lens(std::size_t i) const;
  [[nodiscard]] double longer(std::size_t i) const;
  [[nodiscard]] LookLoop::Trouble zoom();
  [[nodiscard]] LookLoop::Trouble square();
  [[nodiscard]] double across(std::size_t i) const { return views_[i].bearing + views_[i].sight; }

  LookLoop& loop_;
  std::array<EtalonView, 2> views_;
  // By which each principal point is to the right of and below where the file has it, px.
  std::array<Eigen::Vector2d, 2> beside_ = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
};

}  // namespace flexura
