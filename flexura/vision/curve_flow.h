#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// How a curve moves from one picture to the next, at each sample of the first one's axis.
struct CurveFlow {
  /// Along the sample's normal, px: all of the motion that an arm without texture shows. Not a number where
  /// the normal does not meet the later axis within the arm's width, or one of the two is not seen there.
  std::vector<double> normal;
  /// By how much the axis turns there, rad, from u towards v: n . (dv/ds) / |dp/ds| for small motions.
  std::vector<double> turn;
};
/// One entry of each a sample of `before`.
[[nodiscard]] CurveFlow curve_flow(const std::vector<AxisSample>& before,
                                   const std::vector<AxisSample>& after);

/// How motion in pictures is found.
enum class FlowMethod {
  lucas_kanade,  ///< Pyramidal (J.-Y. Bouguet, 2001), at the places alone; OpenCV's.
  dis,           ///< Dense inverse search (T. Kroeger et al., 2016), of the whole picture; OpenCV's.
};

/// How far what is seen at places moves from one gray picture to the next of the same size, px; none where it
/// is not found again. std::invalid_argument: pictures of different sizes, or not gray.
[[nodiscard]] std::vector<std::optional<Eigen::Vector2d>> flow_at(
    const Image<std::uint8_t>& before, const Image<std::uint8_t>& after,
    std::span<const Eigen::Vector2d> places, FlowMethod method = FlowMethod::lucas_kanade);

/// Angles of a curve's tangent, integrated from their turns from picture to picture and drawn back to
/// measured angles, since what is integrated drifts.
class AngleIntegrator {
 public:
  /// Starts at measured angles, rad.
  explicit AngleIntegrator(std::vector<double> angles) : angles_(std::move(angles)) {}

  /// As they stand now, rad; not brought within a turn.
  [[nodiscard]] const std::vector<double>& angles() const { return angles_; }
  /// Adds turns, rad; those that are not numbers count as their neighbours'. std::invalid_argument: another
  /// number of them.
  void add(std::span<const double> turns);
  /// Moves the angles by `share` (0 to 1) of the way to measured ones, by the shorter way around; those that
  /// are not numbers leave theirs. Returns the root mean square of what they were off, rad: the drift.
  double anchor(std::span<const double> measured, double share = 1);

 private:
  std::vector<double> angles_;
};

}  // namespace flexura
