#include "flexura/servo/view_keeper.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "flexura/estimate/backbone_pixels.h"

namespace flexura {
namespace {

double within(double value, const std::array<double, 2>& limits) {
  return std::clamp(value, limits[0], limits[1]);
}

// Returns the bounding box of the arm's image; std::nullopt if part of the arm is behind the camera.
std::optional<Eigen::AlignedBox2d> seen_box(const Arm& arm, const ArmState& state, const View& view) {
  constexpr int points = 20;
  const std::vector<Eigen::Vector2d> pixels = backbone_pixels(arm, state, view, points);
  if (pixels.size() <= points) return std::nullopt;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& pixel : pixels) box.extend(pixel);
  return box;
}

}  // namespace

ViewKeeper::ViewKeeper(const RigModel& nominal, const std::array<std::size_t, 2>& cameras)
    : arm_(nominal.arm) {
  for (const std::size_t camera : cameras) cameras_.emplace_back(nominal.cameras.at(camera));
}

std::optional<HeadState> ViewKeeper::turned(std::size_t i, const ArmState& state, const HeadState& stands,
                                            const View& view) const {
  // Shares of the picture: beyond the first the head turns, beyond the second it zooms out.
  constexpr double quiet = 0.15, full = 0.9;
  const auto box = seen_box(arm_, state, view);
  if (!box) return std::nullopt;
  const Eigen::Vector2d size(view.width, view.height), middle = 0.5 * (size - Eigen::Vector2d::Ones());
  const Eigen::Vector2d off = box->center() - middle;
  const bool is_aside = (off.cwiseAbs().array() > quiet * size.array()).any();
  const double filled = (box->sizes().array() / size.array()).maxCoeff();
  if (!is_aside && filled <= full) return std::nullopt;
  HeadState head = stands;
  const auto& axes = cameras_[i].head_axes();
  const Intrinsics& lens = view.lens.intrinsics();
  if (is_aside) {
    head.pan = within(head.pan - std::atan(off.x() / lens.fx), axes[0].limits);
    head.tilt = within(head.tilt - std::atan(off.y() / lens.fy), axes[1].limits);
  }
  if (filled > full) {
    // Of a hundred zooms, takes the one nearest to the required focal length.
    constexpr int tries = 100;
    const double desired = lens.fx * full / filled;
    double best = std::abs(cameras_[i].lens().at(head.zoom).fx - desired);
    for (int k = 0; k <= tries; ++k) {
      const double zoom = axes[2].limits[0] + (axes[2].limits[1] - axes[2].limits[0]) * k / tries;
      const double miss = std::abs(cameras_[i].lens().at(zoom).fx - desired);
      if (miss < best) best = miss, head.zoom = zoom;
    }
  }
  return head == stands ? std::nullopt : std::optional(head);
}

}  // namespace flexura
