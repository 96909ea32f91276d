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

/// Cross-section of a tube in a picture: the intersection of a line with the tube's two borders.
struct CrossSection {
  Eigen::Vector2d center = {0, 0};  ///< Middle between the borders, px.
  /// Unit vector along the line: the direction of tracking, rotated by 90 degrees from u towards v.
  Eigen::Vector2d normal = {0, 1};
  double half_width = 0;  ///< Half of the tube's width, px.
  std::array<bool, 2> is_seen = {
      false, false};  ///< Visibility of the border on the normal's side, and of the border on the other side.

  [[nodiscard]] bool is_whole() const { return is_seen[0] && is_seen[1]; }
};

/// Reason why tracking a tube ended.
enum class TrackEnd {
  free,    ///< The tube ends.
  border,  ///< The tube leaves the picture.
  lost,    ///< The tube's borders are no longer visible, although the tube does not end.
  closed,  ///< The tube returns to the start of the tracking.
};

/// Tracks a tube through a picture with a cross-section every one or two pixels. Position, direction and
/// curvature of each section are predicted by a fading-memory filter, and then measured on both borders. If
/// one border is invisible, tracking continues with the other border and the known width. If both borders are
/// invisible (where the tube crosses itself, or a hair covers it), tracking continues along the predicted arc
/// for several tube widths.
template <typename Value>
class TubeTracker {
 public:
  /// `level` is the threshold between foreground and background. `contrast` is the approximate smallest
  /// contrast of a border.
  TubeTracker(const Image<Value>& picture, Figure figure, double level, double contrast, BlurredSteps& steps);

  /// The tracking ends where `inside` is 0, as it does at the picture's border. Null: it ends only at the
  /// border. The image must have the picture's size and outlive the tracker.
  void stay_inside(const Image<std::uint8_t>* inside) { inside_ = inside; }

  /// Returns the cross-section near the pixel `center`. `normal`: approximate direction across the tube.
  /// Returns std::nullopt if the borders are not found.
  [[nodiscard]] std::optional<CrossSection> seed(const Eigen::Vector2d& center, const Eigen::Vector2d& normal,
                                                 double half_width);
  /// Tracks the tube from the cross-section `seed`, along the tangent (`way` 1) or against the tangent (`way`
  /// -1). Appends the cross-sections, without the seed, to `sections`.
  TrackEnd follow(const CrossSection& seed, int way, std::vector<CrossSection>& sections);
  /// Measures again a cross-section whose position is already known to a fraction of a pixel. Invisible
  /// borders remain invisible. `widening` is the change of the half width per pixel along the tangent.
  void refine(CrossSection& section, double widening);
  /// Measures the blur of the borders at the sections with two visible borders.
  void measure_blur(std::span<const CrossSection> sections);

  [[nodiscard]] const EdgeFinder<Value>& edges() const { return edges_; }
  [[nodiscard]] double level() const { return level_; }
  /// Returns the distance between cross-sections, px: 1 for a thin tube, 2 for a wide tube.
  [[nodiscard]] double step() const { return step_; }
  /// Returns the standard deviation of the borders' blur, px.
  [[nodiscard]] double blur() const { return blur_; }
  /// Returns the standard deviation of the picture's noise, estimated at the borders, and the contrast of the
  /// borders.
  [[nodiscard]] double noise() const { return noise_; }
  [[nodiscard]] double contrast() const { return contrast_; }
  /// Returns the standard deviation of a border's position, px.
  [[nodiscard]] double sigma() const { return sigma_ * noise_ / contrast_; }

 private:
  struct State;
  // Gains of the filter: corrections of the state per unit of prediction error.
  struct Gains {
    explicit Gains(double step);
    double position, direction, curvature, width, widening;
  };
  struct Look {
    std::optional<double> offset;
    bool is_outside = false;  // Outside the picture.
  };
  [[nodiscard]] Look look(const Eigen::Vector2d& from, const Eigen::Vector2d& outward,
                          const Eigen::Vector2d& normal, double half_width, double capture);
  CrossSection meet(State& state, const Gains& gains, int way);
  void count(State& state, const CrossSection& section) const;
  [[nodiscard]] std::optional<TrackEnd> stop(const State& state) const;
  [[nodiscard]] bool is_figure(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] bool is_in_view(const Eigen::Vector2d& pixel) const;
  void guess_blur(const CrossSection& section);

  EdgeFinder<Value> edges_;
  const Image<std::uint8_t>* inside_ = nullptr;
  double level_, contrast_, noise_, blur_ = 0.8, sigma_ = 2.5, step_ = 1;
};

extern template class TubeTracker<std::uint8_t>;
extern template class TubeTracker<std::uint16_t>;

}  // namespace flexura
