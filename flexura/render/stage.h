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

/// Common properties of a body's primitives.
struct Body {
  SurfaceLabel label;
  Color albedo;
  bool is_arm = false;             ///< Its skin shows sections and markers.
  bool is_etalon = false;          ///< Its skin shows the lines.
  bool takes_all_shadows = false;  ///< Whether it receives all shadows, not only the arm's.
};

struct DiscPart {
  Circle circle;  ///< Its normal points out of the body.
  int body = 0;
  std::size_t tube_arc = 0;  ///< On an arm: the arc that holds it.
  double along = 0;          ///< On an arm: distance from the start of that arc, m.
  int arm_piece = -1;        ///< The arm's piece that emerges from it; -1: no piece.
};
struct FacePart {
  Face face;
  int body = 0;
  int screen = -1;
};
struct PlanePart {
  Eigen::Vector3d point, normal;  ///< A point of the plane, C; unit normal out of the body.
  int body = 0;
};

/// The edge of a marker ring on the arm, or the plane of a guide disk's face.
struct RingEdge {
  double s = 0;
  Circle circle;
  bool is_disk = false;
};

/// What the arm's skin shows from an arc length on: a marker of the scene, or -1 for no marker.
struct RingStretch {
  double s = 0;
  int marker = -1;
};

/// A convex body other than the arm as seen from the light: the intersection of the half planes of these
/// lines.
struct CasterSide {
  Eigen::Vector3d normal;  ///< Unit normal, C, across the light and the line, outwards.
  double reach = 0;        ///< Distance of the body's middle from the line, m.
};
struct Caster {
  Eigen::Vector3d center;            ///< Center in C.
  std::size_t first = 0, count = 0;  ///< Range in the stage's caster_sides.
};

/// Edge of a red line, with the plane through it and the camera.
struct LineEdge {
  Eigen::Vector3d from, to;  ///< Ends of the edge, C.
  double angle = 0;          ///< Angle around the etalon's +Y from its +Z, rad in (-pi, pi].
};

/// A scene in one camera's frame C, as primitives for ray intersection. Its vectors are reused from frame to
/// frame.
struct Stage {
  std::vector<Body> bodies;
  std::vector<TubePiece> pieces;
  std::vector<DiscPart> discs;
  std::vector<FacePart> faces;
  std::vector<PlanePart> planes;
  std::vector<RingEdge> ring_edges;  ///< Edges by ascending s.
  std::vector<RingStretch> rings;    ///< Stretches by ascending s.
  std::vector<int> open_rings;       ///< Scratch space.
  std::vector<LineEdge> line_edges;
  std::vector<Caster> casters;
  std::vector<CasterSide> caster_sides;
  Eigen::Vector3d light = {0, 0, 0};  ///< Unit direction towards the light, C.
  int first_arm_piece = 0, last_arm_piece = -1;
  double arm_length = 0;
  double pixel = 0;  ///< Length of the largest step in (a, b) per pixel.
  Pose X_CE;
  const Scene* scene = nullptr;
};

/// Fills `stage`. `pixel`: the largest step in (a, b) between neighbouring pixels. The scene must have passed
/// check().
void build_stage(const Scene& scene, const Pose& X_WC, double pixel, Stage& stage);

/// An end of a tube.
struct TubeEnd {
  TipKind shape = TipKind::flat;
  int body = 0;  ///< Body of a flat end's disc.
};

/// Adds the pieces and ends of a tube; where the radius jumps between arcs, a disc of `step_body` closes the
/// wider one.
void add_tube(std::span<const Arc> arcs, const Pose& X_CW, int body, int step_body,
              const std::array<TubeEnd, 2>& ends, Stage& stage);

}  // namespace flexura
