#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/border.h"
#include "flexura/vision/threshold.h"

namespace flexura {

struct ArmScene;
struct Photograph;

/// Settings of the search for an arm in pictures.
struct ArmFinderConfig {
  ThresholdConfig threshold;  ///< Separation of foreground and background.
  /// A pixel (u, v) near the arm's base, px. Among several figures the nearest is measured, and its end at
  /// this pixel is the base. Default: the largest figure; if the picture's border cuts exactly one end of the
  /// arm, the base is this end, otherwise the lower end in the picture.
  std::optional<Eigen::Vector2d> base;
  /// Whether a tube that continues beyond the base, such as a post of the arm's width, is cut at the base.
  /// Use it only if the base is known to a few pixels.
  bool cuts_at_base = false;
  /// Lower bound on the standard deviations of samples, px.
  double least_sigma = 0;
  /// Least and greatest expected width of the arm, px. Figures of another width are measured only if no other
  /// is left.
  std::optional<std::array<double, 2>> width = {};
  /// Whether the methods `two_mode` and `by_block` are tried if `otsu` shows no arm. A picture without arm
  /// then takes three searches.
  bool tries_other_methods = true;
  /// What separates the arm from its surroundings besides brightness; null: nothing.
  std::shared_ptr<const ArmScene> scene = {};
};

/// A sample of a centerline in a picture.
struct AxisSample {
  /// Point of the centerline, px; (0, 0) is the middle of the top-left pixel.
  Eigen::Vector2d pixel = {0, 0};
  Eigen::Vector2d normal = {
      /// Unit normal of the centerline: the direction from base to tip, rotated by 90 degrees from u towards
      /// v.
      0, 1};
  double width = 0;  ///< Distance between the arm's borders along the normal, px.
  double sigma = 0;  ///< Standard deviation of `pixel` along the normal, px.
  /// Whether both borders are visible; otherwise the sample is extrapolated from its neighbours.
  bool is_seen = false;
};

/// Reason why an observed centerline ends.
enum class AxisEndKind {
  free,    ///< The arm's end is visible; AxisEnd::pixel is where the arm's sides end.
  border,  ///< The picture's border cuts the arm.
  lost,    ///< The arm's borders are no longer visible.
};
const std::vector<std::string>& names_of(const AxisEndKind*);

/// An end of an observed centerline.
struct AxisEnd {
  AxisEndKind kind = AxisEndKind::lost;
  Eigen::Vector2d pixel = {0, 0};  ///< Position of the centerline's end, px.
  /// Distance by which the silhouette extends beyond `pixel`, px. It is above 0 for a round end, and for an
  /// end that does not face sideways in the picture.
  double bulge = 0;
  double sigma = 0;  ///< Standard deviation of `pixel` along the centerline at a free end, px.
};

/// Observation of an arm in one picture.
struct ArmObservation {
  Threshold threshold;             ///< Threshold that separates the arm from the background.
  std::string reason;              ///< Reason why no arm was found; otherwise "".
  std::vector<std::string> notes;  ///< Further messages about the picture, for the user.
  std::vector<AxisSample> axis;    ///< Samples of the centerline from base to tip, one or two pixels apart.
  std::array<AxisEnd, 2> ends;     ///< End at the base and end at the tip.
  /// Standard deviation of the blur of the arm's borders, including the blur by the pixels, px.
  double blur = 0;
  double noise = 0;        ///< Standard deviation of the picture's noise, on a scale from 0 to 255.
  double contrast = 0;     ///< Contrast across the arm's borders, on a scale from 0 to 255.
  bool is_closed = false;  ///< Whether the centerline is a closed curve without ends.
  double covered = 0;      ///< Fraction of the silhouette that is covered by the centerline and its widths.
  /// Points of the silhouette's outer border that are not on the borders of the measured tube; only if
  /// `covered` is small. Without a centerline, it has all points of the outer border.
  std::vector<BorderPoint> unexplained;
  /// Whether the arm contradicts the base or the width in the settings. A note says how.
  bool contradicts = false;
  /// Sample points over the whole silhouette, px (strew() in runs.h); empty if no arm was found.
  std::vector<Eigen::Vector2d> places;

  [[nodiscard]] bool is_found() const { return !axis.empty(); }
  /// Returns whether the centerline covers nearly all of the silhouette. Otherwise its ends may be at a
  /// crossing of the arm with itself instead of the arm's ends.
  [[nodiscard]] bool is_whole() const { return covered >= 0.95; }
};

/// Finds the arm in pictures (docs/vision.md). The steps are a threshold, runs of pixels, connected
/// components, and tracking of the tube's two borders with subpixel accuracy. If the threshold of the method
/// `otsu` shows no arm, the methods `two_mode` and `by_block` are tried. A frame around the picture is
/// left out. After the first pictures, it allocates no more memory, except for these two cases and for a
/// scene. The result depends only on the picture and the prediction, not on earlier pictures.
class ArmFinder {
 public:
  /// Makes a finder that uses `config` for every picture.
  explicit ArmFinder(ArmFinderConfig config = {});
  ~ArmFinder();
  /// After a move, the moved-from finder supports only assignment and destruction.
  ArmFinder(ArmFinder&&) noexcept;
  ArmFinder& operator=(ArmFinder&&) noexcept;

  /// Sets the thresholding method for the next pictures, and whether others are tried if `first` is `otsu`.
  void set_methods(ThresholdMethod first, bool tries_others);

  /// Sets where the next picture should show the arm's centerline, from base to tip, px: a prediction that is
  /// right to about the arm's width. The arm is then tracked from the prediction. If the result does not
  /// agree with the prediction, the picture is searched as without it.
  void expect(std::span<const Eigen::Vector2d> axis);

  /// Finds the arm in a gray picture. The result is valid until the next call. Throws std::invalid_argument
  /// for a picture with more than one channel.
  const ArmObservation& find(const Image<std::uint8_t>& gray);
  /// Finds the arm in a picture with more than 8 bits per value, whose brightness is from 0 to `white`.
  const ArmObservation& find(const Image<std::uint16_t>& gray, int white = 65535);
  /// Finds the arm in a picture, gray or in colour, whose largest value is `white`. Throws
  /// std::invalid_argument if `white` is below 1.
  const ArmObservation& find(const Picture& picture, int white);
  /// Finds the arm in a picture from a file, with all bits of its values. For a mask, standard deviations are
  /// at least `mask_sigma`.
  const ArmObservation& find(const Photograph& photograph);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace flexura
