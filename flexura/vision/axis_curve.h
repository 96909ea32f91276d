#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/arm_finder.h"
#include "flexura/vision/curve_smoother.h"
#include "flexura/vision/tube_tracker.h"

namespace flexura {

/// Computes a smooth centerline from the cross-sections of a tube. Measures the cross-sections again along
/// the normals of the curve, and smooths them according to the noise. After the first pictures, it allocates
/// no more memory.
class AxisCurve {
 public:
  /// Computes the axis and the ends of `seen`, in the order of `sections`. `stops`: the reasons why tracking
  /// ended at the first and at the last section. Returns false if no centerline remains.
  template <typename Value>
  bool fit(TubeTracker<Value>& tracker, const std::array<TrackEnd, 2>& stops,
           std::vector<CrossSection>& sections, ArmObservation& seen);

 private:
  void load(std::span<const CrossSection> sections);
  void smooth_by_noise(std::span<const CrossSection> sections, double step, double sigma);
  void take(std::span<const CrossSection> sections, double step, double blur, double sigma,
            std::vector<AxisSample>& axis);
  void flag_neighbours(std::vector<AxisSample>& axis);

  CurveSmoother smoother_;
  std::vector<CurveSmoother::Values> smooth_;
  std::vector<double> weights_, strengths_;
  std::vector<std::size_t> unreliable_;
};

extern template bool AxisCurve::fit(TubeTracker<std::uint8_t>&, const std::array<TrackEnd, 2>&,
                                    std::vector<CrossSection>&, ArmObservation&);
extern template bool AxisCurve::fit(TubeTracker<std::uint16_t>&, const std::array<TrackEnd, 2>&,
                                    std::vector<CrossSection>&, ArmObservation&);

}  // namespace flexura
