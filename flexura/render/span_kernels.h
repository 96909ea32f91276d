#pragma once

#include <cstddef>
#include <cstdint>

// What the sources compiled for one instruction set each (span_*.cc) offer to quick_picture.cc. They include
// nothing of the project but this, span_lanes.h and vectors.h: an inline function of a header that others
// include too could be compiled for AVX there, and the linker could pick that copy for everybody.
namespace flexura {

enum class SimdPath;

/// Pixels that the kernels take at a time, whatever their width.
constexpr std::size_t span_step = 16;

/// What a pixel of a quick picture is.
enum PixelState : std::uint8_t {
  state_behind = 0,  ///< Background or screen.
  state_arm = 1,     ///< Skin of the arm or an end of it.
  state_border = 2,  ///< The arm's contour runs through it.
  state_exact = 4,   ///< To be drawn by the exact way.
};

/// A function of the image that is linear: value + by_u (u - u0) + by_v (v - v0).
struct Linear {
  float value, by_u, by_v;
};

/// A plane across the tube where its colour changes: where p . normal = offset in the piece's frame.
struct SpanEdge {
  float normal[3], offset;
  float far;        ///< m; farther from it no pixel is divided.
  float change[3];  ///< Of the albedo, towards larger arc lengths.
};

/// A piece of tube of one radius in its own frame (docs/renderer.md), as the pixels near (u0, v0) see it: the
/// point of their rays at depth0, and their directions.
struct SpanPiece {
  float u0, v0, depth0;
  Linear point[3], direction[3];
  float curvature, radius;
  float middle[3], chord[3];  ///< Of its centreline's ends; unit.
  float end_sine, end_cosine, end_offset;
  float reach;     ///< m: contours this near may divide the pixel.
  float light[3];  ///< The directional light's strength over the radius times the direction towards it.
  float ambient;
  float albedo[3];  ///< At its start.
  const SpanEdge* edges;
  std::size_t edge_count, channels;
};

/// The pixels of one row from u on, span_step of them.
struct SpanPixels {
  int u, v;
  float* depth;
  float* light;
  std::uint8_t* state;
};

/// What a contour makes of a pixel.
struct BorderPixels {
  float coverage[span_step];  ///< Share of the pixel within.
  float light[3 * span_step];
  float depth[span_step];    ///< In the middle of the pixel; infinite outside.
  float contour[span_step];  ///< Depth of the contour.
  std::uint8_t is_simple[span_step];
};

/// One instruction set's functions.
struct SpanKernels {
  /// Draws the piece where it is nearest and no border is near; the bits of the result tell the pixels in
  /// which a contour may be.
  std::uint32_t (*draw)(const SpanPiece& piece, const SpanPixels& pixels);
  /// Works out pixels with contours.
  void (*divide)(const SpanPiece& piece, const float* u, const float* v, BorderPixels& borders);
  /// The mean light of what of the piece is in the pixel, from 64 points (256 in colour); left as it is when
  /// none is within.
  void (*sample)(const SpanPiece& piece, float u, float v, float* light);
  /// depth[i] = scale / (value + by_u * i) where that is less than what is there; sets where.
  void (*plane)(float scale, float value, float by_u, float* depth, std::size_t count);
};

const SpanKernels* baseline_span_kernels();
// None where the compiler did not build for the set.
const SpanKernels* avx2_span_kernels();
const SpanKernels* avx512_span_kernels();

}  // namespace flexura
