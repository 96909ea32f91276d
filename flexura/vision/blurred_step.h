#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace flexura {

/// Result of an edge fit.
struct StepFit {
  double offset = 0;    ///< Distance of the edge from the expected position, in units of the sample distance.
  double contrast = 0;  ///< Brightness after the edge minus brightness before the edge.
  double residual = 0;  ///< Standard deviation of the difference between samples and model.
};

/// Maximum-likelihood estimator of the position of a brightness step along a line of samples with uniform
/// noise. The step is blurred by a Gaussian. The brightness on both sides is unknown. Before the edge, the
/// brightness also has an unknown slope, because a round tube is shaded towards its border. The model
///   a + g min(x - p, 0) + C H(x - p), both blurred,
/// is linearized at the expected position of the edge.
class BlurredStep {
 public:
  static constexpr int before = 6, after = 5, taps = before + 1 + after;

  /// Lengths are in units of the sample distance. `phase`: distance from the last sample before or at the
  /// expected edge to the edge. `blur` > 0: standard deviation of the total blur. `first`: number of samples
  /// used before this last sample, 1 to `before`. If `first` is below 4, the model has no slope.
  BlurredStep(double blur, double phase, int first);

  /// Returns the standard deviation of the offset for independent noise whose standard deviation equals the
  /// contrast.
  [[nodiscard]] double sigma() const { return 1 / bell_scale_; }

  /// Fits the model to samples. Unused samples are ignored but must be finite.
  [[nodiscard]] StepFit fit(const std::array<float, taps>& values) const;

 private:
  using Column = std::array<float, taps>;

  // Columns of the model, orthonormalized in this order: constant, slope, step, and the bell-shaped
  // derivative of a shift.
  Column constant_{}, slope_{}, step_{}, bell_{}, used_{};
  float used_count_ = 1, step_scale_ = 1, bell_scale_ = 1, step_of_bell_ = 0;
  int free_ = 1;
};

/// Cache of BlurredStep objects for all blurs and phases. Each is made when it is first needed. The spacing
/// is 1/32 in phase and 4 % in blur, which is fine enough.
class BlurredSteps {
 public:
  static constexpr int phases = 32;
  static constexpr double least_blur = 0.4, ratio = 1.04;

  /// Returns the step with the nearest blur and phase. `phase` is from -0.5 to 0.5. Sets `at` to the phase of
  /// the returned step.
  const BlurredStep& of(double blur, double phase, int first, double& at);

 private:
  static constexpr int blurs = 80, places = 2048;
  static constexpr double widest = 8;
  std::vector<std::unique_ptr<BlurredStep>> steps_ = std::vector<std::unique_ptr<BlurredStep>>(
      static_cast<std::size_t>(blurs) * (phases + 1) * BlurredStep::before);
  std::vector<std::uint8_t> blur_of_place_ = blur_places();  // Uniform in blur, up to the widest.

  static std::vector<std::uint8_t> blur_places();
};

/// A geometric series of blurs that are tried in order to estimate the blur of a picture.
struct BlurSeries {
  double first = 0.4, ratio = 1.25;

  [[nodiscard]] double at(std::size_t i) const { return first * std::pow(ratio, static_cast<double>(i)); }
  /// Returns the blur with the smallest residual, interpolated by a parabola through the smallest residual
  /// and its neighbours. `left`: residuals of the tried blurs, not empty. Infinite entries count as not
  /// tried.
  [[nodiscard]] double least(std::span<const double> left) const;
};

}  // namespace flexura
