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
  double depth = std::numeric_limits<double>::infinity();  ///< m; infinite: none.
  Part part = {Part::Kind::piece, 0};
  Eigen::Vector3d normal = {0, 0, -1};  ///< C, unit; towards the camera's side.
  /// On the arm: arc length from the base, m; on anything else no number.
  double s = std::numeric_limits<double>::quiet_NaN();
  SurfaceLabel label;

  [[nodiscard]] bool is_none() const { return depth == std::numeric_limits<double>::infinity(); }
};

/// What a point of the image shows, and the nearest borders of what is seen around it: contours, rims, edges
/// of colours, and lines where bodies meet.
struct Trace {
  Hit hit;
  Border nearest, second;                                  ///< Infinitely far: none within border_reach.
  double clear = std::numeric_limits<double>::infinity();  ///< Of the nearest that is no ring's edge, px.
};

/// Holds rays against some of a stage's primitives, in the order given. Surfaces are seen from outside only:
/// a camera within a body does not see that body (screens have two sides).
class Tracer {
 public:
  Tracer(const Stage& stage, std::span<const Part> parts) : stage_(stage), parts_(parts) {}

  /// The first surface alone.
  [[nodiscard]] Hit hit(const Ray& ray) const;
  /// With the borders.
  [[nodiscard]] Trace trace(const Ray& ray) const;
  /// How many times the ray enters the arm before the depth.
  [[nodiscard]] int entries_into_arm(const Ray& ray, double depth) const;

  [[nodiscard]] const Stage& stage() const { return stage_; }

 private:
  const Stage& stage_;
  std::span<const Part> parts_;
};

/// What the arm's skin shows at arc length s on `piece`: a marker or the section.
[[nodiscard]] SurfaceLabel arm_label(const Stage& stage, const TubePiece& piece, double s);

/// The light that comes from where the ray meets `hit`, or from the background.
[[nodiscard]] Color light_of(const Stage& stage, const Hit& hit, const Ray& ray);

}  // namespace flexura
