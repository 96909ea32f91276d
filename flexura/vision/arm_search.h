#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/arm_finder.h"
#include "flexura/vision/axis_cover.h"
#include "flexura/vision/axis_curve.h"
#include "flexura/vision/expected_axis.h"
#include "flexura/vision/picture_frame.h"
#include "flexura/vision/runs.h"
#include "flexura/vision/threshold.h"
#include "flexura/vision/tube_seeds.h"
#include "flexura/vision/tube_tracker.h"

namespace flexura {

/// One search for the arm in a gray picture with one thresholding method: the work of ArmFinder. Buffers are
/// kept from search to search.
class ArmSearch {
 public:
  static constexpr std::int64_t least_area = 24;  ///< Smaller figures are ignored as dust, px.

  ArmFinderConfig config;
  /// Position of the searched picture's first pixel in the whole picture, px. Messages refer to the latter.
  Eigen::Vector2d origin = {0, 0};
  /// Pixels that may belong to the arm (not 0), of the size of the searched picture; null: all.
  const Image<std::uint8_t>* inside = nullptr;
  /// Whether run() stops if the picture has a frame (picture_frame.h); `part` is then the part inside.
  bool stops_at_frame = false;
  PixelBox part;
  ExpectedAxis expected;  ///< Prediction in the searched picture; may be empty.
  ArmObservation seen;    ///< Result, in pixels of the searched picture.

  /// Searches the arm. Figures are separated in `gray`, which has 8 bits; borders are measured in `picture`.
  /// `scale` is the unit of `gray` in `picture`. Returns false if it stopped at a frame.
  template <typename Value>
  bool run(const Image<Value>& picture, const Image<std::uint8_t>& gray, double scale,
           const ThresholdConfig& threshold);

  /// Returns whether this is probably the arm: hardly anything else is in the silhouette, and an end
  /// is known or the only figure is very slender.
  [[nodiscard]] bool is_clear();

  /// Returns the width of the thinnest chord of the figures that were tried, px; infinite without figures.
  [[nodiscard]] double thinnest() const { return thinnest_; }

 private:
  void segment(const Image<std::uint8_t>& gray, const ThresholdConfig& threshold);
  template <typename Value>
  void find_axis(const Image<Value>& picture, double scale);
  template <typename Value>
  bool follow_one_of_all(const Image<Value>& picture, double scale);
  template <typename Value>
  bool follow_expected(const Image<Value>& picture, double scale);
  template <typename Value>
  bool follow(const Image<Value>& picture, double scale, const Component& component);
  template <typename Value>
  void try_seeds(const Image<Value>& picture, double scale, const Component& component);
  template <typename Value>
  bool follow_from(const Image<Value>& picture, double scale, const Component& component,
                   const TubeSeed& rough);
  [[nodiscard]] std::string reason_against_following(double width) const;

  void order_figures();
  [[nodiscard]] bool has_expected_ends() const;
  [[nodiscard]] bool has_width();
  [[nodiscard]] std::string contradiction();
  void reverse();
  void order_ends();
  void begin_at_base();
  [[nodiscard]] bool ends_at_base();
  [[nodiscard]] bool is_base_visible() const;
  void note_ends();
  void note_others();
  void add_places();
  void add_unexplained(const Image<std::uint8_t>& gray);
  bool keep_thin_parts(const Image<std::uint8_t>& gray);

  ArmObservation best_, spare_, first_;
  Components components_;
  BlockThresholds blocks_;
  std::vector<std::uint32_t> order_;  // Components in the order in which they are tried.
  std::uint32_t followed_ = 0;        // The component that is the arm.
  std::vector<TubeSeed> seeds_;
  std::vector<CrossSection> ahead_, sections_;
  BlurredSteps steps_;
  AxisCurve curve_;
  AxisCover cover_;                   // Of the axis that was found.
  double least_blur_ = 0;             // Of the places from which a component was followed, px.
  double thinnest_ = 0;               // Width of the thinnest chords of the figures that are no tubes, px.
  std::vector<Eigen::Vector2d> cut_;  // The axis beyond the base.
  bool is_expected_ = false;          // Whether the axis agrees with the prediction.
  bool is_part_ = false;              // Whether wider parts of the figure were removed.
  int width_ = 0, height_ = 0;        // Of the picture, px.
  std::vector<double> widths_, distances_;
  std::vector<std::uint32_t> by_area_;
};

extern template bool ArmSearch::run(const Image<std::uint8_t>&, const Image<std::uint8_t>&, double,
                                    const ThresholdConfig&);
extern template bool ArmSearch::run(const Image<std::uint16_t>&, const Image<std::uint8_t>&, double,
                                    const ThresholdConfig&);

}  // namespace flexura
