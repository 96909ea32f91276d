#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/border.h"
#include "flexura/vision/threshold.h"

namespace flexura {

struct Photograph;

/// Prior knowledge of the pictures, and the segmentation of the arm.
struct ArmFinderConfig {
  ThresholdConfig threshold;  ///< Separation of foreground and background.
  /// A point near the arm's base, px. Default: the end cut by the picture's border, if one is, otherwise the
  /// lower one in the picture.
  std::optional<Eigen::Vector2d> base;
  /// Lower bound on the samples' standard deviations, px.
  double least_sigma = 0;
};

/// A point of a centerline.
struct AxisSample {
  /// Point of the centerline, px; (0, 0) is the middle of the top-left pixel.
  Eigen::Vector2d pixel = {0, 0};
  Eigen::Vector2d normal = {0, 1};  ///< A unit vector: the direction from base to tip, turned from u to v.
  double width = 0;                 ///< Distance of the borders along the normal, px.
  double sigma = 0;                 ///< Standard deviation of `pixel` along the normal, px.
  bool is_seen = false;  ///< Whether both borders are visible; otherwise the sample continues its neighbours.
};

/// Reason why an axis ends.
enum class AxisEndKind {
  free,    ///< The arm ends: `pixel` is where its sides do.
  border,  ///< Cut by the picture's border.
  lost,    ///< Its borders are no longer visible.
};
const std::vector<std::string>& names_of(const AxisEndKind*);

/// An end of a centerline and its reason.
struct AxisEnd {
  AxisEndKind kind = AxisEndKind::lost;
  Eigen::Vector2d pixel = {0, 0};  ///< Position of the axis's end, px.
  /// How far the silhouette extends beyond `pixel`, px: an end seen at an angle, or a round one.
  double bulge = 0;
  double sigma = 0;  ///< Standard deviation of `pixel` along the axis at a free end, px.
};

/// Observation of an arm in one picture.
struct ArmObservation {
  Threshold threshold;
  std::string reason;              ///< Why there is no axis; "" if there is one.
  std::vector<std::string> notes;  ///< Further messages about the picture.
  std::vector<AxisSample> axis;    ///< Samples from the base on, one or two pixels apart.
  std::array<AxisEnd, 2> ends;     ///< Base and tip.
  double blur = 0;                 ///< Blur of its borders as sampled, a standard deviation, px.
  double noise = 0;                ///< Noise of the picture, a standard deviation, of 0 to 255.
  double contrast = 0;             ///< Contrast across its borders, of 0 to 255.
  bool is_closed = false;          ///< Whether the axis is a closed curve without ends.
  double covered = 0;              ///< Share of the silhouette covered by the axis and its widths.
  /// If that is small: the points of the outer border that the axis does not explain; all of them if there is
  /// no axis.
  std::vector<BorderPoint> unexplained;
  /// Sample points over the silhouette, px (runs.h, strew); empty if there is no axis.
  std::vector<Eigen::Vector2d> places;

  [[nodiscard]] bool is_found() const { return !axis.empty(); }
  /// Returns whether the axis covers nearly all of the silhouette. Otherwise its ends may be those of a fold,
  /// not of the arm.
  [[nodiscard]] bool is_whole() const { return covered >= 0.95; }
};

/// Finds the arm in pictures: threshold, runs, components, then the tube's two borders, cross-section by
/// cross-section, with subpixel accuracy (docs/vision.md). After the first pictures it allocates no more. The
/// result depends on the picture alone, not on earlier ones.
class ArmFinder {
 public:
  /// `config` holds for every picture.
  explicit ArmFinder(ArmFinderConfig config = {});
  ~ArmFinder();
  /// After a move, the source supports only assignment and destruction.
  ArmFinder(ArmFinder&&) noexcept;
  ArmFinder& operator=(ArmFinder&&) noexcept;

  /// Finds the arm in a gray picture; the result is valid until the next call. Throws std::invalid_argument
  /// for more than one channel.
  const ArmObservation& find(const Image<std::uint8_t>& gray);
  /// Finds the arm in a picture with more than 8 bits; brightness counts from 0 to `white`.
  const ArmObservation& find(const Image<std::uint16_t>& gray, int white = 65535);
  /// Finds the arm in any picture, gray or in colour, with the largest value `white`. Throws
  /// std::invalid_argument if `white` is below 1.
  const ArmObservation& find(const Picture& picture, int white);
  /// Finds the arm in a picture from a file, with all its bits. In a mask, `mask_sigma` is a lower bound on
  /// standard deviations.
  const ArmObservation& find(const Photograph& photograph);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace flexura
