#include "flexura/render/tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexura {
namespace {

// All directions (a, b, 1) within `radius` of (a, b) in the plane z = 1.
struct Cone {
  Eigen::Vector3d direction;
  double radius;
};

// A part of the image, plus the reach of borders around it.
Cone cone_of(const RayField& rays, int u0, int v0, int u1, int v1) {
  Cone cone{{0, 0, 1}, std::numeric_limits<double>::infinity()};
  const auto middle = rays.ray((u0 + u1) / 2, (v0 + v1) / 2);
  if (!middle) return cone;
  cone.direction = middle->direction;
  double radius = 0;
  for (const int u : {u0, (u0 + u1) / 2, u1}) {
    for (const int v : {v0, (v0 + v1) / 2, v1}) {
      const auto ray = rays.ray(u, v);
      if (!ray) return cone;
      radius = std::max(radius, (ray->direction - middle->direction).norm());
    }
  }
  cone.radius = radius * 1.02 + (border_reach + 1.5) * rays.largest_step();
  return cone;
}

// Returns whether the cone may come within `radius` of the segment from p to q, in C. False only if this is
// certain.
bool may_touch(const Cone& cone, const Eigen::Vector3d& p, const Eigen::Vector3d& q, double radius) {
  const double deepest = std::max(p.z(), q.z()) + radius;
  if (!(deepest > 0)) return false;
  const double reach = radius + cone.radius * deepest;
  if (!(reach < std::numeric_limits<double>::infinity())) return true;
  // Nearest points of the ray depth * direction and the segment.
  const Eigen::Vector3d &d = cone.direction, edge = q - p;
  const double dd = d.squaredNorm(), de = d.dot(edge), ee = edge.squaredNorm(), dp = d.dot(p),
               ep = edge.dot(p);
  const double scale = dd * ee - de * de;
  double part = scale > 1e-12 * dd * ee ? std::clamp((de * dp - dd * ep) / scale, 0.0, 1.0) : 0.5;
  double depth = std::max(0.0, (dp + part * de) / dd);
  if (ee > 0) part = std::clamp((depth * de - ep) / ee, 0.0, 1.0);
  depth = std::max(0.0, (dp + part * de) / dd);
  double square = (p + part * edge - depth * d).squaredNorm();
  if (scale <= 1e-12 * dd * ee) square = std::min(square, 0.0);
  return square <= reach * reach;
}

bool may_touch(const Cone& cone, const TubePiece& piece) {
  // The distance of an arc of up to 30 degrees from its chord is at most a fifteenth of its length.
  const Eigen::Vector3d end = piece.p_CP + piece.R_CP * (2 * piece.bound_center);
  const double widest = piece.widest();
  return may_touch(cone, piece.p_CP, end, widest + piece.length * piece.length * piece.curvature / 8);
}

bool may_touch(const Cone& cone, const Face& face) {
  return std::ranges::all_of(face.edges, [&](const Eigen::Vector3d& edge) {
    return !(edge.dot(cone.direction) < -cone.radius * edge.head<2>().norm());
  });
}

bool may_touch(const Cone& cone, const PlanePart& plane) {
  return plane.normal.dot(cone.direction) <= cone.radius * plane.normal.head<2>().norm();
}

bool may_touch(const Stage& stage, const Cone& cone, Part part) {
  if (!(cone.radius < std::numeric_limits<double>::infinity())) return true;
  switch (part.kind) {
    case Part::Kind::piece:
      return may_touch(cone, stage.pieces[part.index]);
    case Part::Kind::disc: {
      const Circle& circle = stage.discs[part.index].circle;
      return may_touch(cone, circle.center, circle.center, circle.radius);
    }
    case Part::Kind::face:
      return may_touch(cone, stage.faces[part.index].face);
    case Part::Kind::plane:
      return may_touch(cone, stage.planes[part.index]);
  }
  return true;
}

template <typename List>
void add_all(Part::Kind kind, const List& list, std::vector<Part>& parts) {
  for (std::size_t i = 0; i < list.size(); ++i) parts.push_back({kind, static_cast<std::uint32_t>(i)});
}

}  // namespace

namespace {

// Tiles along a block's side.
constexpr int block = 4;

int blocks_of(int tiles) { return (tiles + block - 1) / block; }

// Index in a row-wise table of lists.
std::size_t place(int column, int row, int columns) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
}

}  // namespace

void Tiles::build(const Stage& stage, const RayField& rays) {
  stage_ = &stage;
  rays_ = &rays;
  columns_ = (rays.width() + size - 1) / size;
  rows_ = (rays.height() + size - 1) / size;
  all_.clear();
  add_all(Part::Kind::piece, stage.pieces, all_);
  add_all(Part::Kind::disc, stage.discs, all_);
  add_all(Part::Kind::face, stage.faces, all_);
  add_all(Part::Kind::plane, stage.planes, all_);
  tiles_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  blocks_.resize(static_cast<std::size_t>(blocks_of(columns_)) * static_cast<std::size_t>(blocks_of(rows_)));
  room_.clear();
  for (auto* lists : {&tiles_, &blocks_})
    for (List& list : *lists) list.is_known = false;
}

std::vector<Part>& Tiles::Room::with(std::size_t parts) {
  constexpr std::size_t usual = 4096;
  const auto is_full = [&](const std::vector<Part>& chunk) {
    return chunk.capacity() - chunk.size() < parts;
  };
  while (current_ < chunks_.size() && is_full(chunks_[current_])) ++current_;
  if (current_ == chunks_.size()) chunks_.emplace_back().reserve(std::max(parts, usual));
  return chunks_[current_];
}

void Tiles::Room::clear() {
  for (std::vector<Part>& chunk : chunks_) chunk.clear();
  current_ = 0;
}

std::span<const Part> Tiles::fill(List& list, std::span<const Part> from, int column, int row,
                                  int tiles) const {
  if (list.is_known) return list.parts;
  const Cone cone =
      cone_of(*rays_, column * size, row * size, std::min((column + tiles) * size, rays_->width()) - 1,
              std::min((row + tiles) * size, rays_->height()) - 1);
  std::vector<Part>& parts = room_.with(from.size());
  const std::size_t begin = parts.size();
  for (const Part part : from)
    if (may_touch(*stage_, cone, part)) parts.push_back(part);
  list = {true, std::span<const Part>(parts).subspan(begin)};
  return list.parts;
}

std::span<const Part> Tiles::parts(int column, int row) const {
  const int block_column = column / block, block_row = row / block;
  List& around = blocks_[place(block_column, block_row, blocks_of(columns_))];
  const auto near = fill(around, all_, block_column * block, block_row * block, block);
  return fill(tiles_[place(column, row, columns_)], near, column, row, 1);
}

}  // namespace flexura
