#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flexura/camera/intrinsics.h"
#include "flexura/camera/sensor.h"
#include "flexura/math/simd_path.h"
#include "flexura/render/image_region.h"
#include "flexura/render/lens_map.h"
#include "flexura/render/picture.h"
#include "flexura/render/span_kernels.h"
#include "flexura/render/stage.h"

namespace flexura {

/// Converts a number to single precision, which the fast path uses.
[[nodiscard]] inline float number(double x) { return static_cast<float>(x); }

/// The fast path of the renderer. The fast path draws simple content in single precision, many pixels at a
/// time, and lists all other pixels for the reference path. Simple content is screens with edges, the arm's
/// surface, contours in front of a single surface, rims of the arm's ends, marker edges, and a calibration
/// cylinder that nothing covers. The light agrees with the reference path within 1/500 of full scale, except
/// at edges of markers or lines. At such edges, the other colour may cover up to 0.05 of a pixel. Depths
/// agree within 1e-5 relative, nearly all within 1e-6.
class QuickPicture {
 public:
  struct Pixel {
    int u, v;
  };

  /// `path`: the instruction set to use. Throws std::invalid_argument if the processor does not support this
  /// instruction set.
  explicit QuickPicture(SimdPath path = best_simd_path());

  /// Draws into `picture`, whose images must have the right size. Returns false for unsupported cases, and
  /// then the result is not usable. Unsupported are shadows, a camera close to a body, and pictures less than
  /// span_step pixels wide.
  bool draw(const Stage& stage, const RayField& rays, const Intrinsics& intrinsics, PixelKind pixels,
            LightImage& picture);

  /// Returns the pixels that draw() did not draw, row by row.
  [[nodiscard]] const std::vector<Pixel>& left_out() const { return left_out_; }

 private:
  // A piece of the arm's surface, and the pixels that its contour, or the curved edge of a ring or line, may
  // divide.
  struct Skin {
    SpanPiece piece{};
    ImageRegion region;
    PixelRange rows;
    std::size_t first_edge = 0;
    int index = 0;  // Index of the piece in the stage.
    // Indices of the neighbours whose contours continue those of the piece; -1: none.
    int before = -1, after = -1;
    std::vector<Pixel> contour;
  };
  // A flat end of the arm, the piece of surface that ends there, and the pixels that may contain the end's
  // rim.
  struct Rim {
    SpanRim rim{};
    ImageRegion region;
    PixelRange rows;
    std::size_t skin = 0;
    double depth = 0;
    std::vector<Pixel> pixels;
  };
  // A screen, with the edges as the kernels use them. `margin` is the required distance inside each edge.
  struct Panel {
    SpanScreen screen{};
    struct Edge {
      double value = 0, by_u = 0, by_v = 0, margin = 0;
    } edges[4];
    // Inverse depth at x and y, px, from (u0, v0). In double precision, because the small difference of two
    // screens that intersect at a small angle matters.
    struct Nearness {
      double value = 0, by_u = 0, by_v = 0;
      [[nodiscard]] double at(double x, double y) const { return value + by_u * x + by_v * y; }
    } nearness;
    std::vector<float> light;  // One row of the screen's light, if the light is uniform.
  };

  // Fraction of a pixel, and the centroid of this part relative to the pixel's middle, px.
  struct PixelPart {
    double area = 0;
    Eigen::Vector2d centroid = {0, 0};
    [[nodiscard]] PixelPart rest() const {
      if (!(area < 1)) return {};
      return {1 - area, -area / (1 - area) * centroid};
    }
  };

  void start(const Stage& stage);
  void find_left_out();

  // Returns whether the image of a point in C is near enough to the picture that single precision represents
  // pixel distances from it to a thousandth of a pixel.
  [[nodiscard]] bool is_near_picture(const Eigen::Vector3d& p) const {
    constexpr double most = 16384;
    return std::abs(intrinsics_.fx * p.x() / p.z() + intrinsics_.cx) < most &&
           std::abs(intrinsics_.fy * p.y() / p.z() + intrinsics_.cy) < most;
  }
  // Returns the pixel of a point in C, rounded to integers.
  [[nodiscard]] Eigen::Vector2d pixel_of(const Eigen::Vector3d& p) const {
    return {std::round(intrinsics_.fx * p.x() / p.z() + intrinsics_.cx),
            std::round(intrinsics_.fy * p.y() / p.z() + intrinsics_.cy)};
  }
  // Returns the function scale * by . direction of a ray as a linear function of the image, relative to
  // `pixel`.
  [[nodiscard]] Linear along_rays(const Eigen::Vector3d& by, const Eigen::Vector2d& pixel,
                                  double scale = 1) const {
    return {number(scale * by.dot(straight_ray(intrinsics_, pixel.x(), pixel.y()).direction)),
            number(scale * by.x() / intrinsics_.fx), number(scale * by.y() / intrinsics_.fy)};
  }
  bool plan_pieces(const Stage& stage);
  void find_meetings(const Stage& stage);
  bool plan_piece(const Stage& stage, const TubePiece& piece);
  [[nodiscard]] bool is_drawn_skin(const Stage& stage, const TubePiece& piece) const;
  void fill_span_piece(const Stage& stage, const TubePiece& piece, Skin& skin) const;
  [[nodiscard]] bool add_edges(const Stage& stage, const TubePiece& piece, Skin& skin);
  [[nodiscard]] bool add_lines(const Stage& stage, const TubePiece& piece, Skin& skin);
  void set_channels(const Color& color, float (&channels)[3]) const;
  void draw(Skin& skin);
  bool leave_face(const FacePart& part);
  void leave_plane(const PlanePart& plane);

  bool plan_rims(const Stage& stage);
  void fill_rim(const Stage& stage, const DiscPart& disc, const TubePiece& piece, SpanRim& rim) const;
  void find_rim(Rim& rim);
  void draw(const Rim& rim);
  bool takes_rim(const Rim& rim, Pixel pixel);
  void divide_rim(Rim& rim);
  void lay_rim(Pixel pixel, const RimPixels& seen, std::size_t i);

  void plan_screens(const Stage& stage);
  void fill_panel(const Stage& stage, const FacePart& part, Panel& panel) const;
  void draw_screens(SpanRow& row);
  void clear(int begin, int end, SpanRow& row) const;
  void draw_panel(std::size_t index, SpanRow& row);
  void draw_around_crossing(const PixelRange& inner, SpanRow& row);
  [[nodiscard]] static PixelPart part_above(const Eigen::Vector2d& slope, double value);
  void light_of(const Panel& panel, double x, double y, float (&light)[3]) const;
  void mix(const Panel& panel, int u, const PixelPart& part, const Panel* behind, SpanRow& row) const;
  void draw_edge(const Panel& panel, int u, SpanRow& row);

  void set_places(const std::vector<Pixel>& pixels, std::size_t begin, SpanPlaces& places) const;
  void divide(const Skin& skin);
  void merge(const Skin& skin, Pixel pixel, const SpanPlaces& places, const BorderPixels& borders,
             std::size_t i);

  [[nodiscard]] std::uint8_t& state(int u, int v) {
    return states_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(u)];
  }
  [[nodiscard]] int& taker(Pixel pixel) {
    return takers_[static_cast<std::size_t>(pixel.v) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(pixel.u)];
  }
  void leave(int u, int v) {
    state(u, v) = static_cast<std::uint8_t>(state(u, v) | state_exact);
    rows_[static_cast<std::size_t>(v)].has_exact = true;
  }
  void leave(const ImageRegion& region);
  // Calls visit(u, v) for the pixels that may show a part of the region.
  template <typename Visit>
  void for_pixels(const ImageRegion& region, Visit&& visit) const {
    const PixelRange rows = map_.rows(region);
    for (int v = rows.begin; v < rows.end; ++v) {
      const PixelRange columns = map_.columns(region, v);
      for (int u = columns.begin; u < columns.end; ++u) visit(u, v);
    }
  }

  const SpanKernels* kernels_;
  Intrinsics intrinsics_;
  const RayField* rays_ = nullptr;
  LensMap map_;
  int width_ = 0, height_ = 0;
  std::size_t channels_ = 1;
  double pixel_ = 0;  // Size of the largest pixel at depth 1, in (a, b).
  LightImage* picture_ = nullptr;
  std::vector<std::uint8_t> states_;  // State of each pixel.
  std::vector<int> takers_;           // Piece of each pixel with state_border; undefined elsewhere.
  std::vector<SpanRow> rows_;
  std::vector<float> background_;  // One row of background light.
  std::vector<int> borders_;
  std::vector<Panel> panels_;
  std::size_t panel_count_ = 0;
  std::vector<Skin> skins_;
  std::size_t skin_count_ = 0;
  std::vector<Rim> rims_;
  std::size_t rim_count_ = 0;
  std::vector<std::size_t> by_row_;  // Indices of skins in the order of their first rows.
  std::vector<std::uint8_t>
      meets_;  // For each piece of the stage, whether another part of the arm intersects the piece.
  std::vector<SpanEdge> edges_;
  std::vector<Pixel> left_out_;
};

}  // namespace flexura
