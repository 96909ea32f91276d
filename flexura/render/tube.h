#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// A tube around a circular arc: what the discs sweep whose centres run along the arc, perpendicular to it,
/// their radius linear in arc length. The point at arc length s and angle p lies at
/// c(s) + radius(s) (cos p, sin p, 0) in the arc's frame at s.
struct TubeArc {
  Arc arc;
  std::array<double, 2> radius = {0.02, 0.02};  ///< At the arc's start and end, m; > 0.
  std::size_t section = 0;                      ///< Of the arm, 0 at the base.
};

/// The surface of an arm: one tube arc a section.
/// std::invalid_argument: the backbone has not one arc a section.
[[nodiscard]] std::vector<TubeArc> tube_of(const Arm& arm, const Backbone& backbone);

/// A point of a general backbone.
struct TubeSample {
  Pose X_WS;                ///< z is the tangent.
  double s = 0;             ///< Arc length from the base, m; rises from sample to sample.
  double radius = 0.02;     ///< m; > 0.
  std::size_t section = 0;  ///< Of the arm, from this sample to the next.
};

/// The tube arc that holds arc length s; the first or the last where none does. `tube`: not empty.
[[nodiscard]] const TubeArc& tube_arc_at(std::span<const TubeArc> tube, double s);

/// The surface of an arm of which poses are known along its backbone: two consecutive samples are joined by
/// two arcs that meet with one tangent (a biarc; docs/renderer.md), so that the tube is smooth, passes
/// through every sample and converges to the backbone with the third power of the samples' distance. Samples
/// of a circular arc give that arc. std::invalid_argument: fewer than two samples, numbers that are not
/// finite, s that does not rise, samples in one place, tangents turned back against the way to the next
/// sample.
[[nodiscard]] std::vector<TubeArc> tube_through(std::span<const TubeSample> samples);

}  // namespace flexura
