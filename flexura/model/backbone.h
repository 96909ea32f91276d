#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Returns the pose of an arc's end frame in the arc's start frame, whose z is along the tangent. `length`:
/// length of the arc, m. `bend`: bend vector, rad. With t = |bend|, the position is length (bend_x (1 - cos
/// t)/t^2, bend_y (1 - cos t)/t^2, sin t/t). The rotation vector is (-bend_y, bend_x, 0). The result is
/// smooth through bend = 0.
[[nodiscard]] Pose arc_pose(const Eigen::Vector2d& bend, double length);
/// Returns the pose of an arc's end frame for known sinc(t) and cosc(t) (math/series.h), where t = |bend|.
[[nodiscard]] Pose arc_pose(const Eigen::Vector2d& bend, double length, double sinc_t, double cosc_t);

/// One circular arc of a backbone, with the tube around it. The tube consists of discs perpendicular to the
/// arc, with centres on the arc and a radius that is linear in arc length.
struct Arc {
  Pose X_WS;                                       ///< Frame at the arc's start; z is the tangent.
  double s = 0.0;                                  ///< Arc length from the arm's base to the arc's start, m.
  double length = 0.0;                             ///< Length of the arc, with stretch, m.
  Eigen::Vector2d bend = Eigen::Vector2d::Zero();  ///< Bend vector of the whole arc, rad.
  double twist = 0.0;   ///< Rotation of the material about the tangent from the arc's start to its end, rad.
  double s_rest = 0.0;  ///< Arc length of the arc's start on the arm at rest (straight and unstretched), m.
  double rest_length = 0.0;                     ///< Length of the arc at rest, m.
  std::array<double, 2> radius = {0.02, 0.02};  ///< Radius of the tube at the arc's start and end, m; > 0.
  std::size_t section = 0;  ///< Index of the section that contains the arc; 0 at the base.

  /// Returns the pose in W of the frame at `distance` along the arc, m, in [0, length].
  [[nodiscard]] Pose pose(double distance) const;
  /// Returns the pose in W of the frame without twist at `distance` along the arc, m. The components of
  /// `bend` are equal in this frame and in the frame at the start.
  [[nodiscard]] Pose carried(double distance) const;
};

/// A sample of a backbone of any shape.
struct BackboneSample {
  Pose X_WS;  ///< Frame of the cross-section; z is the tangent, x and y rotate with the material.
  /// Arc length from the base along the arm at rest, m; strictly increasing over the samples.
  double s_rest = 0;
  double radius = 0.02;     ///< Radius of the tube, m; > 0.
  std::size_t section = 0;  ///< Index of the arm's section between this sample and the next sample.
};

/// The arm's centreline in the world: a chain of circular arcs, each tangent to the previous arc. The chain
/// is exact for an arm whose sections are arcs. For other curves, the error is of third order in the distance
/// between samples.
class Backbone {
 public:
  /// Makes one arc for each section of `arm`, with the bends and stretches of `state`. Throws
  /// std::invalid_argument for an arm without sections, and unless `state` has one finite bend and one finite
  /// stretch per section. Also throws std::invalid_argument if a stretched length is not positive.
  Backbone(const Arm& arm, const ArmState& state);
  /// Makes the backbone of an arm whose sections are parts of the sections of another arm. `section_of` has,
  /// for each section of `arm`, the index of the other arm's section, which becomes Arc::section. Throws the
  /// exceptions of the first constructor, and std::invalid_argument if `section_of` does not have one number
  /// per section of `arm`.
  Backbone(const Arm& arm, const ArmState& state, std::span<const std::size_t> section_of);

  /// Returns a smooth backbone through all samples: two arcs with a common tangent between consecutive
  /// samples (a biarc; docs/renderer.md). For samples of a circular arc, the result is exactly this arc.
  /// Between samples, the material rotates uniformly about the tangent, by less than half a turn. Throws
  /// std::invalid_argument for fewer than two samples, numbers that are not finite, a radius that is not
  /// positive, or s_rest that does not increase. Also throws std::invalid_argument for consecutive samples at
  /// the same position, or if the angle between a tangent and the direction to the next sample is 90 degrees
  /// or more.
  [[nodiscard]] static Backbone through(std::span<const BackboneSample> samples);

  /// Returns the arcs from base to tip. Each section has one or more arcs.
  [[nodiscard]] std::span<const Arc> arcs() const { return arcs_; }
  /// Returns the length of the backbone, with stretch, m.
  [[nodiscard]] double length() const;
  /// Returns the length of the arm at rest, m.
  [[nodiscard]] double rest_length() const;
  /// Returns the frame X_WS at arc length s in [0, length()], m. Values that are beyond an end because of
  /// rounding (up to 1e-12 of the length) are clamped to the end. Throws std::out_of_range for values further
  /// outside.
  [[nodiscard]] Pose pose(double s) const;
  /// Returns X_WT, the frame at the tip (s = length()).
  [[nodiscard]] const Pose& tip() const { return X_WT_; }

  /// Returns the arc length on this backbone, m, of the material point that is `s_rest` m from the base of
  /// the arm at rest. Values before the base or beyond the tip are clamped to the base or the tip.
  [[nodiscard]] double s_at_rest(double s_rest) const;
  /// Returns the arc length on the arm at rest, m, of the material point at arc length s of this backbone, m.
  /// Values before the base or beyond the tip are clamped to the base or the tip.
  [[nodiscard]] double s_rest_at(double s) const;

 private:
  Backbone() = default;

  std::vector<Arc> arcs_;
  Pose X_WT_;
};

}  // namespace flexura
