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

/// What is known of the picture beforehand, and how it is told what is arm.
struct ArmFinderConfig {
  ThresholdConfig threshold;  ///< How arm and ground are told apart.
  /// A place near the arm's base, px. Left out: the end that the picture's border cuts, if one is, else the
  /// lower one in the picture.
  std::optional<Eigen::Vector2d> base;
  /// No sample's standard deviation is taken to be less, px.
  double least_sigma = 0;
};

/// A point of a median axis.
struct AxisSample {
  Eigen::Vector2d pixel = {0, 0};   ///< On the middle line, px; (0, 0) is the middle of the top-left pixel.
  Eigen::Vector2d normal = {0, 1};  ///< A unit vector: the direction from base to tip, turned from u to v.
  double width = 0;                 ///< Between the borders along the normal, px.
  double sigma = 0;                 ///< Standard deviation of `pixel` along the normal, px.
  bool is_seen = false;             ///< Both borders are; otherwise what is near carries over.
};

/// Why an axis ends where it does.
enum class AxisEndKind {
  free,    ///< The arm ends: `pixel` is where its sides do.
  border,  ///< Cut by the picture's border.
  lost,    ///< Its borders are seen no more.
};
const std::vector<std::string>& names_of(const AxisEndKind*);

/// Where the median axis ends, and why there.
struct AxisEnd {
  AxisEndKind kind = AxisEndKind::lost;
  Eigen::Vector2d pixel = {0, 0};  ///< Where the axis ends, px.
  /// How far the silhouette reaches beyond `pixel`, px: an end seen at an angle, or a round one.
  double bulge = 0;
  double sigma = 0;  ///< Of a free end: standard deviation of `pixel` along the axis, px.
};

/// What is seen of an arm in one picture.
struct ArmSighting {
  Threshold threshold;
  std::string reason;              ///< Why there is no axis; "" when there is one.
  std::vector<std::string> notes;  ///< What else there is to know of the picture.
  std::vector<AxisSample> axis;    ///< From the base on, one or two pixels apart.
  std::array<AxisEnd, 2> ends;     ///< Base and tip.
  double blur = 0;                 ///< Of its borders as they are sampled, a standard deviation, px.
  double noise = 0;                ///< Of the picture, a standard deviation, of 0 to 255.
  double contrast = 0;             ///< Across its borders, of 0 to 255.
  bool is_closed = false;          ///< The axis comes back to where it starts: it has no ends.
  double covered = 0;              ///< The share of the silhouette that the axis and its widths explain.
  /// Where that is little: the points of the figure's outer border that they do not explain; all of them
  /// where there is no axis.
  std::vector<BorderPoint> unexplained;
  /// Places strewn over the silhouette, px (runs.h, strew); none where there is no axis.
  std::vector<Eigen::Vector2d> places;

  [[nodiscard]] bool is_found() const { return !axis.empty(); }
  /// The axis explains nearly all of the silhouette. Otherwise its ends may be a fold's, not the arm's.
  [[nodiscard]] bool is_whole() const { return covered >= 0.95; }
};

/// Finds the arm in pictures: threshold, runs, components, then the tube's two borders, cross-section by
/// cross-section, each to a small part of a pixel (docs/vision.md). Reused, it allocates no more. The same
/// picture gives the same answer, whatever was seen before.
class ArmFinder {
 public:
  /// `config` holds for every picture.
  explicit ArmFinder(ArmFinderConfig config = {});
  ~ArmFinder();
  /// One that was moved from can be assigned to and destroyed, and nothing else.
  ArmFinder(ArmFinder&&) noexcept;
  ArmFinder& operator=(ArmFinder&&) noexcept;

  /// Of a gray picture; valid until the next call. std::invalid_argument: more than one channel.
  const ArmSighting& find(const Image<std::uint8_t>& gray);
  /// Of one with more than 8 bits; brightness counts from 0 to `white`.
  const ArmSighting& find(const Image<std::uint16_t>& gray, int white = 65535);
  /// Of any, gray or in colour, whose largest value is `white`. std::invalid_argument: that is below 1.
  const ArmSighting& find(const Picture& picture, int white);
  /// Of a picture from a file, with all the bits that it has; nothing in a mask is known better than
  /// `mask_sigma`.
  const ArmSighting& find(const Photograph& photograph);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace flexura
