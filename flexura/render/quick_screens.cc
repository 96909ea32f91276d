#include <algorithm>
#include <cmath>
#include <limits>

#include "flexura/render/quick_picture.h"
#include "flexura/render/ray_field.h"
#include "flexura/render/tracer.h"

namespace flexura {
namespace {

constexpr float nothing = std::numeric_limits<float>::infinity();

bool is_plain_screen(const Screen& screen) {
  return screen.gradient[0] == 0 && screen.gradient[1] == 0 && screen.falloff == 0;
}

}  // namespace

void QuickPicture::draw_screens(const Stage& stage) {
  bool is_first = true;
  for (const FacePart& part : stage.faces) {
    if (part.screen < 0) continue;
    draw_screen(stage, part, is_first);
    is_first = false;
    for (const FacePart& other : stage.faces)
      if (&other != &part && other.screen >= 0) leave_crossing(part.face, other.face);
  }
  if (!is_first) return;
  std::ranges::fill(picture_->depth.values(), nothing);
  for (int v = 0; v < height_; ++v)
    for (int u = 0; u < width_; ++u) store(u, v, stage.scene->background);
}

// Row by row: the columns that are a pixel or more within all edges. Those closer to an edge are left out.
void QuickPicture::draw_screen(const Stage& stage, const FacePart& part, bool is_first) {
  const Screen& screen = stage.scene->screens[static_cast<std::size_t>(part.screen)];
  const Face& face = part.face;
  const double scale = face.normal.dot(face.corners[0]);
  const double limit = width_;
  const auto whole = [&](double x) { return static_cast<int>(std::clamp(std::ceil(x), 0.0, limit)); };
  const auto set_behind = [&](int v, int from, int to) {
    for (int u = from; u < to; ++u) {
      picture_->depth.at(u, v) = nothing;
      store(u, v, stage.scene->background);
    }
  };
  for (int v = 0; v < height_; ++v) {
    const Ray row = straight_ray(intrinsics_, 0, v);
    const double infinity = std::numeric_limits<double>::infinity();
    double inner_from = -infinity, inner_to = infinity, outer_from = -infinity, outer_to = infinity;
    for (const Eigen::Vector3d& edge : face.edges) {
      const double value = edge.dot(row.direction), by_u = edge.x() / intrinsics_.fx;
      const double margin = 1.2 * std::hypot(by_u, edge.y() / intrinsics_.fy);
      const auto cut = [&](double least, double& from, double& to) {
        if (by_u > 0) from = std::max(from, (least - value) / by_u);
        if (by_u < 0) to = std::min(to, (least - value) / by_u);
        if (by_u == 0 && value < least) to = -infinity;
      };
      cut(margin, inner_from, inner_to);
      cut(-margin, outer_from, outer_to);
    }
    const int outer_begin = whole(outer_from), outer_end = std::max(outer_begin, whole(outer_to));
    const int begin = std::clamp(whole(inner_from), outer_begin, outer_end);
    const int end = std::clamp(whole(inner_to), begin, outer_end);
    if (is_first) set_behind(v, 0, begin), set_behind(v, end, width_);
    for (int u = outer_begin; u < begin; ++u) leave(u, v);
    for (int u = end; u < outer_end; ++u) leave(u, v);
    if (begin == end) continue;
    const double value = face.normal.dot(row.direction), by_u = face.normal.x() / intrinsics_.fx;
    const auto depth_at = [&](int u) { return scale / (value + by_u * u); };
    const bool is_before_camera = depth_at(begin) > 1e-6 && depth_at(end - 1) > 1e-6;
    if (!is_before_camera) {
      for (int u = begin; u < end; ++u) leave(u, v);
      if (is_first) set_behind(v, begin, end);
      continue;
    }
    float* const depth = picture_->depth.row(v).data();
    const auto count = static_cast<std::size_t>(end - begin);
    kernels_->plane(static_cast<float>(scale), static_cast<float>(value + by_u * begin),
                    static_cast<float>(by_u), row_depth_.data(), count);
    const bool is_plain = is_plain_screen(screen);
    if (is_first) std::copy_n(row_depth_.data(), count, depth + begin);
    if (is_first && is_plain && channels_ == 1) {
      std::fill_n(picture_->light.row(v).data() + begin, count,
                  static_cast<float>(gray_of(screen.brightness)));
      continue;
    }
    Hit hit;
    hit.label = {SurfaceKind::screen, static_cast<std::uint16_t>(part.screen)};
    hit.part = {Part::Kind::face, static_cast<std::uint32_t>(&part - stage.faces.data())};
    for (int u = begin; u < end; ++u) {
      const float here = row_depth_[static_cast<std::size_t>(u - begin)];
      if (!is_first && !(here < depth[u])) continue;
      depth[u] = here;
      hit.depth = here;
      store(u, v, is_plain ? screen.brightness : light_of(stage, hit, straight_ray(intrinsics_, u, v)));
    }
  }
}

// Where the planes of two screens meet: the difference of their points' inverse depths is linear in the
// image.
void QuickPicture::leave_crossing(const Face& one, const Face& other) {
  const Eigen::Vector3d difference =
      one.normal / one.normal.dot(one.corners[0]) - other.normal / other.normal.dot(other.corners[0]);
  if (!difference.allFinite()) return;
  const double by_u = difference.x() / intrinsics_.fx, by_v = difference.y() / intrinsics_.fy;
  const double reach = 1.2 * std::hypot(by_u, by_v), limit = width_;
  for (int v = 0; v < height_; ++v) {
    const double value = difference.dot(straight_ray(intrinsics_, 0, v).direction);
    double from = 0, to = limit;
    if (by_u != 0) {
      from = std::clamp((-value - std::copysign(reach, by_u)) / by_u, 0.0, limit);
      to = std::clamp((-value + std::copysign(reach, by_u)) / by_u + 1, 0.0, limit);
    } else if (std::abs(value) > reach) {
      continue;
    }
    for (int u = static_cast<int>(from); u < static_cast<int>(to); ++u) leave(u, v);
  }
}

}  // namespace flexura
