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

/// A triangle mesh: vertices in the axes of its node (or, with a skin, of the world), m.
struct GltfMesh {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3d> normals;  ///< Unit vectors, one per vertex.
  std::vector<std::uint16_t> joints;     ///< Joint of the skin for each vertex; empty without a skin.
  std::vector<std::uint32_t> triangles;  ///< Three vertices each, counter-clockwise from outside.
};

/// A mesh with its material, a part of what one node shows.
struct GltfPart {
  GltfMesh mesh;
  std::size_t material = 0;
};

/// A glTF 2.0 document with one scene, one skin at most and one animation at most (Khronos Group, "glTF 2.0
/// Specification"). Everything that is added gets the next number of its kind, from 0. Axes are the world's:
/// Y up, metres. Equal calls give equal bytes.
class GltfDocument {
 public:
  /// A motion of a node: its poses at the animation's times, in the axes of its parent. Between them,
  /// positions are linear and rotations spherically linear.
  struct Track {
    std::size_t node = 0;
    std::vector<Pose> poses;  ///< One per time.
  };

  /// Adds a colour: red, green, blue as on a screen (sRGB) and opacity, from 0 to 1.
  std::size_t add_material(const std::string& name, const std::array<double, 3>& color, double opacity = 1,
                           bool is_two_sided = false);
  /// Adds a mesh of one or more parts.
  std::size_t add_mesh(const std::string& name, std::span<const GltfPart> parts);
  /// Adds a camera with a vertical field of view, rad, and a width over height. It looks along its node's -z.
  std::size_t add_camera(const std::string& name, double field, double aspect);

  /// Adds a node at a pose in the scene. `content` is its mesh, camera, children or skin: empty, or a table
  /// of members such as {"mesh": 0}.
  std::size_t add_node(const std::string& name, const Pose& pose, const Node::Table& content = {});
  /// Makes a node the child of another instead of the scene. Its pose is then in the other's axes.
  void set_parent(std::size_t child, std::size_t parent);
  /// Adds the skin whose joints are these nodes. `rest` has the pose in the world of each at which the
  /// skinned mesh has its shape.
  std::size_t add_skin(std::span<const std::size_t> joints, std::span<const Pose> rest);
  /// Adds the animation. Times increase, s; there are two or more.
  void add_animation(const std::string& name, std::span<const double> times, std::span<const Track> tracks);

  /// Returns the document as one binary file (.glb). `generator` names the program.
  [[nodiscard]] std::string glb(std::string_view generator) const;

 private:
  /// Adds numbers to the buffer, each as a float or as another type. Returns the accessor's number.
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
