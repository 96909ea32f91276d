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

/// The surface that a ray meets first.
struct Hit {
  double depth = std::numeric_limits<double>::infinity();  ///< Depth, m; infinite: no surface.
  Part part = {Part::Kind::piece, 0};
  Eigen::Vector3d normal = {0, 0, -1};  ///< Unit normal, C, towards the camera's side.
  /// On the arm, arc length from the base, m; elsewhere NaN.
  double s = std::numeric_limits<double>::quiet_NaN();
  SurfaceLabel label;

  [[nodiscard]] bool is_none() const { return depth == std::numeric_limits<double>::infinity(); }
};

/// Surface at a point of the image, and its nearest borders: contours, rims, colour edges, and lines where
/// bodies meet.
struct Trace {
  Hit hit;
  Border nearest, second;                                  ///< Infinitely far if beyond border_reach.
  double clear = std::numeric_limits<double>::infinity();  ///< Distance of the nearest border that is not a
                                                           ///< ring's edge, px.
};

/// Intersects rays with some of a stage's primitives, in the given order. Surfaces are visible from outside
/// only: a camera inside a body does not see that body (screens have two sides).
class Tracer {
 public:
  Tracer(const Stage& stage, std::span<const Part> parts) : stage_(stage), parts_(parts) {}

  /// Returns the first surface alone.
  [[nodiscard]] Hit hit(const Ray& ray) const;
  /// Returns the first surface with its borders.
  [[nodiscard]] Trace trace(const Ray& ray) const;
  /// Returns how many times the ray enters the arm before the depth.
  [[nodiscard]] int entries_into_arm(const Ray& ray, double depth) const;

  [[nodiscard]] const Stage& stage() const { return stage_; }

 private:
  const Stage& stage_;
  std::span<const Part> parts_;
};

/// Returns what the arm's skin shows at arc length s on `piece`: a marker or the section.
[[nodiscard]] SurfaceLabel arm_label(const Stage& stage, const TubePiece& piece, double s);

/// Returns the light from the point where the ray meets `hit`, or from the background.
[[nodiscard]] Color light_of(const Stage& stage, const Hit& hit, const Ray& ray);

}  // namespace flexura
