#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace flexura {

/// What was found of an edge.
struct StepFit {
  double offset = 0;    ///< In sample distances, from where it was looked for.
  double contrast = 0;  ///< Brightness after the edge less that before it.
  double residual = 0;  ///< Standard deviation of the samples from the model.
};

/// Where, along a line of samples, brightness steps from one value to another: the most likely place, under
/// even noise, of a step blurred by a Gaussian between brightnesses that are both unknown, the one before it
/// with an unknown slope (a round tube is shaded towards its border). The model
///   a + g min(x - p, 0) + C H(x - p), both blurred,
/// is linearized at the place where the edge is looked for.
class BlurredStep {
 public:
  static constexpr int before = 6, after = 5, taps = before + 1 + after;

  /// Of samples a unit apart, the last one before the edge or at it at -phase. `blur`: standard deviation of
  /// all that blurs the edge, in that unit; > 0. `first`: of the samples before that one so many are used
  /// (1 to `before`); with fewer than 4 there is no slope.
  BlurredStep(double blur, double phase, int first);

  /// Standard deviation of the offset, for noise as large as the contrast, the same in all samples.
  [[nodiscard]] double sigma() const { return 1 / bell_scale_; }

  /// The fit; samples that are not used do not matter, but have to be finite.
  [[nodiscard]] StepFit fit(const std::array<float, taps>& values) const;

 private:
  using Column = std::array<float, taps>;

  // The model's columns made orthonormal in this order: constant, slope, step, and the bell that a shift
  // adds.
  Column constant_{}, slope_{}, step_{}, bell_{}, used_{};
  float used_count_ = 1, step_scale_ = 1, bell_scale_ = 1, step_of_bell_ = 0;
  int free_ = 1;
};

/// Steps of every blur and phase, made when first asked for: a thirty-second of a unit of phase and 4 % of
/// blur apart, which is finer than matters.
class BlurredSteps {
 public:
  static constexpr int phases = 32;
  static constexpr double least_blur = 0.4, ratio = 1.04;

  /// `phase`: from -0.5 to 0.5. The step's own phase goes to `at`.
  const BlurredStep& of(double blur, double phase, int first, double& at);

 private:
  static constexpr int blurs = 80, places = 2048;
  static constexpr double widest = 8;
  std::vector<std::unique_ptr<BlurredStep>> steps_ = std::vector<std::unique_ptr<BlurredStep>>(
      static_cast<std::size_t>(blurs) * (phases + 1) * BlurredStep::before);
  std::vector<std::uint8_t> blur_of_place_ = blur_places();  // Even in blur, up to the widest.

  static std::vector<std::uint8_t> blur_places();
};

/// A series of blurs, each `ratio` times the one before, to find out which is a picture's.
struct BlurSeries {
  double first = 0.4, ratio = 1.25;

  [[nodiscard]] double at(std::size_t i) const { return first * std::pow(ratio, static_cast<double>(i)); }
  /// Where `left`, what remains unexplained of the picture with each, is least: between the blurs by a
  /// parabola through the least and its neighbours. Not empty; what is infinite counts as not tried.
  [[nodiscard]] double least(std::span<const double> left) const;
};

}  // namespace flexura
