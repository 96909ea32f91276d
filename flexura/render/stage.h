#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/render/flat.h"
#include "flexura/render/scene.h"
#include "flexura/render/surface_label.h"
#include "flexura/render/tube_piece.h"

namespace flexura {

/// What a body's primitives have in common.
struct Body {
  SurfaceLabel label;
  Color albedo;
  bool is_arm = false;             ///< Its skin shows sections and markers.
  bool is_etalon = false;          ///< Its skin shows the lines.
  bool takes_all_shadows = false;  ///< Not the arm's alone.
};

struct DiscPart {
  Circle circle;  ///< Its normal points out of the body.
  int body = 0;
  std::size_t tube_arc = 0;  ///< Where it is on an arm: the arc
  double along = 0;          ///< and the distance from the arc's start, m.
  int arm_piece = -1;        ///< The piece of the arm that comes out of it; -1: none.
};
struct FacePart {
  Face face;
  int body = 0;
  int screen = -1;
};
struct PlanePart {
  Eigen::Vector3d point, normal;  ///< C; unit, out of the body.
  int body = 0;
};

/// The edge of a marker ring on the arm, or the plane of a guide disk's face.
struct RingEdge {
  double s = 0;
  Circle circle;
  bool is_disk = false;
};

/// What the arm's skin shows from an arc length on: a marker of the scene; -1: none.
struct RingStretch {
  double s = 0;
  int marker = -1;
};

/// A convex body other than the arm as the light sees it: what lies within all these lines.
struct CasterSide {
  Eigen::Vector3d normal;  ///< C; unit, across the light and the line, outwards.
  double reach = 0;        ///< Of the body's middle from the line, m.
};
struct Caster {
  Eigen::Vector3d center;            ///< C.
  std::size_t first = 0, count = 0;  ///< Of the stage's sides.
};

/// A red line's edge: it leaves the camera in a plane.
struct LineEdge {
  Eigen::Vector3d from, to;  ///< Its ends, C.
  double angle = 0;          ///< Around the etalon's +Y from its +Z, rad in (-pi, pi].
};

/// A scene as one camera sees it, in C: primitives that rays can be held against. Its vectors are used again
/// from frame to frame.
struct Stage {
  std::vector<Body> bodies;
  std::vector<TubePiece> pieces;
  std::vector<DiscPart> discs;
  std::vector<FacePart> faces;
  std::vector<PlanePart> planes;
  std::vector<RingEdge> ring_edges;  ///< By s.
  std::vector<RingStretch> rings;    ///< By s.
  std::vector<int> open_rings;       ///< Room for making them.
  std::vector<LineEdge> line_edges;
  std::vector<Caster> casters;
  std::vector<CasterSide> caster_sides;
  Eigen::Vector3d light = {0, 0, 0};  ///< C, unit, towards it.
  int first_arm_piece = 0, last_arm_piece = -1;
  double arm_length = 0;
  double pixel = 0;  ///< Length of the largest step in (a, b) by one pixel.
  Pose X_CE;
  const Scene* scene = nullptr;
};

/// Fills `stage`. `pixel`: the largest step in (a, b) between neighbouring pixels. The scene must have passed
/// check().
void build_stage(const Scene& scene, const Pose& X_WC, double pixel, Stage& stage);

/// How a tube ends.
struct TubeEnd {
  TipKind shape = TipKind::flat;
  int body = 0;  ///< Of a flat end's disc.
};

/// Adds the pieces and ends of a tube; where the radius jumps from one arc to the next a disc of `step_body`
/// closes the wider one.
void add_tube(std::span<const Arc> arcs, const Pose& X_CW, int body, int step_body,
              const std::array<TubeEnd, 2>& ends, Stage& stage);

}  // namespace flexura
