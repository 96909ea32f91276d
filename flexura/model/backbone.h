#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

/// The frame at the end of an arc, in the frame at its start (origin there, z along the tangent): an arc of
/// `length` m bent by `bend` rad, smooth through bend = 0. With t = |bend| its end lies at length (bend_x (1
/// - cos t)/t^2, bend_y (1 - cos t)/t^2, sin t/t), turned by the rotation vector (-bend_y, bend_x, 0).
[[nodiscard]] Pose arc_pose(const Eigen::Vector2d& bend, double length);
/// The same for who knows sinc(t) and cosc(t) (math/series.h).
[[nodiscard]] Pose arc_pose(const Eigen::Vector2d& bend, double length, double sinc_t, double cosc_t);

/// One circular arc of a backbone, with the tube around it: the discs whose centres run along the arc,
/// perpendicular to it, their radius linear in arc length.
struct Arc {
  Pose X_WS;                                       ///< Frame at the arc's start; z is the tangent.
  double s = 0.0;                                  ///< Arc length from the arm's base to the arc's start, m.
  double length = 0.0;                             ///< m, stretch included.
  Eigen::Vector2d bend = Eigen::Vector2d::Zero();  ///< rad, over the whole arc.
  double twist = 0.0;        ///< Of the material about the tangent, over the whole arc, rad.
  double s_rest = 0.0;       ///< Where the arc starts along the arm at rest (straight, not stretched), m.
  double rest_length = 0.0;  ///< And how long it is there, m.
  std::array<double, 2> radius = {0.02, 0.02};  ///< At the arc's start and end, m; > 0.
  std::size_t section = 0;                      ///< Of the arm, 0 at the base.

  /// Frame at `distance` in [0, length] m along the arc, in W.
  [[nodiscard]] Pose pose(double distance) const;
  /// The same without the twist: X_WS carried along the arc, in whose frame `bend` points as at the start.
  [[nodiscard]] Pose carried(double distance) const;
};

/// A point of a backbone of any shape.
struct BackboneSample {
  Pose X_WS;             ///< z is the tangent; x and y turn with the material.
  double s_rest = 0;     ///< Arc length from the base along the arm at rest, m; rises from sample to sample.
  double radius = 0.02;  ///< m; > 0.
  std::size_t section = 0;  ///< Of the arm, from this sample to the next.
};

/// The arm's centreline in the world: a chain of circular arcs, each tangent to the one before. An arm whose
/// sections are arcs is one exactly; any other curve is one to the third power of its samples' distance.
class Backbone {
 public:
  /// Places the arm's sections, bent and stretched as `state` says: one arc a section.
  /// std::invalid_argument: no sections, not one finite bend and one stretch a section, a length that is not
  /// positive.
  Backbone(const Arm& arm, const ArmState& state);
  /// The same of an arm whose sections are parts of another's: `section_of` has for each which one's it is.
  /// std::invalid_argument besides: not one for each.
  Backbone(const Arm& arm, const ArmState& state, std::span<const std::size_t> section_of);

  /// Two arcs between each two consecutive samples, which meet with one tangent (a biarc; docs/renderer.md):
  /// the backbone is smooth and passes through every sample. Samples of a circular arc give that arc. The
  /// material turns evenly about the tangent from sample to sample, by less than half a turn.
  /// std::invalid_argument: fewer than two samples, numbers that are not finite, a radius that is not
  /// positive, s_rest that does not rise, samples in one place, tangents turned back against the way to the
  /// next sample.
  [[nodiscard]] static Backbone through(std::span<const BackboneSample> samples);

  /// From the base on; each section has one or more.
  [[nodiscard]] std::span<const Arc> arcs() const { return arcs_; }
  /// m, stretch included.
  [[nodiscard]] double length() const;
  /// m, of the arm at rest.
  [[nodiscard]] double rest_length() const;
  /// X_WS at arc length s in [0, length()], m. Past an end by no more than rounding (1e-12 of the length) is
  /// at that end; further outside is an std::out_of_range.
  [[nodiscard]] Pose pose(double s) const;
  /// X_WT, the frame at s = length().
  [[nodiscard]] const Pose& tip() const { return X_WT_; }

  /// Where the material that lies `s_rest` m from the base at rest lies on the arm as it stands, m of arc
  /// length; before the base and beyond the tip, those.
  [[nodiscard]] double s_at_rest(double s_rest) const;
  /// The inverse: where what lies at arc length s would lie at rest, m. Likewise.
  [[nodiscard]] double s_rest_at(double s) const;

 private:
  Backbone() = default;

  std::vector<Arc> arcs_;
  Pose X_WT_;
};

}  // namespace flexura
