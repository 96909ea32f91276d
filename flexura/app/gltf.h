#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/math/pose.h"

namespace flexura {

/// A triangle mesh. Vertices are in m, in the axes of the mesh's node, or of the world if the mesh has a
/// skin.
struct GltfMesh {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3d> normals;  ///< Unit vectors, one per vertex.
  /// Number of the skin's joint that moves each vertex; empty without a skin.
  std::vector<std::uint16_t> joints;
  /// Three vertex numbers per triangle, counter-clockwise seen from outside.
  std::vector<std::uint32_t> triangles;
};

/// A part of a node: a mesh and its material. A node shows one or more parts.
struct GltfPart {
  GltfMesh mesh;
  std::size_t material = 0;
};

/// A glTF 2.0 document with one scene, one skin at most and one animation at most (Khronos Group, "glTF 2.0
/// Specification"). Functions that add an element return its index among the elements of its kind, from 0.
/// The axes are those of the world, with Y up, in metres. Equal calls produce equal bytes.
class GltfDocument {
 public:
  /// Motion of a node: its poses at the animation's times, in the axes of its parent. Between these times,
  /// positions are interpolated linearly and rotations spherically.
  struct Track {
    std::size_t node = 0;
    std::vector<Pose> poses;  ///< One pose per time of the animation.
  };

  /// Adds a colour: red, green, blue as on a screen (sRGB) and opacity, from 0 to 1.
  std::size_t add_material(const std::string& name, const std::array<double, 3>& color, double opacity = 1,
                           bool is_two_sided = false);
  /// Adds a mesh of one or more parts.
  std::size_t add_mesh(const std::string& name, std::span<const GltfPart> parts);
  /// Adds a camera with the vertical field of view `field`, rad. `aspect` is width over height. The camera
  /// looks along -z of its node.
  std::size_t add_camera(const std::string& name, double field, double aspect);

  /// Adds a node at a pose in the scene. `content` has the node's mesh, camera, children or skin as members
  /// such as {"mesh": 0}. It may be empty.
  std::size_t add_node(const std::string& name, const Pose& pose, const Node::Table& content = {});
  /// Makes the node `child` a child of the node `parent`. The pose of the child is relative to the parent.
  void set_parent(std::size_t child, std::size_t parent);
  /// Adds a skin whose joints are these nodes. `rest` has the world pose of each joint for the undeformed
  /// mesh.
  std::size_t add_skin(std::span<const std::size_t> joints, std::span<const Pose> rest);
  /// Adds the animation. `times`: at least two increasing times, s.
  void add_animation(const std::string& name, std::span<const double> times, std::span<const Track> tracks);

  /// Returns the document as one binary file (.glb). `generator` names the program.
  [[nodiscard]] std::string glb(std::string_view generator) const;

 private:
  /// Adds numbers to the buffer as floats. Returns the accessor's number.
  std::size_t add_floats(const std::string& type, std::size_t per_element, std::span<const double> values,
                         int target = 0, bool has_bounds = false);
  std::size_t add_accessor(const std::string& type, int component, std::size_t count, std::size_t start,
                           int target);

  std::string buffer_;
  Node::Array views_, accessors_, materials_, meshes_, cameras_, nodes_, skins_, animations_;
  std::vector<std::vector<std::size_t>> children_;  // By node.
  std::vector<bool> is_child_;                      // By node.
};

}  // namespace flexura
