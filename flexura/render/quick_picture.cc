#include "flexura/render/quick_picture.h"

#include <algorithm>
#include <cmath>

#include "flexura/render/kernels.h"

namespace flexura {

QuickPicture::QuickPicture(SimdPath path) : kernels_(&kernels_of(path).span) {}

void QuickPicture::leave(const ImageRegion& region) {
  for_pixels(region, [this](int u, int v) { leave(u, v); });
}

bool QuickPicture::draw(const Stage& stage, const RayField& rays, const Intrinsics& intrinsics,
                        PixelKind pixels, LightImage& picture) {
  width_ = picture.depth.width(), height_ = picture.depth.height();
  // Limit of the principal point and of focal lengths, px, for single precision.
  constexpr double most = 1e6;
  const bool is_lens_known = std::abs(intrinsics.cx) < most && std::abs(intrinsics.cy) < most &&
                             intrinsics.fx < most && intrinsics.fy < most;
  // Regions of the image are bounded perpendicular to the images of axes, so that pixels must be nearly
  // square.
  constexpr double squarest = 4.0 / 3;
  const bool is_square = intrinsics.fx < squarest * intrinsics.fy && intrinsics.fy < squarest * intrinsics.fx;
  const bool is_known =
      is_lens_known && is_square && stage.scene->light.shadow == 0 && width_ >= static_cast<int>(span_step);
  if (!is_known) return false;
  intrinsics_ = intrinsics;
  picture_ = &picture;
  rays_ = &rays;
  pixel_ = rays.largest_step();
  map_.set(rays, intrinsics);
  channels_ = pixels == PixelKind::gray ? 1 : 3;
  start(stage);
  if (!plan_pieces(stage) || !plan_rims(stage)) return false;
  if (!std::ranges::all_of(stage.faces, [&](const FacePart& face) { return leave_face(face); })) return false;
  for (const PlanePart& plane : stage.planes) leave_plane(plane);
  plan_screens(stage);
  for (SpanRow& row : rows_) draw_screens(row);
  for (const std::size_t i : by_row_) draw(skins_[i]);
  for (std::size_t i = 0; i < rim_count_; ++i) draw(rims_[i]);
  for (std::size_t i = 0; i < skin_count_; ++i) divide(skins_[i]);
  for (std::size_t i = 0; i < rim_count_; ++i) divide_rim(rims_[i]);
  find_left_out();
  return true;
}

void QuickPicture::start(const Stage& stage) {
  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  states_.assign(width * height, state_behind);
  takers_.resize(width * height);
  borders_.resize(width);
  rows_.clear();
  for (int v = 0; v < height_; ++v)
    rows_.push_back({.v = v,
                     .width = width_,
                     .depth = picture_->depth.row(v).data(),
                     .light = picture_->light.row(v).data(),
                     .state = &state(0, v),
                     .lens = map_.row(v),
                     .borders = borders_.data()});
  background_.resize(width * channels_);
  const Color& color = stage.scene->background;
  for (std::size_t i = 0; i < background_.size(); ++i)
    background_[i] =
        static_cast<float>(channels_ == 1 ? gray_of(color) : color[static_cast<Eigen::Index>(i % 3)]);
}

void QuickPicture::find_left_out() {
  left_out_.clear();
  for (const SpanRow& row : rows_) {
    if (!row.has_exact) continue;
    for (int u = 0; u < width_; ++u)
      if ((row.state[u] & state_exact) != 0) left_out_.push_back({u, row.v});
  }
}

// Faces of boxes.
bool QuickPicture::leave_face(const FacePart& part) {
  if (part.screen >= 0 || !part.face.is_front) return true;
  const Eigen::Vector3d middle = 0.5 * (part.face.corners[0] + part.face.corners[2]);
  const auto region = ImageRegion::of(intrinsics_, middle, middle, (part.face.corners[0] - middle).norm());
  if (region) leave(*region);
  return region.has_value();
}

// Leaves all pixels below the horizon of a plane, such as a floor, with a margin, to the reference path. A
// plane is invisible from behind.
void QuickPicture::leave_plane(const PlanePart& plane) {
  if (!(plane.normal.dot(plane.point) < 0)) return;
  constexpr double more = 3;  // px
  const double above = more * pixel_ * plane.normal.head<2>().norm();
  for (int v = 0; v < height_; ++v) {
    for (int u = 0; u < width_; ++u) {
      const auto ray = rays_->ray(u, v);
      if (!ray || plane.normal.dot(ray->direction) < above) leave(u, v);
    }
  }
}

// Sets the positions of the pixels from number `begin` on. Entries beyond the last pixel repeat the last
// pixel.
void QuickPicture::set_places(const std::vector<Pixel>& pixels, std::size_t begin, SpanPlaces& places) const {
  for (std::size_t i = 0; i < span_step; ++i) {
    const Pixel& pixel = pixels[std::min(begin + i, pixels.size() - 1)];
    map_.place(pixel.u, pixel.v, i, places);
  }
}

void QuickPicture::divide(const Skin& skin) {
  SpanPlaces places{};
  BorderPixels borders{};
  for (std::size_t begin = 0; begin < skin.contour.size(); begin += span_step) {
    const std::size_t count = std::min(span_step, skin.contour.size() - begin);
    set_places(skin.contour, begin, places);
    kernels_->divide(skin.piece, places, borders);
    for (std::size_t i = 0; i < count; ++i) merge(skin, skin.contour[begin + i], places, borders, i);
  }
}

// Blends a contour over the content of the pixel.
void QuickPicture::merge(const Skin& skin, Pixel pixel, const SpanPlaces& places, const BorderPixels& borders,
                         std::size_t i) {
  const SpanPiece& piece = skin.piece;
  std::uint8_t& here = state(pixel.u, pixel.v);
  const bool is_rims = (here & piece.rims) != 0;
  if ((here & state_exact) != 0 || is_rims) return;
  float& depth = picture_->depth.at(pixel.u, pixel.v);
  const float contour = borders.contour[i];
  if (here == state_arm && depth < contour - 2 * piece.radius) return;
  // Near a joint both pieces have the same contour.
  const int by = here == state_border ? taker(pixel) : -1;
  if (by >= 0 && (by == skin.before || by == skin.after)) return;
  const bool is_clear = here == state_behind || (here == state_arm && depth > contour + 2 * piece.radius);
  if (!is_clear || !(depth > contour) || borders.is_sure[i] == 0) {
    leave(pixel.u, pixel.v);
    return;
  }
  float within[3];
  for (std::size_t c = 0; c < channels_; ++c) within[c] = borders.light[c * span_step + i];
  const float share = borders.coverage[i];
  if (share > 0 && borders.is_simple[i] == 0 && !kernels_->sample(piece, places, i, within)) {
    leave(pixel.u, pixel.v);
    return;
  }
  here = state_border;
  taker(pixel) = skin.index;
  depth = std::min(depth, borders.depth[i]);
  if (!(share > 0)) return;
  float* const light = &picture_->light.at(pixel.u, pixel.v);
  for (std::size_t c = 0; c < channels_; ++c) light[c] += share * (within[c] - light[c]);
}

}  // namespace flexura
