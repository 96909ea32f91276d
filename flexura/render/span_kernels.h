#pragma once

#include <cstddef>
#include <cstdint>

// Functions of the fast path that are compiled for each instruction set (kernels.h).
namespace flexura {

/// Number of pixels that the kernels process together, whatever the vector width.
constexpr std::size_t span_step = 32;

/// State of a pixel in the fast path.
enum PixelState : std::uint8_t {
  state_behind = 0,  ///< Background or screen.
  state_arm = 1,     ///< Skin of the arm or an end of it.
  state_border = 2,  ///< Crossed by the arm's contour, or close to it by the bent edge of a ring or line.
  state_exact = 4,   ///< Left to the reference path.
  state_base = 8,    ///< May contain the rim of the arm's base.
  state_tip = 16,    ///< May contain the rim of the arm's tip.
  state_edge = 32,   ///< Crossed by a screen's edge, or by the line where two screens cross.
};

/// A linear function of the image: value + by_u (u - u0) + by_v (v - v0). For a lens with distortion (u, v)
/// is the undistorted position.
struct Linear {
  float value, by_u, by_v;
};

/// Undistorted positions of the rays of a row of pixels, and their changes from pixel to pixel. A null `u`
/// means no distortion.
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
  int* borders = nullptr;        ///< Columns that a contour or a bent edge may divide, added by draw().
  std::size_t border_count = 0;  ///< Their number.
  bool has_edge = false;         ///< Whether a pixel has state_edge.
  bool has_exact = false;        ///< Whether a pixel is left to the reference path.
};

/// A plane where the tube's colour changes: p . normal = offset in the piece's frame.
struct SpanEdge {
  float normal[3], offset;
  float far;        ///< Distance beyond which no pixel is divided, m.
  float change[3];  ///< Change of the albedo beyond it.
};

/// A piece of tube in its own frame (docs/renderer.md), as seen by the pixels near (u0, v0). `point` and
/// `direction` are those of the pixels' rays, at depth0.
struct SpanPiece {
  float u0, v0, depth0;
  Linear point[3], direction[3];
  Linear way;  ///< Depth from there to about the plane along the piece's middle that faces the camera, m.
  float curvature, radius, widening;  ///< 1/m; radius at its start, m; change of radius by arc length.
  float widest;                       ///< Largest radius, m.
  float kink_before, kink_after;  ///< Distances along the axis from start and end, m, within which contours
                                  ///< are left to the reference path, as bend or taper change there; or 0.
  float end_sine, end_cosine, end_offset;
  float reach;  ///< Distance within which contours may divide the pixel, m.
  /// Distance inside a contour within which edges of rings and lines are bent, m; >= reach.
  float bent_reach;
  int centering;       ///< Number of Newton steps to the deepest point of the ray.
  float largest_move;  ///< Limit on the last of these steps, m.
  int refining;        ///< Number of Newton steps to the entry.
  float settled;       ///< Limit on the last of these steps, m.
  float light[3];      ///< Strength of the directional light over the radius, times the direction towards it.
  float ambient;
  float albedo[3];  ///< Albedo at its start.
  const SpanEdge* edges;
  std::size_t edge_count, channels;
  std::uint8_t rims;  ///< Ends that it has (state_base, state_tip); their rim pixels are skipped.
};

/// A flat end of the arm or of the etalon. A ray meets its plane at (x, y) / z, in radii from its centre; z
/// is positive in front of the camera.
struct SpanRim {
  float u0, v0;
  Linear x, y, z;
  Linear nearness;  ///< 1/depth of the plane.
  /// With l the length of (x, y), the skin at the rim is visible where
  ///   (x, y) . facing < -l (radius - lean l / (l - (x, y) . bend)), m.
  /// `radius` is the tube's radius. `lean` is the tilt of a tapered skin towards
  /// the camera, larger where the tube bends to that side. `margin` (m) times l is a safety margin.
  float facing[2], radius, lean, bend[2], margin;
  float light[3];
  bool is_front;     ///< Whether the end itself is visible.
  PixelState state;  ///< State of its rim pixels.
};

/// Content of pixels at the rim: of an end and its tube.
struct RimPixels {
  float share[span_step];      ///< Share of the pixel that shows them.
  float light[3 * span_step];  ///< Their light times that share.
  float depth[span_step];      ///< Depth in the middle of the pixel; infinite if they are not visible there.
  std::uint8_t is_plain[span_step];
};

/// A screen. Its points are where the inverse depth `nearness` is positive. Its light is brightness max(0, 1
/// + gradient . (x, y)) (1 - falloff (x^2 + y^2) / 2) at the point (x, y) = depth place - middle.
struct SpanScreen {
  float u0, v0;
  Linear nearness, place[2];
  float middle[2], gradient[2], falloff, brightness[3];
  Linear edges[4];       ///< Above 1: well inside the edge; below -1: well outside.
  float least_distance;  ///< Smallest difference of inverse depth from the present content.
  std::size_t channels;
  bool is_plain;  ///< Whether it is uniform.
};

/// Pixels to be divided: undistorted positions and their derivatives by the pixel.
struct SpanPlaces {
  float u[span_step], v[span_step];
  float u_by_u[span_step], u_by_v[span_step], v_by_u[span_step], v_by_v[span_step];
};

/// Result for a pixel with a contour.
struct BorderPixels {
  float coverage[span_step];  ///< Share of the pixel inside.
  float light[3 * span_step];
  float depth[span_step];    ///< Depth in the middle of the pixel; infinite outside.
  float contour[span_step];  ///< Depth of the contour.
  std::uint8_t is_simple[span_step];
  /// Whether the result is reliable; otherwise the reference path draws the pixel.
  std::uint8_t is_sure[span_step];
};

/// Functions of one instruction set.
struct SpanKernels {
  /// Draws the piece's skin in the columns [begin, end) where it is nearest and no contour is near.
  void (*draw)(const SpanPiece& piece, int begin, int end, SpanRow& row);
  /// Draws the screen in the columns where it is nearest and none of its edges is near. `is_first`: the row
  /// is empty; without distortion its content is then ignored, except for a plain screen's light.
  void (*screen)(const SpanScreen& screen, int begin, int end, bool is_first, SpanRow& row);
  /// Adds the columns that may contain the rim to row.borders.
  void (*find_rim)(const SpanRim& rim, int begin, int end, SpanRow& row);
  /// Draws the end itself where it is nearest, except in the rim's pixels.
  void (*disc)(const SpanRim& rim, std::size_t channels, int begin, int end, SpanRow& row);
  /// Computes the rim's pixels that nothing else visible divides (is_plain); `piece` is the one that ends
  /// there.
  void (*divide_rim)(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, RimPixels& pixels);
  /// Computes the rim pixel with number `index` in `places` from 256 points; returns whether it is reliable.
  bool (*sample_rim)(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, std::size_t index,
                     RimPixels& pixels);
  /// Computes pixels with contours.
  void (*divide)(const SpanPiece& piece, const SpanPlaces& places, BorderPixels& borders);
  /// Computes the mean light of the piece in the pixel with number `index` in `places`, from 64 or 256
  /// points. Leaves it unchanged if no point is inside. Returns whether it is reliable.
  bool (*sample)(const SpanPiece& piece, const SpanPlaces& places, std::size_t index, float* light);
};

}  // namespace flexura
