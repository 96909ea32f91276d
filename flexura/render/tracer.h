#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "flexura/render/border.h"
#include "flexura/render/ray.h"
#include "flexura/render/stage.h"

namespace flexura {

/// A primitive of a stage.
struct Part {
  enum class Kind : std::uint32_t { piece, disc, face, plane };
  Kind kind;
  std::uint32_t index;
  bool operator==(const Part&) const = default;
};

/// The first surface that a ray hits.
struct Hit {
  /// Depth along the optical axis, m; infinite without a surface.
  double depth = std::numeric_limits<double>::infinity();
  Part part = {Part::Kind::piece, 0};
  Eigen::Vector3d normal = {0, 0, -1};  ///< Unit normal in C, on the camera's side.
  /// Arc length from the base on the arm, m; NaN on other surfaces.
  double s = std::numeric_limits<double>::quiet_NaN();
  SurfaceLabel label;

  [[nodiscard]] bool is_none() const { return depth == std::numeric_limits<double>::infinity(); }
};

/// Surface at a point of the image, and the nearest borders in the image: contours, rims, colour edges, and
/// lines where bodies intersect.
struct Trace {
  Hit hit;
  /// Nearest and second nearest border. Borders farther than border_reach have an infinite distance.
  Border nearest, second;
  /// Distance of the nearest border that is not an edge of a ring, px.
  double clear = std::numeric_limits<double>::infinity();
};

/// Intersects rays with some primitives of a stage, in the given order. Surfaces are visible only from
/// outside, so that a camera inside a body does not see this body. Screens are visible from both sides.
class Tracer {
 public:
  Tracer(const Stage& stage, std::span<const Part> parts) : stage_(stage), parts_(parts) {}

  /// Returns the first surface that the ray hits, without borders.
  [[nodiscard]] Hit hit(const Ray& ray) const;
  /// Returns the first surface that the ray hits, with the nearest borders.
  [[nodiscard]] Trace trace(const Ray& ray) const;
  /// Returns the number of times that the ray enters the arm before `depth`, m.
  [[nodiscard]] int entries_into_arm(const Ray& ray, double depth) const;

  [[nodiscard]] const Stage& stage() const { return stage_; }

 private:
  const Stage& stage_;
  std::span<const Part> parts_;
};

/// Returns the label of the arm's surface at arc length s, m, on `piece`: a marker or the section.
[[nodiscard]] SurfaceLabel arm_label(const Stage& stage, const TubePiece& piece, double s);

/// Returns the light that reaches the camera along the ray from the surface point `hit`, or from the
/// background.
[[nodiscard]] Color light_of(const Stage& stage, const Hit& hit, const Ray& ray);

}  // namespace flexura
