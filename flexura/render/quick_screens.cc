#include <algorithm>
#include <cmath>
#include <limits>

#include "flexura/render/cell.h"
#include "flexura/render/quick_picture.h"

namespace flexura {
namespace {

constexpr float nothing = std::numeric_limits<float>::infinity();

double value_at(const Linear& f, double right, double down) {
  return static_cast<double>(f.value) + static_cast<double>(f.by_u) * right +
         static_cast<double>(f.by_v) * down;
}

}  // namespace

void QuickPicture::plan_screens(const Stage& stage) {
  panel_count_ = 0;
  float steepest = 0;
  for (const FacePart& part : stage.faces) {
    if (part.screen < 0) continue;
    if (panel_count_ == panels_.size()) panels_.emplace_back();
    Panel& panel = panels_[panel_count_++];
    fill_panel(stage, part, panel);
    const Panel::Nearness& nearness = panel.nearness;
    // Within a pixel of the line where two screens meet, their inverse depths differ by less than the change
    // of both. Depths are stored in single precision.
    const double change =
        1.2 * pixel_ * std::max(intrinsics_.fx, intrinsics_.fy) * std::hypot(nearness.by_u, nearness.by_v);
    const double largest = std::abs(nearness.value) + std::abs(nearness.by_u) * width_ +
                           std::abs(nearness.by_v) * static_cast<double>(height_);
    constexpr double rounding = 1e-6;
    const auto uncertain = static_cast<float>(change + rounding * largest);
    panel.screen.least_distance = uncertain + steepest;
    steepest = std::max(steepest, uncertain);
  }
}

// Positions are relative to the image's middle.
void QuickPicture::fill_panel(const Stage& stage, const FacePart& part, Panel& panel) const {
  const Screen& look = stage.scene->screens[static_cast<std::size_t>(part.screen)];
  const Face& face = part.face;
  SpanScreen& screen = panel.screen;
  const Eigen::Vector2d middle_pixel(width_ / 2, height_ / 2);
  screen.u0 = number(middle_pixel.x()), screen.v0 = number(middle_pixel.y());
  const Eigen::Vector3d by = face.normal / face.normal.dot(face.corners[0]);
  screen.nearness = along_rays(by, middle_pixel);
  panel.nearness = {by.dot(straight_ray(intrinsics_, middle_pixel.x(), middle_pixel.y()).direction),
                    by.x() / intrinsics_.fx, by.y() / intrinsics_.fy};
  const Eigen::Vector3d middle = 0.5 * (face.corners[0] + face.corners[2]);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Eigen::Vector3d way = 0.5 * (face.corners[axis == 0 ? 1 : 3] - face.corners[0]);
    const Eigen::Vector3d along = way / way.squaredNorm();
    screen.place[axis] = along_rays(along, middle_pixel);
    screen.middle[axis] = static_cast<float>(along.dot(middle));
    screen.gradient[axis] = static_cast<float>(look.gradient[axis]);
  }
  screen.falloff = static_cast<float>(look.falloff);
  for (Eigen::Index c = 0; c < 3; ++c)
    screen.brightness[c] = static_cast<float>(channels_ == 1 ? gray_of(look.brightness) : look.brightness[c]);
  screen.channels = channels_;
  screen.is_plain = look.gradient[0] == 0 && look.gradient[1] == 0 && look.falloff == 0;
  panel.light.resize(static_cast<std::size_t>(width_) * channels_);
  for (std::size_t i = 0; i < panel.light.size(); ++i) panel.light[i] = screen.brightness[i % channels_];
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d& edge = face.edges[i];
    const double by_u = edge.x() / intrinsics_.fx, by_v = edge.y() / intrinsics_.fy;
    const double largest = pixel_ * std::max(intrinsics_.fx, intrinsics_.fy);
    const double margin = 1.2 * largest * std::hypot(by_u, by_v);
    panel.edges[i] = {edge.dot(straight_ray(intrinsics_, 0, 0).direction), by_u, by_v, margin};
    screen.edges[i] = along_rays(edge / margin, middle_pixel);
  }
}

void QuickPicture::draw_screens(SpanRow& row) {
  // Without distortion the first screen also sets the background that it does not cover.
  if (panel_count_ == 0 || row.lens.u != nullptr) clear(0, width_, row);
  for (std::size_t i = 0; i < panel_count_; ++i) draw_panel(i, row);
}

void QuickPicture::clear(int begin, int end, SpanRow& row) const {
  const auto count = static_cast<std::size_t>(end - begin);
  std::fill_n(row.depth + begin, count, nothing);
  std::copy_n(background_.data(), count * channels_, row.light + static_cast<std::size_t>(begin) * channels_);
}

// Finds, row by row, the columns at least a pixel inside all edges. Pixels closer to an edge are divided or
// left out.
void QuickPicture::draw_panel(std::size_t index, SpanRow& row) {
  const Panel& panel = panels_[index];
  const bool is_first = index == 0;
  if (row.lens.u != nullptr) {
    kernels_->screen(panel.screen, 0, width_, is_first, row);
    return;
  }
  double inner_from = -infinity, inner_to = infinity, outer_from = -infinity, outer_to = infinity;
  for (const Panel::Edge& edge : panel.edges) {
    const double value = edge.value + edge.by_v * row.v;
    const auto cut = [&](double least, double& from, double& to) {
      if (edge.by_u > 0) from = std::max(from, (least - value) / edge.by_u);
      if (edge.by_u < 0) to = std::min(to, (least - value) / edge.by_u);
      if (edge.by_u == 0 && value < least) to = -infinity;
    };
    cut(edge.margin, inner_from, inner_to);
    cut(-edge.margin, outer_from, outer_to);
  }
  const PixelRange outer = PixelRange::around(outer_from, outer_to, width_);
  PixelRange inner = PixelRange::around(inner_from, inner_to, width_);
  inner.begin = std::clamp(inner.begin, outer.begin, outer.end);
  inner.end = std::clamp(inner.end, inner.begin, outer.end);
  if (is_first) {
    clear(0, inner.begin, row);
    clear(inner.end, width_, row);
  }
  // Edges of other screens in front of or behind this one.
  for (int u = outer.begin; u < outer.end && row.has_edge; ++u)
    if ((row.state[u] & state_edge) != 0) leave(u, row.v);
  for (int u = outer.begin; u < inner.begin; ++u) draw_edge(panel, u, row);
  for (int u = inner.end; u < outer.end; ++u) draw_edge(panel, u, row);
  if (inner.begin == inner.end) return;
  const Linear& nearness = panel.screen.nearness;
  const float here = nearness.value + nearness.by_v * (static_cast<float>(row.v) - panel.screen.v0);
  const auto nearness_at = [&](int u) {
    return here + nearness.by_u * (static_cast<float>(u) - panel.screen.u0);
  };
  if (!(nearness_at(inner.begin) > 0) || !(nearness_at(inner.end - 1) > 0)) {
    for (int u = inner.begin; u < inner.end; ++u) leave(u, row.v);
    if (is_first) clear(inner.begin, inner.end, row);
    return;
  }
  const auto count = static_cast<std::size_t>(inner.end - inner.begin);
  if (is_first && panel.screen.is_plain)
    std::copy_n(panel.light.data(), count * channels_,
                row.light + static_cast<std::size_t>(inner.begin) * channels_);
  if (is_first && panel.screen.is_plain && nearness.by_u == 0)
    std::fill_n(row.depth + inner.begin, count, 1 / here);
  else if (index == 1)
    draw_around_crossing(inner, row);
  else
    kernels_->screen(panel.screen, inner.begin, inner.end, is_first, row);
}

// Draws the second panel. It intersects the first panel where their inverse depths are equal, which is a
// straight line in the image.
void QuickPicture::draw_around_crossing(const PixelRange& inner, SpanRow& row) {
  const Panel &panel = panels_[1], &other = panels_[0];
  const SpanScreen& screen = panel.screen;
  const double y = row.v - static_cast<double>(screen.v0), middle = static_cast<double>(screen.u0);
  const double value = panel.nearness.at(0, y) - other.nearness.at(0, y),
               by_u = panel.nearness.by_u - other.nearness.by_u,
               by_v = panel.nearness.by_v - other.nearness.by_v;
  const auto margin = static_cast<double>(screen.least_distance);
  const double slope = std::hypot(by_u, by_v);
  if (!std::isfinite(value + slope + margin)) {  // The other panel is seen edge-on.
    for (int u = inner.begin; u < inner.end; ++u) leave(u, row.v);
    return;
  }
  const double side = margin / std::abs(by_u), at = middle - value / by_u;
  PixelRange crossing = by_u == 0
                            ? PixelRange{inner.begin, std::abs(value) < margin ? inner.end : inner.begin}
                            : PixelRange::around(at - side, at + side, width_);
  crossing.begin = std::clamp(crossing.begin, inner.begin, inner.end);
  crossing.end = std::clamp(crossing.end, crossing.begin, inner.end);
  kernels_->screen(screen, inner.begin, crossing.begin, false, row);
  kernels_->screen(screen, crossing.end, inner.end, false, row);
  // Coplanar screens, up to rounding, meet everywhere.
  constexpr double rounding = 1e-9;
  const bool is_one_plane = slope <= rounding * panel.nearness.at(0, y);
  for (int u = crossing.begin; u < crossing.end; ++u) {
    std::uint8_t& what = state(u, row.v);
    if ((what & (state_exact | state_edge)) != 0) continue;
    const double x = u - middle, here = value + by_u * x;
    constexpr double corner = 0.75;  // px from the middle, and more.
    const bool is_first_there = !std::isinf(row.depth[u]),
               is_divided = is_first_there && std::abs(here) < corner * slope;
    if (is_first_there && (is_one_plane || (here == 0 && !is_divided))) {
      leave(u, row.v);
      continue;
    }
    PixelPart part{here > 0 || !is_first_there ? 1.0 : 0.0};
    if (is_divided) part = part_above({by_u, by_v}, here);
    if (part.area > 0 && part.area < 1)
      what = static_cast<std::uint8_t>(what | state_edge), row.has_edge = true;
    if (here > 0 || part.area == 1) row.depth[u] = static_cast<float>(1 / panel.nearness.at(x, y));
    if (part.area > 0) mix(panel, u, part, is_first_there ? &other : nullptr, row);
  }
}

// Returns the part of a pixel where a linear function, `value` in the pixel's middle, is positive.
QuickPicture::PixelPart QuickPicture::part_above(const Eigen::Vector2d& slope, double value) {
  const SquarePart part = part_beyond(0.5, slope.normalized(), -value / slope.norm());
  return {part.area, part.centroid};
}

// Mixes the panel's part of a pixel with what is behind it: one panel's light in the whole pixel, or the
// background.
void QuickPicture::mix(const Panel& panel, int u, const PixelPart& part, const Panel* behind,
                       SpanRow& row) const {
  const double x = u - static_cast<double>(panel.screen.u0), y = row.v - static_cast<double>(panel.screen.v0);
  const PixelPart rest = part.rest();
  float* const light = row.light + static_cast<std::size_t>(u) * channels_;
  float seen[3], left[3] = {light[0], light[channels_ > 1 ? 1 : 0], light[channels_ > 2 ? 2 : 0]};
  light_of(panel, x + part.centroid.x(), y + part.centroid.y(), seen);
  if (behind != nullptr && rest.area > 0)
    light_of(*behind, x + rest.centroid.x(), y + rest.centroid.y(), left);
  for (std::size_t c = 0; c < channels_; ++c)
    light[c] = left[c] + static_cast<float>(part.area) * (seen[c] - left[c]);
}

// Computes the panel's light x and y px from its (u0, v0).
void QuickPicture::light_of(const Panel& panel, double x, double y, float (&light)[3]) const {
  const SpanScreen& screen = panel.screen;
  const double depth = 1 / panel.nearness.at(x, y);
  double rise = 1, square = 0;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double place =
        depth * value_at(screen.place[axis], x, y) - static_cast<double>(screen.middle[axis]);
    rise += static_cast<double>(screen.gradient[axis]) * place;
    square += place * place;
  }
  const double factor = std::max(0.0, rise * (1 - 0.5 * static_cast<double>(screen.falloff) * square));
  for (std::size_t c = 0; c < channels_; ++c) light[c] = screen.brightness[c] * static_cast<float>(factor);
}

// Draws a pixel that one edge divides in front of the background; leaves out all other pixels with the edge.
void QuickPicture::draw_edge(const Panel& panel, int u, SpanRow& row) {
  const Panel::Edge* here = nullptr;
  double value_here = 0;
  bool is_one = (state(u, row.v) & (state_exact | state_edge)) == 0;
  for (const Panel::Edge& edge : panel.edges) {
    const double value = edge.value + edge.by_v * row.v + edge.by_u * u;
    if (value >= edge.margin) continue;
    if (value <= -edge.margin) return;
    is_one = is_one && here == nullptr;
    here = &edge, value_here = value;
  }
  const SpanScreen& screen = panel.screen;
  const double x = u - static_cast<double>(screen.u0), y = row.v - static_cast<double>(screen.v0);
  const double nearness = panel.nearness.at(x, y);
  const bool is_before_nothing = std::isinf(row.depth[u]);
  const double before = nearness - 1 / static_cast<double>(row.depth[u]);
  const bool is_hidden = !is_before_nothing && before < -static_cast<double>(screen.least_distance);
  if (is_one && here != nullptr && nearness > 0 && std::isfinite(nearness)) {
    if (is_hidden) return;
    const PixelPart part = part_above({here->by_u, here->by_v}, value_here);
    const double there = panel.nearness.at(x + part.centroid.x(), y + part.centroid.y());
    if (is_before_nothing && there > 0 && std::isfinite(1 / there)) {
      row.state[u] = static_cast<std::uint8_t>(row.state[u] | state_edge);
      row.has_edge = true;
      if (value_here > 0) row.depth[u] = static_cast<float>(1 / nearness);
      if (part.area > 0) mix(panel, u, part, nullptr, row);
      return;
    }
  }
  leave(u, row.v);
}

}  // namespace flexura
