#include "flexura/render/truth.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "flexura/render/cell.h"
#include "flexura/render/prepared_scene.h"
#include "flexura/render/tracer.h"

namespace flexura {
namespace {

constexpr int values_per_kind = 4096;

// Calls visit(u, v, tracer, ray) for all pixels that have a ray and may show a surface.
template <typename Visit>
void for_all_pixels(const Renderer& renderer, Visit&& visit) {
  const RayField& rays = renderer.prepared().rays;
  const Tiles& tiles = renderer.prepared().tiles;
  for (int v = 0; v < rays.height(); ++v) {
    for (int u = 0; u < rays.width(); ++u) {
      const auto parts = tiles.parts(u / Tiles::size, v / Tiles::size);
      const auto ray = rays.ray(u, v);
      if (!parts.empty() && ray) visit(u, v, Tracer(renderer.prepared().stage, parts), *ray);
    }
  }
}

template <typename T>
void fill(Image<T>& image, const RayField& rays, T value) {
  image = Image<T>(rays.width(), rays.height(), 1, value);
}

AxisPoint axis_point(const Renderer& renderer, const Tracer& tracer, double s) {
  const Arc& at = tube_arc_at(renderer.prepared().stage.scene->arm.tube, s);
  AxisPoint point;
  point.s = s;
  const double along = std::clamp(s - at.s, 0.0, at.length);
  const Eigen::Vector3d p_CP = renderer.prepared().view.X_WC.inverse() * at.pose(along).position;
  point.depth = p_CP.z();
  point.pixel = renderer.prepared().view.lens.project(p_CP);
  if (!point.pixel) return point;
  Ray ray;
  ray.direction = p_CP / p_CP.z();
  ray.by_pixel = Eigen::Matrix2d::Identity() * renderer.prepared().rays.largest_step();
  // At the arm's ends the point lies on the surface.
  const double depth = p_CP.z() * (1 + 1e-9);
  const Hit hit = tracer.hit(ray);
  const bool is_arm = hit.label.kind == SurfaceKind::section || hit.label.kind == SurfaceKind::marker ||
                      hit.label.kind == SurfaceKind::cap;
  point.is_visible = is_arm && hit.depth <= depth && tracer.entries_into_arm(ray, depth) == 1;
  return point;
}

}  // namespace

std::uint16_t label_value(SurfaceLabel label) {
  return static_cast<std::uint16_t>(static_cast<int>(label.kind) * values_per_kind + label.index);
}

SurfaceLabel label_from_value(std::uint16_t value) {
  return {static_cast<SurfaceKind>(value / values_per_kind),
          static_cast<std::uint16_t>(value % values_per_kind)};
}

PixelTruth pixel_truth(const Renderer& renderer, int u, int v) {
  const RayField& rays = renderer.prepared().rays;
  if (u < 0 || v < 0 || u >= rays.width() || v >= rays.height())
    throw std::out_of_range("there is no such pixel");
  const auto ray = rays.ray(u, v);
  if (!ray) return {};
  const auto parts = renderer.prepared().tiles.parts(u / Tiles::size, v / Tiles::size);
  const Hit hit = Tracer(renderer.prepared().stage, parts).hit(*ray);
  return {hit.label, hit.depth, hit.s};
}

void truth_maps(const Renderer& renderer, TruthMaps& maps) {
  fill(maps.depth, renderer.prepared().rays, std::numeric_limits<float>::infinity());
  fill(maps.label, renderer.prepared().rays, label_value({}));
  fill(maps.s, renderer.prepared().rays, std::numeric_limits<float>::quiet_NaN());
  for_all_pixels(renderer, [&](int u, int v, const Tracer& tracer, const Ray& ray) {
    const Hit hit = tracer.hit(ray);
    maps.depth.at(u, v) = static_cast<float>(hit.depth);
    maps.label.at(u, v) = label_value(hit.label);
    maps.s.at(u, v) = static_cast<float>(hit.s);
  });
}

Image<float> coverage(const Renderer& renderer, SurfaceKind kind, std::optional<std::uint16_t> index) {
  Image<float> result(renderer.prepared().rays.width(), renderer.prepared().rays.height());
  for_all_pixels(renderer, [&](int u, int v, const Tracer& tracer, const Ray& ray) {
    double sum = 0;
    cover(tracer, ray, {0, 0}, 0.5, 0, tracer.trace(ray), [&](const Hit& hit, const Ray&, double area) {
      if (hit.label.kind == kind && (!index || hit.label.index == *index)) sum += area;
    });
    result.at(u, v) = static_cast<float>(sum);
  });
  return result;
}

std::vector<AxisPoint> projected_axis(const Renderer& renderer, std::span<const double> s) {
  std::vector<AxisPoint> points;
  const Stage& stage = renderer.prepared().stage;
  const auto& tube = stage.scene->arm.tube;
  if (tube.empty()) return points;
  points.reserve(s.size());
  const Tracer tracer(stage, renderer.prepared().tiles.all_parts());
  for (const double at : s)
    points.push_back(axis_point(renderer, tracer, std::clamp(at, tube.front().s, stage.arm_length)));
  return points;
}

std::vector<MarkerView> marker_views(const Renderer& renderer) {
  const auto& markers = renderer.prepared().stage.scene->arm.markers;
  std::vector<MarkerView> views(markers.size());
  if (renderer.prepared().stage.scene->arm.tube.empty()) return views;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const double middle = 0.5 * (markers[i].s_from + markers[i].s_to);
    views[i].center = projected_axis(renderer, {&middle, 1}).front();
  }
  for_all_pixels(renderer, [&](int u, int v, const Tracer& tracer, const Ray& ray) {
    const Eigen::Vector2d pixel(u, v);
    cover(tracer, ray, {0, 0}, 0.5, 0, tracer.trace(ray), [&](const Hit& hit, const Ray& at, double area) {
      if (hit.label.kind != SurfaceKind::marker) return;
      const Eigen::Vector2d offset = ray.by_pixel.inverse() * (at.direction - ray.direction).head<2>();
      views[hit.label.index].area += area;
      views[hit.label.index].centroid += area * (pixel + offset);
    });
  });
  for (MarkerView& view : views)
    if (view.area > 0) view.centroid /= view.area;
  return views;
}

}  // namespace flexura
