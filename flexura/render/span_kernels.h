#pragma once

#include <cstddef>
#include <cstdint>

// Functions of the fast path that are compiled for each instruction set (kernels.h).
namespace flexura {

/// Number of pixels that kernels process together, for any vector width.
constexpr std::size_t span_step = 32;

/// State of a pixel in the fast path.
enum PixelState : std::uint8_t {
  state_behind = 0,  ///< Background or screen.
  state_arm = 1,     ///< Surface of the arm, or an end of the arm.
  /// The pixel is crossed by the arm's contour or, close to the contour, by the curved edge of a ring or
  /// line.
  state_border = 2,
  state_exact = 4,  ///< The reference path draws the pixel.
  state_base = 8,   ///< The pixel may contain the rim of the arm's base.
  state_tip = 16,   ///< The pixel may contain the rim of the arm's tip.
  state_edge = 32,  ///< The pixel is crossed by a screen's edge, or by the line where two screens cross.
};

/// A linear function of the image: value + by_u (u - u0) + by_v (v - v0). For a lens with distortion, (u, v)
/// is the undistorted position.
struct Linear {
  float value, by_u, by_v;
};

/// Undistorted positions of the rays of a row of pixels, and their derivatives. A null `u` means no
/// distortion.
struct LensRow {
  const float *u = nullptr, *v = nullptr;
  const float *u_by_u = nullptr, *u_by_v = nullptr, *v_by_u = nullptr, *v_by_v = nullptr;
};

/// A row of the picture, at least span_step wide.
struct SpanRow {
  int v = 0, width = 0;
  float* depth = nullptr;
  float* light = nullptr;
  std::uint8_t* state = nullptr;
  LensRow lens;
  int* borders = nullptr;  ///< Columns that a contour or a curved edge may divide; draw() adds these columns.
  std::size_t border_count = 0;  ///< Number of entries in `borders`.
  bool has_edge = false;         ///< Whether any pixel has state_edge.
  bool has_exact = false;        ///< Whether any pixel is left to the reference path.
};

/// A plane at which the tube's colour changes: p . normal = offset in the piece's frame.
struct SpanEdge {
  float normal[3], offset;
  float far;        ///< Distance beyond which no pixel is divided, m.
  float change[3];  ///< Change of the albedo beyond the plane.
};

/// A piece of tube in its own frame (docs/renderer.md), as seen by the pixels near (u0, v0). `point` is the
/// point at depth0 on the ray of a pixel, and `direction` is the ray's direction.
struct SpanPiece {
  float u0, v0, depth0;
  Linear point[3], direction[3];
  /// Depth from depth0 to approximately the plane that contains the piece's axis and faces the camera, m.
  Linear way;
  /// Curvature, 1/m; radius at the piece's start, m; change of the radius per arc length.
  float curvature, radius, widening;
  float widest;  ///< Largest radius, m.
  /// Distances from start and end along the axis, m, within which the reference path draws contours. These
  /// distances are above 0 where curvature or taper changes.
  float kink_before, kink_after;
  float end_sine, end_cosine, end_offset;
  float reach;  ///< Distance from the surface within which contours may divide the pixel, m.
  /// Distance inside a contour within which the images of edges of rings and lines are curved, m; >= reach.
  float bent_reach;
  int centering;       ///< Number of Newton steps to the point at which the ray is deepest in the tube.
  float largest_move;  ///< Largest allowed length of the last of the `centering` steps, m.
  int refining;        ///< Number of Newton steps to the ray's entry into the tube.
  float settled;       ///< Largest allowed length of the last of the `refining` steps, m.
  float light[3];  ///< Directional light divided by the radius, times the unit direction towards the light.
  float ambient;
  float albedo[3];  ///< Albedo at the piece's start.
  const SpanEdge* edges;
  std::size_t edge_count, channels;
  /// Flags of the arm's ends on this piece (state_base, state_tip). Pixels of their rims are skipped.
  std::uint8_t rims;
};

/// A flat end of the arm or of the calibration cylinder. A ray intersects the end's plane at (x, y) / z, in
/// radii from the centre; z is positive in front of the camera.
struct SpanRim {
  float u0, v0;
  Linear x, y, z;
  Linear nearness;  ///< Inverse depth of the plane, 1/m.
  /// With l the length of (x, y), the tube's surface at the rim is visible where
  ///   (x, y) . facing < -l (radius - lean l / (l - (x, y) . bend)), m.
  /// `radius` is the tube's radius. `lean` describes the inclination of a tapered surface towards the camera;
  /// it is larger where the tube bends to that side. `margin`, m, times l is a safety margin.
  float facing[2], radius, lean, bend[2], margin;
  float light[3];
  bool is_front;     ///< Whether the end's disc faces the camera.
  PixelState state;  ///< State of pixels at the end's rim.
};

/// Content of pixels at the rim of an end: the end and its tube together.
struct RimPixels {
  float share[span_step];      ///< Fraction of the pixel that shows end or tube.
  float light[3 * span_step];  ///< Light of end and tube times this fraction.
  float depth[span_step];      ///< Depth in the middle of the pixel, m; infinite if neither is visible there.
  std::uint8_t is_plain[span_step];
};

/// A screen. The plane of the screen is in front of the camera where the inverse depth `nearness` is
/// positive. The light at the screen's point (x, y) = depth place - middle is brightness max(0, 1 + gradient
/// . (x, y)) (1 - falloff (x^2 + y^2) / 2).
struct SpanScreen {
  float u0, v0;
  Linear nearness, place[2];
  float middle[2], gradient[2], falloff, brightness[3];
  /// Position relative to each edge. Values above 1 are well inside, values below -1 well outside.
  Linear edges[4];
  float least_distance;  ///< Smallest reliable difference of inverse depth from the present content.
  std::size_t channels;
  bool is_plain;  ///< Whether the screen's light is uniform.
};

/// Pixels to divide: undistorted positions, and their derivatives with respect to the pixel (u, v).
struct SpanPlaces {
  float u[span_step], v[span_step];
  float u_by_u[span_step], u_by_v[span_step], v_by_u[span_step], v_by_v[span_step];
};

/// Result for a pixel with a contour.
struct BorderPixels {
  float coverage[span_step];  ///< Fraction of the pixel inside the contour.
  float light[3 * span_step];
  float depth[span_step];    ///< Depth in the middle of the pixel, m; infinite if the middle is outside.
  float contour[span_step];  ///< Depth of the contour, m.
  std::uint8_t is_simple[span_step];
  /// Whether the result is reliable; otherwise the reference path draws the pixel.
  std::uint8_t is_sure[span_step];
};

/// Functions of one instruction set.
struct SpanKernels {
  /// Draws the piece's surface in the columns [begin, end) where the piece is nearest and no contour is near.
  void (*draw)(const SpanPiece& piece, int begin, int end, SpanRow& row);
  /// Draws the screen in the columns [begin, end) where the screen is nearest and none of its edges is near.
  /// `is_first` means that the row is empty. Without distortion, the content of an empty row is ignored,
  /// except for the light of a screen with uniform light.
  void (*screen)(const SpanScreen& screen, int begin, int end, bool is_first, SpanRow& row);
  /// Appends the columns that may contain the rim to row.borders.
  void (*find_rim)(const SpanRim& rim, int begin, int end, SpanRow& row);
  /// Draws the end's disc where the disc is nearest, except in the rim's pixels.
  void (*disc)(const SpanRim& rim, std::size_t channels, int begin, int end, SpanRow& row);
  /// Computes the pixels that only the rim divides, and sets is_plain for them. `piece` is the piece of tube
  /// that ends at the rim.
  void (*divide_rim)(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, RimPixels& pixels);
  /// Computes the rim pixel with number `index` in `places` from 256 points. Returns whether the result is
  /// reliable.
  bool (*sample_rim)(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, std::size_t index,
                     RimPixels& pixels);
  /// Computes the pixels that the piece's contour divides.
  void (*divide)(const SpanPiece& piece, const SpanPlaces& places, BorderPixels& borders);
  /// Computes the mean light of the piece in the pixel with number `index` in `places`, from 64 or 256
  /// points. Leaves `light` unchanged if no point is inside. Returns whether the result is reliable.
  bool (*sample)(const SpanPiece& piece, const SpanPlaces& places, std::size_t index, float* light);
};

}  // namespace flexura
