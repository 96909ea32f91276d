#include "flexura/render/quick_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "flexura/render/image_region.h"
#include "flexura/render/ray_field.h"
#include "flexura/render/tracer.h"

namespace flexura {
namespace {

constexpr float nothing = std::numeric_limits<float>::infinity();

const SpanKernels* kernels_of(SimdPath path) {
  require_simd_path(path);
  if (path == SimdPath::avx512) return avx512_span_kernels();
  return path == SimdPath::avx2 ? avx2_span_kernels() : baseline_span_kernels();
}

// Calls visit(u, v) for the pixels of a region.
template <typename Visit>
void for_pixels(const ImageRegion& region, int width, int height, Visit&& visit) {
  const auto rows = region.rows(height);
  for (int v = rows.begin; v < rows.end; ++v) {
    const auto columns = region.columns(v, width);
    for (int u = columns.begin; u < columns.end; ++u) visit(u, v);
  }
}

}  // namespace

QuickPicture::QuickPicture(SimdPath path) : kernels_(kernels_of(path)) {}

void QuickPicture::store(int u, int v, const Color& light) {
  if (channels_ == 1) {
    picture_->light.at(u, v) = static_cast<float>(gray_of(light));
    return;
  }
  for (int c = 0; c < 3; ++c) picture_->light.at(u, v, c) = static_cast<float>(light[c]);
}

bool QuickPicture::draw(const Stage& stage, const Intrinsics& intrinsics, PixelKind pixels,
                        LightImage& picture) {
  if (intrinsics.is_distorted() || stage.scene->light.shadow != 0 || !stage.planes.empty()) return false;
  intrinsics_ = intrinsics;
  picture_ = &picture;
  width_ = picture.depth.width(), height_ = picture.depth.height();
  channels_ = pixels == PixelKind::gray ? 1 : 3;
  stride_ = (static_cast<std::size_t>(width_) + span_step - 1) / span_step * span_step;
  states_.assign(stride_ * static_cast<std::size_t>(height_), state_behind);
  row_depth_.resize(stride_);
  draw_screens(stage);
  if (!draw_pieces(stage)) return false;
  if (!std::ranges::all_of(stage.discs, [&](const DiscPart& disc) { return draw_disc(stage, disc); }))
    return false;
  if (!std::ranges::all_of(stage.faces, [&](const FacePart& face) { return leave_face(face); })) return false;
  for (std::size_t i = 0; i < drawn_count_; ++i) divide(drawn_[i]);
  find_left_out();
  return true;
}

void QuickPicture::find_left_out() {
  left_out_.clear();
  for (int v = 0; v < height_; ++v) {
    for (int begin = 0; begin < width_; begin += 8) {
      // Eight at a time: hardly any are left out.
      std::uint64_t eight = 0;
      std::memcpy(&eight, &state(begin, v), sizeof eight);
      if ((eight & (0x0101010101010101 * state_exact)) == 0) continue;
      for (int u = begin; u < std::min(begin + 8, width_); ++u)
        if ((state(u, v) & state_exact) != 0) left_out_.push_back({u, v});
    }
  }
}

bool QuickPicture::draw_pieces(const Stage& stage) {
  drawn_count_ = 0;
  edges_.clear();
  return std::ranges::all_of(stage.pieces, [&](const TubePiece& piece) { return draw_piece(stage, piece); });
}

void QuickPicture::fill_span_piece(const Stage& stage, const TubePiece& piece, Drawn& drawn) {
  const Eigen::Vector3d center = piece.p_CP + piece.R_CP * piece.bound_center;
  const Eigen::Matrix3d R_PC = piece.R_CP.transpose();
  SpanPiece& span = drawn.piece;
  const double u0 = std::round(intrinsics_.fx * center.x() / center.z() + intrinsics_.cx);
  const double v0 = std::round(intrinsics_.fy * center.y() / center.z() + intrinsics_.cy);
  span.u0 = static_cast<float>(u0), span.v0 = static_cast<float>(v0);
  span.depth0 = static_cast<float>(center.z());
  const double depth0 = span.depth0;
  const Eigen::Vector3d d = R_PC * straight_ray(intrinsics_, u0, v0).direction;
  const Eigen::Vector3d by_u = R_PC.col(0) / intrinsics_.fx, by_v = R_PC.col(1) / intrinsics_.fy;
  const Eigen::Vector3d start = piece.p_PC + depth0 * d, chord = piece.bound_center.normalized();
  const Light& light = stage.scene->light;
  const Eigen::Vector3d towards = R_PC * stage.light * (light.directional / piece.radius);
  const auto number = [](double x) { return static_cast<float>(x); };
  for (Eigen::Index i = 0; i < 3; ++i) {
    span.direction[i] = {number(d[i]), number(by_u[i]), number(by_v[i])};
    span.point[i] = {number(start[i]), number(depth0 * by_u[i]), number(depth0 * by_v[i])};
    span.middle[i] = number(piece.bound_center[i]);
    span.chord[i] = number(chord[i]);
    span.light[i] = number(towards[i]);
  }
  span.curvature = number(piece.curvature), span.radius = number(piece.radius);
  span.end_sine = number(piece.end_tangent.x()), span.end_cosine = number(piece.end_tangent.z());
  span.end_offset = number(piece.end_offset);
  const double pixel = (center.z() + piece.bound_radius) / std::min(intrinsics_.fx, intrinsics_.fy);
  span.reach = number(0.9 * pixel);
  span.ambient = number(light.ambient);
  span.channels = channels_;
}

// The planes of marker edges at the piece and what they do to its colour; false when they are seen as curves
// that no line stands for within a pixel.
bool QuickPicture::add_edges(const Stage& stage, const TubePiece& piece, Drawn& drawn) {
  const ArmLook& arm = stage.scene->arm;
  const double pixel = static_cast<double>(drawn.piece.reach) / 0.9;
  const double margin = 8 * pixel;
  const auto albedo_at = [&](double s) {
    for (std::size_t i = arm.markers.size(); i-- > 0;)
      if (s >= arm.markers[i].s_from && s < arm.markers[i].s_to) return arm.markers[i].albedo;
    return arm.albedo;
  };
  const auto channel = [&](const Color& color, std::size_t c) {
    return channels_ == 1 ? gray_of(color) : color[static_cast<Eigen::Index>(c)];
  };
  const auto& rings = stage.ring_edges;
  const auto begin = std::ranges::lower_bound(rings, piece.s - margin, {}, &RingEdge::s);
  const auto end = std::ranges::upper_bound(rings, piece.s + piece.length + margin, {}, &RingEdge::s);
  Color before = begin == end ? albedo_at(piece.s + 0.5 * piece.length) : Color();
  if (begin != end) before = albedo_at(std::nextafter(begin->s, -1e9));
  for (std::size_t c = 0; c < channels_; ++c) drawn.piece.albedo[c] = static_cast<float>(channel(before, c));
  drawn.first_edge = edges_.size();
  for (auto ring = begin; ring != end; ++ring) {
    const bool is_last_here = ring + 1 == end || (ring + 1)->s > ring->s;
    if (!is_last_here) continue;
    const Color after = albedo_at(ring->s);
    const Eigen::Vector3d normal = piece.R_CP.transpose() * ring->circle.normal;
    SpanEdge edge{};
    for (Eigen::Index i = 0; i < 3; ++i) edge.normal[i] = static_cast<float>(normal[i]);
    edge.offset = static_cast<float>(ring->circle.normal.dot(ring->circle.center - piece.p_CP));
    // Towards the contour the edge of a ring that is seen aslant runs along it.
    const double aslant = std::abs(ring->circle.normal.dot(ring->circle.center.normalized())) +
                          2 * piece.radius / ring->circle.center.z();
    if (aslant * pixel > 0.02 * piece.radius) return false;
    edge.far = static_cast<float>(pixel * (1 + aslant * std::sqrt(2.8 * piece.radius / pixel)));
    for (std::size_t c = 0; c < channels_; ++c)
      edge.change[c] = static_cast<float>(channel(after, c) - channel(before, c));
    edges_.push_back(edge);
    before = after;
  }
  drawn.piece.edge_count = edges_.size() - drawn.first_edge;
  return true;
}

bool QuickPicture::draw_piece(const Stage& stage, const TubePiece& piece) {
  const Eigen::Vector3d end = piece.p_CP + piece.R_CP * (2 * piece.bound_center);
  const double widest = std::max(piece.radius, piece.radius + piece.widening * piece.length);
  const Eigen::Vector3d center = piece.p_CP + piece.R_CP * piece.bound_center;
  const Eigen::Vector3d chord = (end - piece.p_CP).normalized();
  const double slant = chord.dot(center.normalized());
  // Around the middle between the chord and the arc. The skin goes on beyond the chord's ends as far as the
  // planes there lean, and as far as a ray gets from the axis' side to the skin.
  const double turn = piece.curvature * piece.length, sagitta = piece.length * turn / 8;
  const Eigen::Vector3d chord_P = piece.bound_center.normalized();
  const Eigen::Vector3d aside = piece.R_CP * Eigen::Vector3d(-chord_P.z(), 0, chord_P.x()) * (0.5 * sagitta);
  const double steepest = std::min(0.95, std::abs(slant) + 0.1);
  const double lean = 1.2 * std::tan(0.5 * turn) + steepest / std::sqrt(1 - steepest * steepest);
  const auto region = ImageRegion::of(intrinsics_, piece.p_CP + aside, end + aside, widest + 0.5 * sagitta,
                                      piece.is_ball ? 2 * widest : widest * (lean + 0.1));
  if (!region) return false;
  const bool is_skin = stage.bodies[static_cast<std::size_t>(piece.body)].is_arm;
  bool is_quick = is_skin && !piece.is_ball && piece.widening == 0 && slant * slant < 0.5 &&
                  piece.curvature * piece.radius < 0.5 && center.z() > 4 * piece.bound_radius;
  if (is_quick) {
    if (drawn_count_ == drawn_.size()) drawn_.emplace_back();
    Drawn& drawn = drawn_[drawn_count_];
    fill_span_piece(stage, piece, drawn);
    // Three pixels across the radius, so that no pixel has both contours.
    is_quick = 3 * drawn.piece.reach < drawn.piece.radius && add_edges(stage, piece, drawn);
  }
  if (!is_quick) {
    for_pixels(*region, width_, height_, [this](int u, int v) { leave(u, v); });
    return true;
  }
  Drawn& drawn = drawn_[drawn_count_++];
  drawn.contour.clear();
  drawn.piece.edges = edges_.data() + drawn.first_edge;
  const auto rows = region->rows(height_);
  constexpr int step = span_step;
  for (int v = rows.begin; v < rows.end; ++v) {
    const auto columns = region->columns(v, width_);
    for (int u = columns.begin / step * step; u < columns.end; u += step) {
      float depths[span_step], lights[3 * span_step];
      SpanPixels pixels{u, v, picture_->depth.row(v).data() + u,
                        picture_->light.row(v).data() + static_cast<std::size_t>(u) * channels_,
                        &state(u, v)};
      const int count = std::min(step, width_ - u);
      const auto values = static_cast<std::size_t>(count) * channels_;
      float *const depth = pixels.depth, *const light = pixels.light;
      if (count < step) {
        std::fill_n(depths, span_step, -nothing);
        std::copy_n(depth, count, depths);
        std::copy_n(light, values, lights);
        pixels.depth = depths, pixels.light = lights;
      }
      std::uint32_t bits = kernels_->draw(drawn.piece, pixels);
      if (count < step) {
        std::copy_n(depths, count, depth);
        std::copy_n(lights, values, light);
        bits &= (1u << count) - 1;
      }
      for (; bits != 0; bits &= bits - 1) drawn.contour.push_back({u + std::countr_zero(bits), v});
    }
  }
  return true;
}

// An end of the arm: flat, of one light; its rim is left out where it is seen.
bool QuickPicture::draw_disc(const Stage& stage, const DiscPart& disc) {
  const Circle& circle = disc.circle;
  const auto region = ImageRegion::of(intrinsics_, circle.center, circle.center, circle.radius);
  if (!region) return false;
  const bool is_front = circle.normal.dot(circle.center) < 0;
  for_pixels(*region, width_, height_, [&](int u, int v) {
    const Ray ray = straight_ray(intrinsics_, u, v);
    const CircleView view = view_of(circle, ray);
    const auto before = static_cast<double>(picture_->depth.at(u, v));
    for (const Border& border : view.borders) {
      if (border.distance > 0.9) continue;
      if (border.depth < before + 0.2 * circle.radius) leave(u, v);
    }
    if (!(view.value < 0) || !is_front) return;
    if (disc.arm_piece >= 0) leave(u, v);  // The narrower side comes out of it.
    const auto depth = meet_plane(circle.center, circle.normal, ray);
    if (!depth || !(*depth < before)) return;
    Hit hit;
    hit.depth = *depth;
    hit.normal = circle.normal;
    hit.part = {Part::Kind::disc, static_cast<std::uint32_t>(&disc - stage.discs.data())};
    hit.label = stage.bodies[static_cast<std::size_t>(disc.body)].label;
    picture_->depth.at(u, v) = static_cast<float>(*depth);
    store(u, v, light_of(stage, hit, ray));
    state(u, v) = static_cast<std::uint8_t>(state(u, v) | state_arm);
  });
  return true;
}

// Boxes.
bool QuickPicture::leave_face(const FacePart& part) {
  if (part.screen >= 0 || !part.face.is_front) return true;
  const Eigen::Vector3d middle = 0.5 * (part.face.corners[0] + part.face.corners[2]);
  const auto region = ImageRegion::of(intrinsics_, middle, middle, (part.face.corners[0] - middle).norm());
  if (!region) return false;
  for_pixels(*region, width_, height_, [this](int u, int v) { leave(u, v); });
  return true;
}

void QuickPicture::divide(const Drawn& drawn) {
  SpanPiece piece = drawn.piece;
  piece.edges = edges_.data() + drawn.first_edge;
  float us[span_step], vs[span_step];
  BorderPixels borders{};
  for (std::size_t begin = 0; begin < drawn.contour.size(); begin += span_step) {
    const std::size_t count = std::min(span_step, drawn.contour.size() - begin);
    for (std::size_t i = 0; i < span_step; ++i) {
      const Pixel& pixel = drawn.contour[begin + std::min(i, count - 1)];
      us[i] = static_cast<float>(pixel.u), vs[i] = static_cast<float>(pixel.v);
    }
    kernels_->divide(piece, us, vs, borders);
    for (std::size_t i = 0; i < count; ++i) merge(piece, drawn.contour[begin + i], borders, i);
  }
}

// Lays a contour over what is in the pixel.
void QuickPicture::merge(const SpanPiece& piece, Pixel pixel, const BorderPixels& borders, std::size_t i) {
  std::uint8_t& here = state(pixel.u, pixel.v);
  if ((here & state_exact) != 0) return;
  float& depth = picture_->depth.at(pixel.u, pixel.v);
  const float contour = borders.contour[i];
  if (here == state_arm && depth < contour - 2 * piece.radius) return;
  const bool is_clear = here == state_behind || (here == state_arm && depth > contour + 2 * piece.radius);
  if (!is_clear || !(depth > contour)) {
    leave(pixel.u, pixel.v);
    return;
  }
  here = state_border;
  const float share = borders.coverage[i];
  depth = std::min(depth, borders.depth[i]);
  if (!(share > 0)) return;
  float within[3];
  for (std::size_t c = 0; c < channels_; ++c) within[c] = borders.light[c * span_step + i];
  if (borders.is_simple[i] == 0)
    kernels_->sample(piece, static_cast<float>(pixel.u), static_cast<float>(pixel.v), within);
  for (std::size_t c = 0; c < channels_; ++c) {
    float& light = picture_->light.at(pixel.u, pixel.v, static_cast<int>(c));
    light += share * (within[c] - light);
  }
}

}  // namespace flexura
