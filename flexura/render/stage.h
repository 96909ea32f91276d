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

/// Properties that all primitives of a body share.
struct Body {
  SurfaceLabel label;
  Color albedo;
  bool is_arm = false;     ///< Whether the body is the arm, whose surface shows sections and markers.
  bool is_etalon = false;  ///< Whether the body is the calibration cylinder, whose surface shows red lines.
  /// Whether the body receives the shadows of all bodies, not only of the arm.
  bool takes_all_shadows = false;
};

struct DiscPart {
  Circle circle;  ///< Rim of the disc. The normal points out of the body.
  int body = 0;
  std::size_t tube_arc = 0;  ///< For the arm: index of the arc with the disc.
  double along = 0;          ///< For the arm: distance of the disc from the start of this arc, m.
  int arm_piece = -1;        ///< Piece of the arm that begins at the disc; -1: no piece.
};
struct FacePart {
  Face face;
  int body = 0;
  int screen = -1;
};
struct PlanePart {
  Eigen::Vector3d point, normal;  ///< A point of the plane, and the unit normal out of the body, both in C.
  int body = 0;
};

/// The edge of a marker ring on the arm, or the face of a guide disk, as a plane at arc length s, m.
struct RingEdge {
  double s = 0;
  Circle circle;
  bool is_disk = false;
};

/// Marker on the arm's surface from the arc length s, m, to the next stretch: an index in the scene, or -1
/// for no marker.
struct RingStretch {
  double s = 0;
  int marker = -1;
};

/// A side of a convex body, other than the arm, that casts a shadow. Seen from the light, the body is the
/// intersection of half planes. A side is the line that bounds one of these half planes.
struct CasterSide {
  Eigen::Vector3d normal;  ///< Outward unit normal in C, perpendicular to the light and the line.
  double reach = 0;        ///< Distance of the body's center from the line, m.
};
struct Caster {
  Eigen::Vector3d center;            ///< Center of the body, in C.
  std::size_t first = 0, count = 0;  ///< Range of the body's sides in Stage::caster_sides.
};

/// Edge of a red line, with the plane through edge and camera.
struct LineEdge {
  Eigen::Vector3d from, to;  ///< Ends of the edge, in C.
  double angle = 0;          ///< Angle around the calibration cylinder's +Y from its +Z, rad in (-pi, pi].
};

/// A scene in one camera's frame C, as primitives for intersection with rays. A Stage reuses memory from
/// frame to frame.
struct Stage {
  std::vector<Body> bodies;
  std::vector<TubePiece> pieces;
  std::vector<DiscPart> discs;
  std::vector<FacePart> faces;
  std::vector<PlanePart> planes;
  std::vector<RingEdge> ring_edges;  ///< Edges in order of increasing s.
  std::vector<RingStretch> rings;    ///< Stretches in order of increasing s.
  std::vector<int> open_rings;       ///< Scratch space.
  std::vector<LineEdge> line_edges;
  std::vector<Caster> casters;
  std::vector<CasterSide> caster_sides;
  Eigen::Vector3d light = {0, 0, 0};  ///< Unit direction towards the light, in C.
  int first_arm_piece = 0, last_arm_piece = -1;
  double arm_length = 0;
  double pixel = 0;  ///< Largest distance in (a, b) between the rays of neighbouring pixels.
  Pose X_CE;
  const Scene* scene = nullptr;
};

/// Computes `stage` for a scene, which must have passed check(). `pixel` is the largest distance in (a, b)
/// between the rays of neighbouring pixels.
void build_stage(const Scene& scene, const Pose& X_WC, double pixel, Stage& stage);

/// An end of a tube.
struct TubeEnd {
  TipKind shape = TipKind::flat;
  int body = 0;  ///< Body to which a flat end's disc belongs.
};

/// Adds the pieces and ends of a tube. Where the radius jumps between arcs, a disc that belongs to
/// `step_body` closes the wider arc.
void add_tube(std::span<const Arc> arcs, const Pose& X_CW, int body, int step_body,
              const std::array<TubeEnd, 2>& ends, Stage& stage);

}  // namespace flexura
