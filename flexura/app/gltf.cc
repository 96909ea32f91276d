#include "flexura/app/gltf.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "flexura/store/json.h"

namespace flexura {
namespace {

// Numbers of the specification.
constexpr int float_type = 5126, short_type = 5123, int_type = 5125;
constexpr int vertex_target = 34962, index_target = 34963;
constexpr std::size_t alignment = 4;

Node count_node(std::size_t value) { return {static_cast<std::int64_t>(value), {}}; }

Node::Member member(std::string key, Node node) { return {std::move(key), {}, std::move(node)}; }

template <std::unsigned_integral T>
void put(std::string& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) out += static_cast<char>(value >> (8 * i) & 0xFF);
}

template <std::ranges::input_range Values>
Node numbers_node(const Values& values) {
  Node::Array array;
  for (const double value : values) array.push_back(number_node(value));
  return {std::move(array), {}};
}

Node counts_node(std::span<const std::size_t> values) {
  Node::Array array;
  for (const std::size_t value : values) array.push_back(count_node(value));
  return {std::move(array), {}};
}

// Screens show numbers by this curve; materials have the light itself (IEC 61966-2-1).
double light_of(double shown) {
  return shown <= 0.04045 ? shown / 12.92 : std::pow((shown + 0.055) / 1.055, 2.4);
}

std::array<double, 4> xyzw(const Pose& pose) {
  const Eigen::Vector4d q = quaternion_wxyz(pose.rotation);
  return {q[1], q[2], q[3], q[0]};
}

std::vector<double> flat(std::span<const Eigen::Vector3d> vectors) {
  std::vector<double> values;
  values.reserve(3 * vectors.size());
  for (const Eigen::Vector3d& v : vectors) values.insert(values.end(), {v.x(), v.y(), v.z()});
  return values;
}

void pad(std::string& bytes, char filler) {
  bytes.append((alignment - bytes.size() % alignment) % alignment, filler);
}

}  // namespace

std::size_t GltfDocument::add_accessor(const std::string& type, int component, std::size_t count,
                                       std::size_t start, int target) {
  Node::Table view{member("buffer", count_node(0)), member("byteOffset", count_node(start)),
                   member("byteLength", count_node(buffer_.size() - start))};
  if (target != 0) view.push_back(member("target", {std::int64_t{target}, {}}));
  views_.push_back({std::move(view), {}});
  accessors_.push_back({Node::Table{member("bufferView", count_node(views_.size() - 1)),
                                    member("componentType", {std::int64_t{component}, {}}),
                                    member("count", count_node(count)), member("type", text_node(type))},
                        {}});
  pad(buffer_, '\0');
  return accessors_.size() - 1;
}

std::size_t GltfDocument::add_floats(const std::string& type, std::size_t per_element,
                                     std::span<const double> values, int target, bool has_bounds) {
  const std::size_t start = buffer_.size();
  // Bounds are those of the rounded numbers, as readers find them.
  std::vector<double> least(per_element, HUGE_VAL), most(per_element, -HUGE_VAL);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = static_cast<float>(values[i]) + 0.0F;  // Without negative zeros.
    put(buffer_, std::bit_cast<std::uint32_t>(value));
    least[i % per_element] = std::min(least[i % per_element], static_cast<double>(value));
    most[i % per_element] = std::max(most[i % per_element], static_cast<double>(value));
  }
  const std::size_t accessor = add_accessor(type, float_type, values.size() / per_element, start, target);
  if (has_bounds) {
    auto& table = *accessors_.back().as<Node::Table>();
    table.push_back(member("min", numbers_node(least)));
    table.push_back(member("max", numbers_node(most)));
  }
  return accessor;
}

std::size_t GltfDocument::add_material(const std::string& name, const std::array<double, 3>& color,
                                       double opacity, bool is_two_sided) {
  const std::array<double, 4> factor{light_of(color[0]), light_of(color[1]), light_of(color[2]), opacity};
  Node::Table material{
      member("name", text_node(name)),
      member("pbrMetallicRoughness",
             {Node::Table{member("baseColorFactor", numbers_node(factor)),
                          member("metallicFactor", {0.0, {}}), member("roughnessFactor", {0.6, {}})},
              {}})};
  if (opacity < 1) material.push_back(member("alphaMode", text_node("BLEND")));
  if (is_two_sided) material.push_back(member("doubleSided", {true, {}}));
  materials_.push_back({std::move(material), {}});
  return materials_.size() - 1;
}

std::size_t GltfDocument::add_mesh(const std::string& name, std::span<const GltfPart> parts) {
  Node::Array primitives;
  for (const GltfPart& part : parts) {
    const GltfMesh& mesh = part.mesh;
    Node::Table attributes{
        member("POSITION", count_node(add_floats("VEC3", 3, flat(mesh.positions), vertex_target, true))),
        member("NORMAL", count_node(add_floats("VEC3", 3, flat(mesh.normals), vertex_target)))};
    if (!mesh.joints.empty()) {
      // Each vertex belongs to one joint; the format has four.
      const std::size_t start = buffer_.size();
      std::vector<double> weights;
      for (const std::uint16_t joint : mesh.joints) {
        for (const std::uint16_t value : {joint, std::uint16_t{0}, std::uint16_t{0}, std::uint16_t{0}})
          put(buffer_, value);
        weights.insert(weights.end(), {1, 0, 0, 0});
      }
      attributes.push_back(member("JOINTS_0", count_node(add_accessor("VEC4", short_type, mesh.joints.size(),
                                                                      start, vertex_target))));
      attributes.push_back(member("WEIGHTS_0", count_node(add_floats("VEC4", 4, weights, vertex_target))));
    }
    const std::size_t start = buffer_.size();
    for (const std::uint32_t vertex : mesh.triangles) put(buffer_, vertex);
    const std::size_t indices = add_accessor("SCALAR", int_type, mesh.triangles.size(), start, index_target);
    primitives.push_back(
        {Node::Table{member("attributes", {std::move(attributes), {}}),
                     member("indices", count_node(indices)), member("material", count_node(part.material))},
         {}});
  }
  meshes_.push_back(
      {Node::Table{member("name", text_node(name)), member("primitives", {std::move(primitives), {}})}, {}});
  return meshes_.size() - 1;
}

std::size_t GltfDocument::add_camera(const std::string& name, double field, double aspect) {
  constexpr double nearest = 0.01;  // m
  cameras_.push_back(
      {Node::Table{member("name", text_node(name)), member("type", text_node("perspective")),
                   member("perspective", {Node::Table{member("yfov", number_node(field)),
                                                      member("aspectRatio", number_node(aspect)),
                                                      member("znear", number_node(nearest))},
                                          {}})},
       {}});
  return cameras_.size() - 1;
}

std::size_t GltfDocument::add_node(const std::string& name, const Pose& pose, const Node::Table& content) {
  Node::Table node{member("name", text_node(name))};
  if (pose.position != Eigen::Vector3d::Zero())
    node.push_back(member("translation",
                          numbers_node(std::array{pose.position.x(), pose.position.y(), pose.position.z()})));
  if (pose.rotation != Eigen::Matrix3d::Identity())
    node.push_back(member("rotation", numbers_node(xyzw(pose))));
  std::ranges::copy(content, std::back_inserter(node));
  nodes_.push_back({std::move(node), {}});
  children_.emplace_back();
  is_child_.push_back(false);
  return nodes_.size() - 1;
}

void GltfDocument::set_parent(std::size_t child, std::size_t parent) {
  children_.at(parent).push_back(child);
  is_child_.at(child) = true;
}

std::size_t GltfDocument::add_skin(std::span<const std::size_t> joints, std::span<const Pose> rest) {
  std::vector<double> matrices;
  for (const Pose& pose : rest) {
    const Pose inverse = pose.inverse();
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = inverse.rotation;
    matrix.topRightCorner<3, 1>() = inverse.position;
    matrices.insert(matrices.end(), matrix.data(), matrix.data() + matrix.size());  // Column by column.
  }
  const std::size_t accessor = add_floats("MAT4", 16, matrices);
  skins_.push_back({Node::Table{member("inverseBindMatrices", count_node(accessor)),
                                member("joints", counts_node(joints))},
                    {}});
  return skins_.size() - 1;
}

void GltfDocument::add_animation(const std::string& name, std::span<const double> times,
                                 std::span<const Track> tracks) {
  const std::size_t input = add_floats("SCALAR", 1, times, 0, true);
  Node::Array samplers, channels;
  const auto add_channel = [&](std::size_t node, const char* path, std::size_t output) {
    samplers.push_back(
        {Node::Table{member("input", count_node(input)), member("output", count_node(output))}, {}});
    channels.push_back(
        {Node::Table{
             member("sampler", count_node(samplers.size() - 1)),
             member("target",
                    {Node::Table{member("node", count_node(node)), member("path", text_node(path))}, {}})},
         {}});
  };
  for (const Track& track : tracks) {
    std::vector<Eigen::Vector3d> positions;
    std::vector<double> rotations;
    Eigen::Vector4d last = Eigen::Vector4d::Zero();
    for (const Pose& pose : track.poses) {
      positions.push_back(pose.position);
      // Of q and -q the one on the side of the last: some programs do not look for the shorter way.
      Eigen::Vector4d q = quaternion_wxyz(pose.rotation);
      if (q.dot(last) < 0) q = -q;
      rotations.insert(rotations.end(), {q[1], q[2], q[3], q[0]});
      last = q;
    }
    add_channel(track.node, "translation", add_floats("VEC3", 3, flat(positions)));
    add_channel(track.node, "rotation", add_floats("VEC4", 4, rotations));
  }
  animations_.push_back(
      {Node::Table{member("name", text_node(name)), member("samplers", {std::move(samplers), {}}),
                   member("channels", {std::move(channels), {}})},
       {}});
}

std::string GltfDocument::glb(std::string_view generator) const {
  Node::Array nodes = nodes_, roots;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!children_[i].empty())
      nodes[i].as<Node::Table>()->push_back(member("children", counts_node(children_[i])));
    if (!is_child_[i]) roots.push_back(count_node(i));
  }
  Node::Table root{
      member("asset", {Node::Table{member("version", text_node("2.0")),
                                   member("generator", text_node(std::string(generator)))},
                       {}}),
      member("scene", count_node(0)),
      member("scenes", {Node::Array{{Node::Table{member("nodes", {std::move(roots), {}})}, {}}}, {}}),
      member("nodes", {std::move(nodes), {}}),
      member("buffers",
             {Node::Array{{Node::Table{member("byteLength", count_node(buffer_.size()))}, {}}}, {}})};
  // The format has no empty lists.
  const std::pair<const char*, const Node::Array*> lists[] = {
      {"bufferViews", &views_}, {"accessors", &accessors_}, {"materials", &materials_},  {"meshes", &meshes_},
      {"cameras", &cameras_},   {"skins", &skins_},         {"animations", &animations_}};
  for (const auto& [key, list] : lists)
    if (!list->empty()) root.push_back(member(key, {*list, {}}));

  std::string json = write_json({std::move(root), {}});
  pad(json, ' ');
  constexpr std::uint32_t magic = 0x46546C67, version = 2, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
  std::string file;
  put(file, magic);
  put(file, version);
  put(file, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer_.size()));
  put(file, static_cast<std::uint32_t>(json.size()));
  put(file, json_chunk);
  file += json;
  put(file, static_cast<std::uint32_t>(buffer_.size()));
  put(file, binary_chunk);
  file += buffer_;
  return file;
}

}  // namespace flexura
