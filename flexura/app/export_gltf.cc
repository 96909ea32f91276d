#include "flexura/app/export_gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "flexura/app/gltf.h"
#include "flexura/app/gltf_shapes.h"
#include "flexura/base/version.h"
#include "flexura/log/results.h"
#include "flexura/math/arrays.h"
#include "flexura/math/series.h"
#include "flexura/math/so3.h"
#include "flexura/store/text_file.h"
#include "flexura/view/recording.h"

namespace flexura {
namespace {

constexpr std::array<double, 3> rgb(unsigned color) {
  return {(color >> 16) / 255.0, (color >> 8 & 0xFF) / 255.0, (color & 0xFF) / 255.0};
}

// The time between poses, and how many there are at most.
constexpr double pose_rate = 30;  // Hz
constexpr std::size_t most_poses = 3000;

// Joints of a section: a piece between two of them is drawn straight.
constexpr std::size_t usual_joints = 16, most_joints = 512;

Node::Table content(const char* key, std::size_t number) {
  return {{key, {}, {static_cast<std::int64_t>(number), {}}}};
}

// A joint of the skin: a place on the arm at rest.
struct Joint {
  double s_rest;        // m from the base.
  std::size_t section;  // To which the piece after it belongs.
  Pose rest;            // Of the straight arm in the world.
};

std::vector<Joint> joints_of(const Arm& arm) {
  const std::size_t per_section = std::clamp<std::size_t>(most_joints / arm.sections.size(), 1, usual_joints);
  std::vector<Joint> joints;
  double s = 0;
  const auto add = [&](double at, std::size_t section) {
    joints.push_back({at, section, arm.X_WB * Pose{Eigen::Matrix3d::Identity(), {0, 0, at}}});
  };
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const double length = arm.sections[i].length;
    for (std::size_t j = 0; j < per_section; ++j)
      add(s + length * static_cast<double>(j) / static_cast<double>(per_section), i);
    s += length;
  }
  add(s, arm.sections.size() - 1);
  return joints;
}

double radius_at(const Section& section, double fraction) {
  return section.radius[0] + fraction * (section.radius[1] - section.radius[0]);
}

// The tube of each section in its colour, with lids at the base and the tip.
std::vector<GltfPart> tube_parts(const Arm& arm, TipKind tip, const std::vector<Joint>& joints,
                                 std::size_t first_material) {
  std::vector<GltfPart> parts;
  double base = 0;
  std::size_t joint = 0;
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const Section& section = arm.sections[i];
    std::vector<TubeRing> rings;
    for (;; ++joint) {
      const double fraction = std::clamp((joints[joint].s_rest - base) / section.length, 0.0, 1.0);
      rings.push_back({joints[joint].rest, radius_at(section, fraction), static_cast<std::uint16_t>(joint)});
      const bool is_last = joint + 1 == joints.size() || (rings.size() > 1 && joints[joint].section != i);
      if (is_last) break;  // The next section begins at the same joint.
    }
    base += section.length;
    GltfPart part{tube_mesh(rings), first_material + i % section_colors.size()};
    if (i == 0) add_lid(rings.front(), TipKind::flat, -1, part.mesh);
    if (i + 1 == arm.sections.size()) add_lid(rings.back(), tip, 1, part.mesh);
    parts.push_back(std::move(part));
  }
  return parts;
}

// Returns the arc from one sample to the next, which begins along its tangent.
Arc arc_between_samples(const Pose& from, const Pose& to) {
  const Eigen::Vector3d way = from.inverse() * to.position;
  const double across = way.head<2>().norm(), half = std::atan2(across, way.z());
  Arc arc;
  arc.X_WS = from;
  arc.length = way.norm() / sinc(half);
  if (across > 0) arc.bend = way.head<2>() * (2 * half / across);
  // What is left of the rotation is about the tangent.
  arc.twist = so3_log(arc.carried(arc.length).rotation.transpose() * to.rotation).z();
  return arc;
}

// Returns the pose at s on the arcs through these samples.
Pose pose_among(const std::vector<ArmSample>& samples, double s) {
  const auto after = std::ranges::upper_bound(samples, s, {}, &ArmSample::s);
  if (after == samples.begin()) return samples.front().X_WS;
  if (after == samples.end()) return samples.back().X_WS;
  const ArmSample& before = *(after - 1);
  const Arc arc = arc_between_samples(before.X_WS, after->X_WS);
  return arc.pose(arc.length * (s - before.s) / (after->s - before.s));
}

// The joints' poses in the world over a run.
class ArmMotion {
 public:
  ArmMotion(const Recording& recording, const std::vector<Joint>& joints)
      : recording_(recording), joints_(joints), model_(recording.rig()->experiment.arm_model()) {}

  std::vector<Pose> at(double time) {
    if (recording_.has_truth()) {
      if (const auto truth = recording_.truth(time)) {
        const double stretch = truth->back().s / joints_.back().s_rest;
        last_.clear();
        for (const Joint& joint : joints_) last_.push_back(pose_among(*truth, joint.s_rest * stretch));
      }
      if (!last_.empty()) return last_;
    }
    const Backbone backbone = model_.backbone(state_at(time));
    std::vector<Pose> poses;
    poses.reserve(joints_.size());
    for (const Joint& joint : joints_) poses.push_back(backbone.pose(backbone.s_at_rest(joint.s_rest)));
    return poses;
  }

 private:
  // Interpolates between logged states: a run may log few.
  [[nodiscard]] ArmState state_at(double time) const {
    const std::size_t place = recording_.state_at(time);
    ArmState state = recording_.state(place);
    if (place + 1 == recording_.states()) return state;
    const double begun = recording_.time_of_state(place), end = recording_.time_of_state(place + 1);
    if (end <= begun) return state;
    const double part = std::clamp((time - begun) / (end - begun), 0.0, 1.0);
    const ArmState next = recording_.state(place + 1);
    for (std::size_t i = 0; i < state.bends.size(); ++i) {
      state.bends[i] += part * (next.bends[i] - state.bends[i]);
      state.stretches[i] += part * (next.stretches[i] - state.stretches[i]);
    }
    return state;
  }

  const Recording& recording_;
  const std::vector<Joint>& joints_;
  ArmModel model_;
  std::vector<Pose> last_;  // Of the true arm.
};

// Each pose in the axes of the one before.
std::vector<Pose> in_chain(const std::vector<Pose>& poses) {
  std::vector<Pose> chain{poses.front()};
  for (std::size_t i = 1; i < poses.size(); ++i) chain.push_back(poses[i - 1].inverse() * poses[i]);
  return chain;
}

std::vector<double> times_of(double duration) {
  const auto wanted = static_cast<std::size_t>(std::min(std::ceil(duration * pose_rate), 1e9));
  const std::size_t steps = std::min(wanted, most_poses - 1);
  std::vector<double> times;
  for (std::size_t i = 0; i <= steps; ++i)
    times.push_back(steps == 0 ? 0 : duration * static_cast<double>(i) / static_cast<double>(steps));
  return times;
}

// The format's cameras look along -z, with y upwards.
Pose camera_node_pose(const Pose& X_WC) {
  return {X_WC.rotation * Eigen::Vector3d(1, -1, -1).asDiagonal(), X_WC.position};
}

void add_obstacles(const std::vector<ObstacleConfig>& obstacles, double reach, GltfDocument& document) {
  if (obstacles.empty()) return;
  constexpr double opacity = 0.4;  // As in a report.
  const std::size_t material = document.add_material("obstacle", report_obstacle_color, opacity, true);
  const auto along = [](const Eigen::Vector3d& p, const Eigen::Vector3d& z) {
    return Pose{rotation_from_z(z), p};
  };
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    GltfMesh mesh;
    Pose pose;
    std::string name;
    std::visit(
        [&]<class Shape>(const Shape& shape) {
          name = shape.name.empty() ? fmt::format("obstacle {}", i + 1) : shape.name;
          if constexpr (std::is_same_v<Shape, PlaneConfig>) {
            mesh = square_mesh(reach);
            pose = along(vector(shape.point), vector(shape.normal).normalized());
          } else if constexpr (std::is_same_v<Shape, SphereConfig>) {
            mesh = ball_mesh(shape.radius);
            pose.position = vector(shape.center);
          } else if constexpr (std::is_same_v<Shape, CapsuleConfig>) {
            const Eigen::Vector3d from = vector(shape.from), to = vector(shape.to);
            mesh = capsule_mesh(shape.radius, (to - from).norm());
            pose.position = (from + to) / 2;
            if (from != to) pose = along(pose.position, (to - from).normalized());
          } else {
            mesh = box_mesh(vector(shape.half_sizes));
            pose = {rotation_of(shape.rotation), vector(shape.center)};
          }
        },
        obstacles[i]);
    const GltfPart part{std::move(mesh), material};
    (void)document.add_node(name, pose, content("mesh", document.add_mesh(name, std::span(&part, 1))));
  }
}

// Adds the cameras; returns the tracks of those that move.
std::vector<GltfDocument::Track> add_cameras(const Recording& recording, const std::vector<double>& times,
                                             double reach, GltfDocument& document) {
  std::vector<GltfDocument::Track> tracks;
  const std::vector<Camera>& cameras = recording.rig()->cameras;
  if (cameras.empty()) return tracks;
  const std::size_t material = document.add_material("camera", rgb(0x3d4955));
  const double size = 0.03 * reach;
  // The body is behind the pupil, so that it does not hide what the camera sees.
  const GltfPart body{box_mesh({size, 0.75 * size, 1.25 * size}), material};
  const std::size_t mesh = document.add_mesh("camera body", std::span(&body, 1));
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const CameraConfig& config = cameras[i].config();
    const auto width = static_cast<double>(config.sensor.width),
               height = static_cast<double>(config.sensor.height);
    const CameraStance first = recording.stance(i, 0);
    const Intrinsics lens = cameras[i].lens().at(first.head.zoom);
    const std::size_t camera = document.add_camera(config.name, 2 * std::atan(height / (2 * lens.fy)),
                                                   width * lens.fy / (height * lens.fx));
    const std::size_t node = document.add_node(
        "camera " + config.name, camera_node_pose(cameras[i].pose(first)), content("camera", camera));
    document.set_parent(
        document.add_node("body of camera " + config.name, {Eigen::Matrix3d::Identity(), {0, 0, 1.3 * size}},
                          content("mesh", mesh)),
        node);
    GltfDocument::Track track{node, {}};
    bool moves = false;
    for (const double time : times) {
      const CameraStance stance = recording.stance(i, time);
      moves = moves || stance.head.pan != first.head.pan || stance.head.tilt != first.head.tilt ||
              stance.stage != first.stage;
      track.poses.push_back(camera_node_pose(cameras[i].pose(stance)));
    }
    if (moves) tracks.push_back(std::move(track));
  }
  return tracks;
}

std::string motion_file(const Recording& recording, Progress* progress) {
  const Experiment& experiment = recording.rig()->experiment;
  const Arm arm = experiment.arm_model().driven();
  const double reach = arm.length();
  GltfDocument document;
  for (std::size_t i = 0; i < std::min(arm.sections.size(), section_colors.size()); ++i)
    (void)document.add_material(fmt::format("section {}", i + 1), section_colors[i]);

  const std::vector<Joint> joints = joints_of(arm);
  const std::vector<double> times = times_of(recording.duration());
  ArmMotion motion(recording, joints);
  std::vector<GltfDocument::Track> tracks(joints.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (progress != nullptr)
      progress->update(static_cast<double>(i) / static_cast<double>(times.size()), "poses");
    const std::vector<Pose> chain = in_chain(motion.at(times[i]));
    for (std::size_t j = 0; j < joints.size(); ++j) tracks[j].poses.push_back(chain[j]);
  }
  std::vector<std::size_t> nodes;
  std::vector<Pose> rest;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    nodes.push_back(document.add_node(fmt::format("joint {}", j + 1), tracks[j].poses.front()));
    if (j > 0) document.set_parent(nodes[j], nodes[j - 1]);
    tracks[j].node = nodes[j];
    rest.push_back(joints[j].rest);
  }
  const std::size_t mesh = document.add_mesh("arm", tube_parts(arm, experiment.arm.look.tip, joints, 0));
  Node::Table skinned = content("mesh", mesh);
  skinned.push_back(content("skin", document.add_skin(nodes, rest)).front());
  (void)document.add_node("arm", {}, skinned);
  add_obstacles(experiment.obstacle, reach, document);
  auto camera_tracks = add_cameras(recording, times, reach, document);
  std::ranges::move(camera_tracks, std::back_inserter(tracks));
  if (times.size() > 1) document.add_animation("run", times, tracks);
  return document.glb("flexura " + std::string(version()));
}

}  // namespace

const std::array<std::array<double, 3>, 8> section_colors = {rgb(0x1f5279), rgb(0xf0134a), rgb(0x019c8c),
                                                             rgb(0xbd70e0), rgb(0x7a7500), rgb(0x5463d2),
                                                             rgb(0x3b1988), rgb(0x990a0a)};
const std::array<double, 3> report_obstacle_color = rgb(0xb08d57);

GltfExport export_gltf(const std::filesystem::path& results, const std::filesystem::path& file,
                       Progress* progress) {
  const Recording recording(results);
  const std::string bytes = motion_file(recording, progress);
  GltfExport written{file, recording.notes()};
  if (file.empty()) written.file = make_new_folder(results / "gltf") / "arm.glb";
  write_new_file(written.file, bytes);
  return written;
}

}  // namespace flexura
