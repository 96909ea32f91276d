#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "flexura/render/quick_picture.h"

namespace flexura {
namespace {

// The piece of tube whose flat end a disc is, and the side of this end.
struct EndOf {
  int piece = -1;  // -1: not the end of a whole tube.
  bool is_base = false;
};

EndOf end_of(const Stage& stage, const DiscPart& disc) {
  const SurfaceLabel label = stage.bodies[static_cast<std::size_t>(disc.body)].label;
  if (label.kind == SurfaceKind::cap && label.index < 2)
    return label.index == 0 ? EndOf{stage.first_arm_piece, true} : EndOf{stage.last_arm_piece, false};
  if (label.kind != SurfaceKind::etalon) return {};
  const auto skin = std::ranges::find_if(stage.pieces, [&](const TubePiece& piece) {
    return stage.bodies[static_cast<std::size_t>(piece.body)].is_etalon;
  });
  return {static_cast<int>(skin - stage.pieces.begin()), label.index == 2};
}

}  // namespace

// Plans the flat ends of the arm and of the etalon. The reference path draws all other discs, and ends whose
// skin the fast path does not draw.
bool QuickPicture::plan_rims(const Stage& stage) {
  rim_count_ = 0;
  for (const DiscPart& disc : stage.discs) {
    const Circle& circle = disc.circle;
    // About the longest diameter of the image.
    const Eigen::Vector3d across = circle.normal.cross(circle.center);
    const double sine = across.norm() / circle.center.norm();
    const Eigen::Vector3d way =
        sine > 1e-6 ? Eigen::Vector3d(across.normalized() * circle.radius) : across * 0;
    const double narrow =
        1.1 * circle.radius * (sine > 1e-6 ? std::sqrt(std::max(0.0, 1 - sine * sine)) : 1.0) +
        circle.radius * circle.radius / circle.center.norm();
    const auto region = ImageRegion::of(intrinsics_, circle.center - way, circle.center + way,
                                        std::min(narrow, circle.radius));
    if (!region) return false;
    const EndOf end = end_of(stage, disc);
    // Seen edge-on, its image is too thin for single precision.
    constexpr double thinnest = 1;  // px
    const double thickness = 2 * circle.radius * std::abs(circle.normal.dot(circle.center)) /
                             (circle.center.squaredNorm() * pixel_);
    const bool is_end = end.piece >= 0 && is_near_picture(circle.center) && thickness > thinnest;
    const auto skin = std::find_if(skins_.begin(), skins_.begin() + static_cast<std::ptrdiff_t>(skin_count_),
                                   [&](const Skin& one) { return is_end && one.index == end.piece; });
    if (skin == skins_.begin() + static_cast<std::ptrdiff_t>(skin_count_)) {
      leave(*region);
      continue;
    }
    if (rim_count_ == rims_.size()) rims_.emplace_back();
    Rim& rim = rims_[rim_count_++];
    rim.skin = static_cast<std::size_t>(skin - skins_.begin());
    rim.region = *region;
    rim.rows = map_.rows(*region);
    rim.rim.state = end.is_base ? state_base : state_tip;
    skin->piece.rims |= rim.rim.state;
    rim.depth = circle.center.z();
    fill_rim(stage, disc, stage.pieces[static_cast<std::size_t>(end.piece)], rim.rim);
    find_rim(rim);
  }
  return true;
}

void QuickPicture::fill_rim(const Stage& stage, const DiscPart& disc, const TubePiece& piece,
                            SpanRim& rim) const {
  const Circle& circle = disc.circle;
  const Eigen::Vector2d pixel = pixel_of(circle.center);
  rim.u0 = number(pixel.x()), rim.v0 = number(pixel.y());
  const double scale = 1 / (circle.radius * circle.center.norm());
  rim.x = along_rays(circle.by_x, pixel, scale), rim.y = along_rays(circle.by_y, pixel, scale);
  rim.z = along_rays(circle.by_z, pixel, scale * circle.radius);
  rim.nearness = along_rays(circle.normal, pixel, 1 / circle.normal.dot(circle.center));
  rim.is_front = circle.normal.dot(circle.center) < 0;
  // The skin at the rim in direction (x, y) is visible where it faces the camera. Pixels of the other half
  // must be checked near the visible one: beside the contour, and everywhere if the image is flat.
  rim.facing[0] = number(circle.x.dot(circle.center)), rim.facing[1] = number(circle.y.dot(circle.center));
  // On a tapered tube, the skin's normals are tilted along the tube from those of the circle.
  const Eigen::Vector3d t = rim.state == state_base ? Eigen::Vector3d(0, 0, 1) : piece.end_tangent;
  const Eigen::Vector3d bend =
      piece.R_CP * Eigen::Vector3d(t.z(), 0, -t.x()) * (piece.curvature * circle.radius);
  rim.radius = number(circle.radius);
  rim.lean = number(piece.widening * (piece.R_CP * t).dot(circle.center));
  rim.bend[0] = number(circle.x.dot(bend)), rim.bend[1] = number(circle.y.dot(bend));
  const double distance = circle.center.norm();
  const double flat =
      circle.radius * std::abs(circle.normal.dot(circle.center)) / (distance * distance * pixel_);
  rim.margin = number(distance * std::max(0.4, 1.2 / flat));
  const Light& light = stage.scene->light;
  const double factor = light.ambient + light.directional * std::max(0.0, circle.normal.dot(stage.light));
  const Color color = stage.bodies[static_cast<std::size_t>(disc.body)].albedo * factor;
  for (Eigen::Index c = 0; c < 3; ++c) rim.light[c] = number(channels_ == 1 ? gray_of(color) : color[c]);
}

// Excludes the pixels of the rim from the pixels that are drawn as tube surface.
void QuickPicture::find_rim(Rim& rim) {
  rim.pixels.clear();
  for (int v = rim.rows.begin; v < rim.rows.end; ++v) {
    const PixelRange columns = map_.columns(rim.region, v);
    if (columns.begin == columns.end) continue;
    SpanRow& row = rows_[static_cast<std::size_t>(v)];
    row.border_count = 0;
    kernels_->find_rim(rim.rim, columns.begin, columns.end, row);
    for (std::size_t i = 0; i < row.border_count; ++i) {
      rim.pixels.push_back({row.borders[i], v});
      state(row.borders[i], v) |= rim.rim.state;
    }
  }
}

void QuickPicture::draw(const Rim& rim) {
  if (!rim.rim.is_front) return;
  for (int v = rim.rows.begin; v < rim.rows.end; ++v) {
    const PixelRange columns = map_.columns(rim.region, v);
    kernels_->disc(rim.rim, channels_, columns.begin, columns.end, rows_[static_cast<std::size_t>(v)]);
  }
}

// Returns whether the rim's pixel can be drawn over the present content. False if that is nearer than the
// rim. Pixels with two rims, or with a contour in front of or behind the rim, are left to the reference path.
bool QuickPicture::takes_rim(const Rim& rim, Pixel pixel) {
  const std::uint8_t here = state(pixel.u, pixel.v);
  if ((here & state_exact) != 0) return false;
  const auto before = static_cast<double>(picture_->depth.at(pixel.u, pixel.v)),
             slack = 2 * static_cast<double>(skins_[rim.skin].piece.radius);
  const bool is_arm = (here & state_arm) != 0;
  if (is_arm && before < rim.depth - slack) return false;
  const bool is_alone = (here & ~state_arm) == rim.rim.state;
  if (is_alone && before > rim.depth + (is_arm ? slack : 0.5 * slack)) return true;
  leave(pixel.u, pixel.v);
  return false;
}

void QuickPicture::divide_rim(Rim& rim) {
  const SpanPiece& piece = skins_[rim.skin].piece;
  std::erase_if(rim.pixels, [&](Pixel pixel) { return !takes_rim(rim, pixel); });
  SpanPlaces places{};
  RimPixels seen{};
  for (std::size_t begin = 0; begin < rim.pixels.size(); begin += span_step) {
    const std::size_t count = std::min(span_step, rim.pixels.size() - begin);
    set_places(rim.pixels, begin, places);
    kernels_->divide_rim(rim.rim, piece, places, seen);
    for (std::size_t i = 0; i < count; ++i) {
      const Pixel pixel = rim.pixels[begin + i];
      if (seen.is_plain[i] != 0 || kernels_->sample_rim(rim.rim, piece, places, i, seen))
        lay_rim(pixel, seen, i);
      else
        leave(pixel.u, pixel.v);
    }
  }
}

// Draws the end over the content of the pixel.
void QuickPicture::lay_rim(Pixel pixel, const RimPixels& seen, std::size_t i) {
  float& depth = picture_->depth.at(pixel.u, pixel.v);
  depth = std::min(depth, seen.depth[i]);
  float* const light = &picture_->light.at(pixel.u, pixel.v);
  for (std::size_t c = 0; c < channels_; ++c)
    light[c] = seen.light[c * span_step + i] + (1 - seen.share[i]) * light[c];
}

}  // namespace flexura
