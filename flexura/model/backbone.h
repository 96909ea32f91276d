#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Returns the frame at the end of an arc, in the frame at its start (origin there, z along the tangent). The
/// arc is `length` m long and bent by `bend` rad; smooth through bend = 0. With t = |bend| its end is at
/// length (bend_x (1 - cos t)/t^2, bend_y (1 - cos t)/t^2, sin t/t). It is rotated by the rotation vector
/// (-bend_y, bend_x, 0).
[[nodiscard]] Pose arc_pose(const Eigen::Vector2d& bend, double length);
/// Returns the arc's end for known sinc(t) and cosc(t) (math/series.h).
[[nodiscard]] Pose arc_pose(const Eigen::Vector2d& bend, double length, double sinc_t, double cosc_t);

/// One circular arc of a backbone with its tube: discs with their centres along the arc, perpendicular to it.
/// Their radius is linear in arc length.
struct Arc {
  Pose X_WS;                                       ///< Frame at the arc's start; z is the tangent.
  double s = 0.0;                                  ///< Arc length from the arm's base to the arc's start, m.
  double length = 0.0;                             ///< In m, with stretch.
  Eigen::Vector2d bend = Eigen::Vector2d::Zero();  ///< In rad, over the whole arc.
  double twist = 0.0;        ///< Rotation of the material about the tangent over the whole arc, rad.
  double s_rest = 0.0;       ///< Arc length of its start on the arm at rest (straight, not stretched), m.
  double rest_length = 0.0;  ///< Its length at rest, m.
  std::array<double, 2> radius = {0.02, 0.02};  ///< At the arc's start and end, m; > 0.
  std::size_t section = 0;                      ///< Section of the arm, 0 at the base.

  /// Returns the frame at `distance` in [0, length] m along the arc, in W.
  [[nodiscard]] Pose pose(double distance) const;
  /// Returns the frame without the twist: X_WS moved along the arc, so that `bend` has the same components as
  /// at the start.
  [[nodiscard]] Pose carried(double distance) const;
};

/// A point of a backbone of any shape.
struct BackboneSample {
  Pose X_WS;          ///< z is the tangent; x and y rotate with the material.
  double s_rest = 0;  ///< Arc length from the base along the arm at rest, m; increases from sample to sample.
  double radius = 0.02;     ///< m; > 0.
  std::size_t section = 0;  ///< Section of the arm, from this sample to the next.
};

/// The arm's centreline in the world: a chain of circular arcs, each tangent to the previous one. It is exact
/// for an arm whose sections are arcs. For any other curve the error is of third order in the distance of its
/// samples.
class Backbone {
 public:
  /// Places the arm's sections with the bends and stretches of `state`: one arc per section. Throws
  /// std::invalid_argument if there are no sections, not one finite bend and one stretch per section, or a
  /// length is not positive.
  Backbone(const Arm& arm, const ArmState& state);
  /// Places an arm whose sections are parts of another's: `section_of` has the other arm's section for each.
  /// Also throws std::invalid_argument unless there is one for each.
  Backbone(const Arm& arm, const ArmState& state, std::span<const std::size_t> section_of);

  /// Returns a smooth backbone through all samples: two arcs between each two consecutive samples, with a
  /// common tangent (a biarc; docs/renderer.md). Samples of a circular arc give that arc. The material
  /// rotates evenly about the tangent from sample to sample, by less than half a turn. Throws
  /// std::invalid_argument for fewer than two samples, numbers that are not finite, a radius that is not
  /// positive, or s_rest that does not increase. Also throws it for two samples in one place or a tangent
  /// against the direction to the next sample.
  [[nodiscard]] static Backbone through(std::span<const BackboneSample> samples);

  /// Returns the arcs from the base on; each section has one or more.
  [[nodiscard]] std::span<const Arc> arcs() const { return arcs_; }
  /// Returns the length, m, with stretch.
  [[nodiscard]] double length() const;
  /// Returns the length of the arm at rest, m.
  [[nodiscard]] double rest_length() const;
  /// Returns X_WS at arc length s in [0, length()], m. Values past an end by rounding (1e-12 of the length)
  /// count as that end. Throws std::out_of_range for values further outside.
  [[nodiscard]] Pose pose(double s) const;
  /// Returns X_WT, the frame at s = length().
  [[nodiscard]] const Pose& tip() const { return X_WT_; }

  /// Returns the arc length, m, on this backbone of the material that is at `s_rest` m from the base at rest.
  /// Values before the base and beyond the tip count as those.
  [[nodiscard]] double s_at_rest(double s_rest) const;
  /// Returns the arc length at rest, m, of the material at arc length s of this backbone. Values before the
  /// base and beyond the tip count as those.
  [[nodiscard]] double s_rest_at(double s) const;

 private:
  Backbone() = default;

  std::vector<Arc> arcs_;
  Pose X_WT_;
};

}  // namespace flexura
