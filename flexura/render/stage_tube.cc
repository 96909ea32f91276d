#include <algorithm>
#include <cmath>
#include <numbers>

#include "flexura/math/series.h"
#include "flexura/render/stage.h"

namespace flexura {
namespace {

constexpr double largest_turn = std::numbers::pi / 6;
// Distance in the image below which a passing ray is reported as a near miss, px.
constexpr double near_miss = 3;

// Overlap of a piece with the next one, relative to its size.
constexpr double overlap = 1e-10;

// Computes the derived members.
void complete(TubePiece& piece, double pixel) {
  const double turn = piece.curvature * piece.length;
  piece.p_PC = -(piece.R_CP.transpose() * piece.p_CP);
  const Eigen::Vector3d end(piece.length * turn * cosc(turn), 0, piece.length * sinc(turn));
  if (!piece.is_ball) {
    piece.end_tangent = {std::sin(turn), 0, std::cos(turn)};
    piece.end_offset = end.z();
  }
  // An arc of less than half a turn is inside the ball whose diameter is its chord.
  piece.bound_center = 0.5 * end;
  piece.bound_radius = 0.5 * end.norm() + piece.widest();
  const double farthest = (piece.bound_center - piece.p_PC).norm() + piece.bound_radius;
  piece.near_radius = piece.bound_radius + near_miss * pixel * farthest;
}

// Adds `piece`, and links it to the last piece if it continues this piece (`goes_on`).
void add_piece(TubePiece& piece, bool goes_on, Stage& stage) {
  const int here = static_cast<int>(stage.pieces.size());
  if (goes_on) {
    piece.before = here - 1;
    TubePiece& last = stage.pieces.back();
    last.after = here;
    // Lets the two pieces overlap, so that rounding leaves no gap for rays.
    last.end_offset += overlap * (last.length + last.radius);
  }
  complete(piece, stage.pixel);
  stage.pieces.push_back(piece);
}

void add_arc(const Arc& arc, std::size_t index, const Pose& X_CW, int body, bool goes_on, Stage& stage) {
  const double theta = arc.bend.norm();
  const int count = std::max(1, static_cast<int>(std::ceil(theta / largest_turn)));
  TubePiece piece;
  piece.body = body;
  piece.tube_arc = index;
  piece.curvature = theta / arc.length;
  piece.length = arc.length / count;
  piece.widening = (arc.radius[1] - arc.radius[0]) / arc.length;
  const Eigen::Vector2d towards = theta > 0 ? Eigen::Vector2d(arc.bend / theta) : Eigen::Vector2d(1, 0);
  Eigen::Matrix3d spin;
  spin << towards.x(), -towards.y(), 0, towards.y(), towards.x(), 0, 0, 0, 1;
  for (int i = 0; i < count; ++i) {
    const double from = i * piece.length;
    const Pose X_CS = X_CW * arc.carried(from);
    piece.R_CP = X_CS.rotation * spin;
    piece.p_CP = X_CS.position;
    piece.start_in_arc = from;
    piece.s = arc.s + from;
    piece.radius = arc.radius[0] + piece.widening * from;
    add_piece(piece, goes_on || i > 0, stage);
    piece.before = piece.after = -1;
  }
}

TubePiece ball(const Arc& tube_arc, std::size_t index, bool at_end, const Pose& X_CW, int body) {
  const double along = at_end ? tube_arc.length : 0.0;
  const Pose X_CS = X_CW * tube_arc.pose(along);
  TubePiece piece;
  piece.is_ball = true;
  piece.R_CP = X_CS.rotation;
  piece.p_CP = X_CS.position;
  piece.radius = tube_arc.radius[at_end ? 1 : 0];
  piece.s = tube_arc.s + along;
  piece.is_cut_before = at_end;
  piece.is_cut_after = !at_end;
  piece.body = body;
  piece.tube_arc = index;
  piece.start_in_arc = along;
  return piece;
}

void add_disc(const Arc& tube_arc, std::size_t index, bool at_end, bool points_back, const Pose& X_CW,
              int body, Stage& stage) {
  const double along = at_end ? tube_arc.length : 0.0;
  const Pose X_CS = X_CW * tube_arc.pose(along);
  const double radius = tube_arc.radius[at_end ? 1 : 0];
  stage.discs.push_back({circle_at(X_CS.rotation, X_CS.position, radius, points_back), body, index, along});
}

}  // namespace

void add_tube(std::span<const Arc> arcs, const Pose& X_CW, int body, int step_body,
              const std::array<TubeEnd, 2>& ends, Stage& stage) {
  bool goes_on = ends[0].shape == TipKind::round;
  if (goes_on) {
    TubePiece start = ball(arcs.front(), 0, false, X_CW, body);
    add_piece(start, false, stage);
  } else {
    add_disc(arcs.front(), 0, false, true, X_CW, ends[0].body, stage);
  }
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    if (i > 0) {
      const double before = arcs[i - 1].radius[1], after = arcs[i].radius[0];
      goes_on = std::abs(before - after) <= 1e-12 * before;
      if (!goes_on && before > after) add_disc(arcs[i - 1], i - 1, true, false, X_CW, step_body, stage);
      if (!goes_on && before < after) add_disc(arcs[i], i, false, true, X_CW, step_body, stage);
      // The narrower side emerges from the disc.
      const auto next = static_cast<int>(stage.pieces.size());
      if (!goes_on) stage.discs.back().arm_piece = before > after ? next : next - 1;
    }
    add_arc(arcs[i], i, X_CW, body, goes_on, stage);
  }
  const std::size_t last = arcs.size() - 1;
  if (ends[1].shape == TipKind::round) {
    TubePiece end = ball(arcs[last], last, true, X_CW, body);
    add_piece(end, true, stage);
  } else {
    add_disc(arcs[last], last, true, false, X_CW, ends[1].body, stage);
  }
}

}  // namespace flexura
