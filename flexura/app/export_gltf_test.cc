// The motion of a run as glTF: the file's structure and the arm's places. tests/node/gltf_test.mjs validates
// whole files.
#include "flexura/app/export_gltf.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "flexura/app/commands.h"
#include "flexura/app/gltf_shapes.h"
#include "flexura/base/source.h"
#include "flexura/math/pose.h"
#include "flexura/store/json.h"
#include "flexura/view/recording.h"
#include "tests/support/checkout.h"
#include "tests/support/runs.h"

namespace flexura {
namespace {

using testing::HasSubstr;

constexpr const char* small_run = R"(
[arm]
kind = "spatial"
[[arm.section]]
length = 0.5
radius = [0.03, 0.02]
[[arm.section]]
length = 0.4
radius = 0.02
[arm.look]
tip = "round"
[[obstacle]]
kind = "plane"
normal = [0, 1, 0]
point = [0, -1, 0]
[[obstacle]]
kind = "capsule"
from = [1, 0, 0]
to = [1, 2, 0]
radius = 0.1
[[obstacle]]
kind = "box"
center = [-1, 0, 0]
half_sizes = [0.1, 0.2, 0.3]
[[obstacle]]
kind = "sphere"
center = [-1, 1, 0]
radius = 0.1
[[task]]
kind = "move"
duration = 0.5
to = { bends = [[1.2, 0.4], [-2, 0.3]] }
[record]
report = false
)";

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::size_t count_of(const Node& node, const char* key) {
  return static_cast<std::size_t>(*node.find(key)->as<std::int64_t>());
}

// A .glb file, read back.
struct Glb {
  explicit Glb(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(word(bytes, 4), 2U);
    EXPECT_EQ(word(bytes, 8), bytes.size());
    const std::size_t size = word(bytes, 12);
    json = parse_json(bytes.substr(20, size), "glb");
    binary = bytes.substr(20 + size + 8);
    EXPECT_EQ(size % 4, 0U);
    EXPECT_EQ(binary.size() % 4, 0U);
  }
  [[nodiscard]] const Node& at(const char* list, std::size_t i) const {
    return json.find(list)->as<Node::Array>()->at(i);
  }
  // Returns element i of an accessor of floats, with `size` numbers.
  [[nodiscard]] std::vector<double> element(std::size_t accessor, std::size_t i, std::size_t size) const {
    const Node& view = at("bufferViews", count_of(at("accessors", accessor), "bufferView"));
    std::vector<double> values;
    for (std::size_t k = 0; k < size; ++k)
      values.push_back(std::bit_cast<float>(word(binary, count_of(view, "byteOffset") + 4 * (i * size + k))));
    return values;
  }
  Node json;
  std::string binary;
};

// Returns a joint's pose at time i of the animation by its chain of joints.
Pose joint_pose(const Glb& glb, std::size_t joint, std::size_t time) {
  const Node& animation = glb.at("animations", 0);
  Pose pose;
  for (std::size_t j = 0; j <= joint; ++j) {
    const auto output = [&](std::size_t channel) {
      const Node& target = animation.find("channels")->as<Node::Array>()->at(channel);
      EXPECT_EQ(count_of(*target.find("target"), "node"), j);
      return count_of(animation.find("samplers")->as<Node::Array>()->at(channel), "output");
    };
    const auto p = glb.element(output(2 * j), time, 3), q = glb.element(output(2 * j + 1), time, 4);
    pose = pose * Pose{Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix(),
                       {p[0], p[1], p[2]}};
  }
  return pose;
}

TEST(ExportGltf, HasTheArmWhereItWas) {
  Runs runs;
  const RunResult result = runs.run(small_run);
  std::ostringstream out, err;
  const std::string file = (result.folder / "arm.glb").string();
  EXPECT_EQ(export_command({.results = result.folder.string(), .format = "gltf", .out = file}, out, err), 0);
  EXPECT_EQ(out.str(), "glTF: " + file + "\n");
  const Glb glb(read_text_file(file, std::size_t{1} << 30));
  const Recording recording(result.folder);
  const std::size_t joints = glb.at("skins", 0).find("joints")->as<Node::Array>()->size();
  const std::size_t times = count_of(
      glb.at("accessors",
             count_of(glb.at("animations", 0).find("samplers")->as<Node::Array>()->front(), "input")),
      "count");
  EXPECT_EQ(times, 16U) << "30 a second";
  for (const std::size_t time : {std::size_t{0}, times - 1}) {
    const double t = 0.5 * static_cast<double>(time) / static_cast<double>(times - 1);
    const Backbone backbone = recording.rig()->model.backbone(recording.state(recording.state_at(t)));
    for (std::size_t j = 0; j < joints; j += 4) {
      const double s = backbone.length() * static_cast<double>(j) / static_cast<double>(joints - 1);
      // Both sections have 16 pieces.
      const double at =
          j <= 16 ? 0.5 * static_cast<double>(j) / 16 : 0.5 + 0.4 * static_cast<double>(j - 16) / 16;
      const Pose expected = backbone.pose(at), found = joint_pose(glb, j, time);
      EXPECT_LT((found.position - expected.position).norm(), 1e-5) << j << " at " << t << ", " << s;
      EXPECT_LT((found.rotation - expected.rotation).norm(), 1e-5) << j;
    }
  }
  EXPECT_EQ(glb.json.find("cameras")->as<Node::Array>()->size(), 2U);
  EXPECT_THAT(write_json(glb.json), HasSubstr("obstacle 4"));
  // A file is never overwritten, and equal runs give equal files.
  EXPECT_THROW((void)export_gltf(result.folder, file), std::runtime_error);
  const GltfExport again = export_gltf(result.folder, "");
  EXPECT_EQ(again.file, result.folder / "gltf" / "arm.glb");
  EXPECT_EQ(read_text_file(again.file, std::size_t{1} << 30), read_text_file(file, std::size_t{1} << 30));
}

TEST(ExportGltf, HasTheTrueArmOnItsArcs) {
  Runs runs;
  const RunResult result =
      runs.run(std::string(small_run) +
               "[[truth.arm.section]]\nlength = 0.51\n[[truth.arm.section]]\nlength = 0.41\n");
  const Recording recording(result.folder);
  ASSERT_TRUE(recording.has_truth());
  const Glb glb(read_text_file(export_gltf(result.folder, "").file, std::size_t{1} << 30));
  const auto truth = *recording.truth(recording.duration());
  const Pose tip = joint_pose(glb, 32, 15);
  EXPECT_LT((tip.position - truth.back().X_WS.position).norm(), 1e-5);
  // Pieces of one arc turn evenly.
  std::vector<double> turns;
  for (std::size_t j = 1; j <= 12; ++j) {
    const Eigen::Vector3d a = joint_pose(glb, j - 1, 15).rotation.col(2),
                          b = joint_pose(glb, j, 15).rotation.col(2);
    turns.push_back(std::acos(std::min(1.0, a.dot(b))));
  }
  EXPECT_THAT(turns, testing::Each(testing::DoubleNear(turns.front(), 1e-3)));
  EXPECT_GT(turns.front(), 0.05);
}

TEST(ExportGltf, RefusesAFileForOtherFormats) {
  std::ostringstream out, err;
  EXPECT_THROW((void)export_command({.results = "x", .format = "csv", .out = "a.glb"}, out, err), InputError);
  EXPECT_THROW((void)export_command({.results = "/no/such", .format = "gltf", .out = ""}, out, err),
               InputError);
}

TEST(ExportGltf, HasTheColoursOfAReport) {
  const std::string css = read_text_file(checkout_file("flexura/report/figure.css"), std::size_t{1} << 20);
  const auto hex = [](const std::array<double, 3>& c) {
    return fmt::format("#{:02x}{:02x}{:02x}", std::lround(255 * c[0]), std::lround(255 * c[1]),
                       std::lround(255 * c[2]));
  };
  for (std::size_t i = 0; i < section_colors.size(); ++i)
    EXPECT_THAT(css, HasSubstr(fmt::format(".s{} {{ color: {}; }}", i, hex(section_colors[i]))));
  EXPECT_THAT(css, HasSubstr(".obstacle { fill: " + hex(report_obstacle_color)));
}

// Every triangle's corners are counter-clockwise from outside, as their normals say.
TEST(GltfShapes, FaceOutwards) {
  std::vector<GltfMesh> meshes{ball_mesh(0.1), box_mesh({0.1, 0.2, 0.3}), capsule_mesh(0.1, 0.5),
                               square_mesh(1)};
  const std::vector<TubeRing> rings{{{}, 0.1, 0}, {{Eigen::Matrix3d::Identity(), {0, 0, 1}}, 0.1, 1}};
  for (const TipKind kind : {TipKind::flat, TipKind::round}) {
    GltfMesh& tube = meshes.emplace_back(tube_mesh(rings));
    add_lid(rings.front(), kind, -1, tube);
    add_lid(rings.back(), kind, 1, tube);
    EXPECT_EQ(tube.joints.size(), tube.positions.size());
  }
  for (const GltfMesh& mesh : meshes) {
    ASSERT_EQ(mesh.positions.size(), mesh.normals.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
      const auto p = [&](std::size_t k) { return mesh.positions.at(mesh.triangles[i + k]); };
      const Eigen::Vector3d across = (p(1) - p(0)).cross(p(2) - p(0));
      for (std::size_t k = 0; k < 3; ++k) ASSERT_GT(across.dot(mesh.normals[mesh.triangles[i + k]]), 0) << i;
    }
  }
}

}  // namespace
}  // namespace flexura
