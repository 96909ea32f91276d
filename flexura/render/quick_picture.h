#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flexura/camera/intrinsics.h"
#include "flexura/camera/sensor.h"
#include "flexura/math/simd_path.h"
#include "flexura/render/picture.h"
#include "flexura/render/span_kernels.h"
#include "flexura/render/stage.h"

namespace flexura {

/// Draws what is plain to see: screens, the skin of the arm, its contours before one surface and the edges of
/// its markers, many pixels at a time in single precision; and tells which pixels are not, for the exact way.
/// What it draws agrees with the exact way to 1/500 of full scale, but where markers' edges are seen: there a
/// part of up to 0.02 of a pixel may show the other colour. Depths agree to 2e-6 of them, nearly all to 1e-6.
class QuickPicture {
 public:
  struct Pixel {
    int u, v;
  };

  /// std::invalid_argument: the path is not available.
  explicit QuickPicture(SimdPath path = best_simd_path());

  /// Draws into `picture`, whose images have the right size. False, with nothing of use drawn, for what it
  /// does not know: a lens with distortion, shadows, infinite planes, a camera close to something.
  bool draw(const Stage& stage, const Intrinsics& intrinsics, PixelKind pixels, LightImage& picture);

  /// The pixels that draw() left out, row by row.
  [[nodiscard]] const std::vector<Pixel>& left_out() const { return left_out_; }

 private:
  // A piece as it was drawn, and the pixels where its contour may be.
  struct Drawn {
    SpanPiece piece{};
    std::size_t first_edge = 0;
    std::vector<Pixel> contour;
  };

  void find_left_out();
  void draw_screens(const Stage& stage);
  void draw_screen(const Stage& stage, const FacePart& part, bool is_first);
  void leave_crossing(const Face& one, const Face& other);
  bool draw_pieces(const Stage& stage);
  bool draw_piece(const Stage& stage, const TubePiece& piece);
  bool draw_disc(const Stage& stage, const DiscPart& disc);
  bool leave_face(const FacePart& part);
  void divide(const Drawn& drawn);
  void merge(const SpanPiece& piece, Pixel pixel, const BorderPixels& borders, std::size_t i);
  void fill_span_piece(const Stage& stage, const TubePiece& piece, Drawn& drawn);
  bool add_edges(const Stage& stage, const TubePiece& piece, Drawn& drawn);
  [[nodiscard]] std::uint8_t& state(int u, int v) {
    return states_[static_cast<std::size_t>(v) * stride_ + static_cast<std::size_t>(u)];
  }
  void leave(int u, int v) { state(u, v) = static_cast<std::uint8_t>(state(u, v) | state_exact); }
  void store(int u, int v, const Color& light);

  const SpanKernels* kernels_;
  Intrinsics intrinsics_;
  int width_ = 0, height_ = 0;
  std::size_t channels_ = 1, stride_ = 0;
  LightImage* picture_ = nullptr;
  std::vector<std::uint8_t> states_;
  std::vector<float> row_depth_;
  std::vector<Drawn> drawn_;
  std::size_t drawn_count_ = 0;
  std::vector<SpanEdge> edges_;
  std::vector<Pixel> left_out_;
};

}  // namespace flexura
