#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "flexura/vision/blurred_step.h"
#include "flexura/vision/edge_finder.h"
#include "flexura/vision/threshold.h"

namespace flexura {

/// Intersection of a line across a tube with its two borders.
struct CrossSection {
  Eigen::Vector2d center = {0, 0};  ///< Half-way between the borders, px.
  /// Unit vector along the line: the direction of travel turned from u to v.
  Eigen::Vector2d normal = {0, 1};
  double half_width = 0;                         ///< Half of the tube's width, px.
  std::array<bool, 2> is_seen = {false, false};  ///< The border on the normal's side, and the other one.

  [[nodiscard]] bool is_whole() const { return is_seen[0] && is_seen[1]; }
};

/// Reason why tracking a tube ended.
enum class TrackEnd {
  free,    ///< The figure ends.
  border,  ///< The picture ends.
  lost,    ///< Its borders are no longer visible, but it does not end either.
  closed,  ///< It comes back to its start.
};

/// Tracks a tube through a picture with a cross-section every pixel or two. Each is predicted from the
/// previous ones (position, direction and curvature by a fading memory) and measured on both borders. If one
/// border is invisible, the other one continues with the known width. If both are (the tube crosses itself,
/// or a hair covers it), it continues along its arc for some widths.
template <typename Value>
class TubeTracker {
 public:
  /// `level`: of the picture, between foreground and background; `contrast`: approximate smallest contrast of
  /// an edge.
  TubeTracker(const Image<Value>& picture, Figure figure, double level, double contrast, BlurredSteps& steps);

  /// Returns the cross-section near a point, `normal` roughly across the tube; empty if its borders are not
  /// there.
  [[nodiscard]] std::optional<CrossSection> seed(const Eigen::Vector2d& center, const Eigen::Vector2d& normal,
                                                 double half_width);
  /// Tracks the tube from a seed along +tangent (`way` 1) or against it (-1) and appends the sections without
  /// the seed.
  TrackEnd follow(const CrossSection& seed, int way, std::vector<CrossSection>& sections);
  /// Measures a section again that is known to a fraction of a pixel; invisible borders stay so. `widening`:
  /// change of the half width along the tangent.
  void refine(CrossSection& section, double widening);
  /// Measures the blur of the borders at whole sections.
  void measure_blur(std::span<const CrossSection> sections);

  [[nodiscard]] const EdgeFinder<Value>& edges() const { return edges_; }
  [[nodiscard]] double level() const { return level_; }
  /// Returns the distance of cross-sections, px: 1 for a thin tube, 2 for a wide one.
  [[nodiscard]] double step() const { return step_; }
  /// Returns the standard deviation of the borders' blur, px.
  [[nodiscard]] double blur() const { return blur_; }
  /// Return the standard deviation of the picture's noise, estimated at the borders, and their contrast.
  [[nodiscard]] double noise() const { return noise_; }
  [[nodiscard]] double contrast() const { return contrast_; }
  /// Returns the standard deviation of a border's position, px.
  [[nodiscard]] double sigma() const { return sigma_ * noise_ / contrast_; }

 private:
  struct State;
  // Corrections of the state per unit of prediction error.
  struct Gains {
    explicit Gains(double step);
    double position, direction, curvature, width, widening;
  };
  struct Look {
    std::optional<double> offset;
    bool is_outside = false;  // Of the picture.
  };
  [[nodiscard]] Look look(const Eigen::Vector2d& from, const Eigen::Vector2d& outward,
                          const Eigen::Vector2d& normal, double half_width, double capture);
  CrossSection meet(State& state, const Gains& gains, int way);
  void count(State& state, const CrossSection& section) const;
  [[nodiscard]] std::optional<TrackEnd> stop(const State& state) const;
  [[nodiscard]] bool is_figure(const Eigen::Vector2d& pixel) const;
  void guess_blur(const CrossSection& section);

  EdgeFinder<Value> edges_;
  double level_, contrast_, noise_, blur_ = 0.8, sigma_ = 2.5, step_ = 1;
};

extern template class TubeTracker<std::uint8_t>;
extern template class TubeTracker<std::uint16_t>;

}  // namespace flexura
