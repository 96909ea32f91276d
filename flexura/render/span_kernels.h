#pragma once

#include <cstddef>
#include <cstdint>

// What is worked out for quick pictures in each instruction set (kernels.h).
namespace flexura {

/// Pixels that the kernels take at a time, whatever their width.
constexpr std::size_t span_step = 32;

/// What a pixel of a quick picture is.
enum PixelState : std::uint8_t {
  state_behind = 0,  ///< Background or screen.
  state_arm = 1,     ///< Skin of the arm or an end of it.
  state_border = 2,  ///< The arm's contour runs through it, or close by the bent edge of a ring or line.
  state_exact = 4,   ///< To be drawn by the exact way.
  state_base = 8,    ///< The rim of the arm's base may be seen in it;
  state_tip = 16,    ///< that of its tip.
  state_edge = 32,   ///< A screen's edge runs through it, or the line where two cross.
};

/// A function of the image that is linear: value + by_u (u - u0) + by_v (v - v0). For a lens with distortion
/// (u, v) is where the ray would be seen without.
struct Linear {
  float value, by_u, by_v;
};

/// Where a lens with distortion sees the rays of a row of pixels: their places without distortion, and how
/// these change from pixel to pixel. No `u`: the lens has none.
struct LensRow {
  const float *u = nullptr, *v = nullptr;
  const float *u_by_u = nullptr, *u_by_v = nullptr, *v_by_u = nullptr, *v_by_v = nullptr;
};

/// A row of the picture, no narrower than span_step.
struct SpanRow {
  int v = 0, width = 0;
  float* depth = nullptr;
  float* light = nullptr;
  std::uint8_t* state = nullptr;
  LensRow lens;
  int* borders = nullptr;        ///< Columns that a contour or a bent edge may divide, as draw() adds them:
  std::size_t border_count = 0;  ///< so many.
  bool has_edge = false;         ///< Whether a pixel has state_edge,
  bool has_exact = false;        ///< is left to the exact way.
};

/// A plane where the tube's colour changes: where p . normal = offset in the piece's frame.
struct SpanEdge {
  float normal[3], offset;
  float far;        ///< m; farther from it no pixel is divided.
  float change[3];  ///< Of the albedo, beyond it.
};

/// A piece of tube in its own frame (docs/renderer.md), as the pixels near (u0, v0) see it: the
/// points of their rays at depth0, and their directions.
struct SpanPiece {
  float u0, v0, depth0;
  Linear point[3], direction[3];
  Linear way;  ///< From there about to the plane along the piece's middle that faces the camera, m of depth.
  float curvature, radius, widening;  ///< The radius at its start, and by how much it grows by arc length.
  float widest;                       ///< Its largest radius.
  float kink_before, kink_after;  ///< m along the axis: so near to its start and its end contours are left to
                                  ///< the exact way, for what goes on there bends or tapers otherwise; or 0.
  float end_sine, end_cosine, end_offset;
  float reach;         ///< m: contours this near may divide the pixel,
  float bent_reach;    ///< and edges of rings and lines that are this near to a contour, within, are bent; no
                       ///< less.
  int centering;       ///< Newton's steps to where the ray is deepest,
  float largest_move;  ///< m: and how small the last one has to be.
  int refining;        ///< Newton's steps to where it enters,
  float settled;       ///< m: and how small the last one has to be.
  float light[3];      ///< The directional light's strength over the radius times the direction towards it.
  float ambient;
  float albedo[3];  ///< At its start.
  const SpanEdge* edges;
  std::size_t edge_count, channels;
  std::uint8_t rims;  ///< state_base, state_tip: of the ends that it has; it leaves their pixels alone.
};

/// A flat end of the arm or of the etalon. Where a ray meets its plane is, in its radii from its centre, (x,
/// y) / z; z is positive in front of the camera.
struct SpanRim {
  float u0, v0;
  Linear x, y, z;
  Linear nearness;  ///< 1/depth of the plane.
  /// The skin at the rim is seen where (x, y) . facing is below minus the length l of (x, y) times `radius`
  /// less `lean` l / (l - (x, y) . bend), m: the tube's radius, and by how much the skin of a tube that
  /// tapers turns to the camera, more where it bends to that side. `margin` (m) times l makes sure.
  float facing[2], radius, lean, bend[2], margin;
  float light[3];
  bool is_front;     ///< Seen itself.
  PixelState state;  ///< Of its rim.
};

/// What an end and its tube make of pixels at the rim.
struct RimPixels {
  float share[span_step];      ///< Of the pixel that shows them;
  float light[3 * span_step];  ///< their light, times it.
  float depth[span_step];      ///< In the middle of the pixel; infinite: they are not seen there.
  std::uint8_t is_plain[span_step];
};

/// A screen: points are where nearness, 1/depth, is positive. Its light is
/// brightness max(0, 1 + gradient . (x, y)) (1 - falloff (x^2 + y^2) / 2), the place (x, y) being
/// depth place - middle.
struct SpanScreen {
  float u0, v0;
  Linear nearness, place[2];
  float middle[2], gradient[2], falloff, brightness[3];
  Linear edges[4];       ///< Above 1: well within the edge; below -1: well out.
  float least_distance;  ///< Of the nearness from that of what is there.
  std::size_t channels;
  bool is_plain;  ///< Of one brightness.
};

/// Pixels to be divided: where they are in an image without distortion and how that changes with the pixel.
struct SpanPlaces {
  float u[span_step], v[span_step];
  float u_by_u[span_step], u_by_v[span_step], v_by_u[span_step], v_by_v[span_step];
};

/// What a contour makes of a pixel.
struct BorderPixels {
  float coverage[span_step];  ///< Share of the pixel within.
  float light[3 * span_step];
  float depth[span_step];    ///< In the middle of the pixel; infinite outside.
  float contour[span_step];  ///< Depth of the contour.
  std::uint8_t is_simple[span_step];
  std::uint8_t is_sure[span_step];  ///< Whether it is right; the rest is for the exact way.
};

/// One instruction set's functions.
struct SpanKernels {
  /// Draws the piece's skin in the columns [begin, end) where it is nearest and no contour is near.
  void (*draw)(const SpanPiece& piece, int begin, int end, SpanRow& row);
  /// Draws the screen in the columns where it is nearest and no edge of it is near; `is_first`: nothing is
  /// there yet; without distortion what is in the row then is of no meaning, but for a plain screen's light.
  void (*screen)(const SpanScreen& screen, int begin, int end, bool is_first, SpanRow& row);
  /// Adds the columns in which the rim may be seen to row.borders.
  void (*find_rim)(const SpanRim& rim, int begin, int end, SpanRow& row);
  /// Draws the end itself where it is nearest, but for the rim's pixels.
  void (*disc)(const SpanRim& rim, std::size_t channels, int begin, int end, SpanRow& row);
  /// Works out the rim's pixels, the piece being the one that ends there, as far as nothing else is seen to
  /// divide them: those that are plain.
  void (*divide_rim)(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, RimPixels& pixels);
  /// Works out any one, the places' number `index`, from 256 points. Whether it is right.
  bool (*sample_rim)(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, std::size_t index,
                     RimPixels& pixels);
  /// Works out pixels with contours.
  void (*divide)(const SpanPiece& piece, const SpanPlaces& places, BorderPixels& borders);
  /// The mean light of what of the piece is in the pixel of the places' number `index`, from 64 or 256
  /// points; left as it is when none is within. Whether it is right.
  bool (*sample)(const SpanPiece& piece, const SpanPlaces& places, std::size_t index, float* light);
};

}  // namespace flexura
