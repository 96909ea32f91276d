#include "flexura/view/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "flexura/base/table.h"
#include "flexura/log/messages.h"
#include "flexura/model/obstacle.h"
#include "flexura/render/scene_maker.h"
#include "flexura/rig/seeing_config.h"

namespace flexura {
namespace {

template <class Values>
Node numbers(const Values& values) {
  Node::Array list;
  for (const double value : values) list.push_back(number_node(value));
  return {std::move(list), {}};
}

Node section_nodes(const Arm& arm) {
  Node::Array list;
  for (const Section& section : arm.sections) {
    list.push_back({Node::Table{{"length", {}, {section.length, {}}},
                                {"radius", {}, numbers(section.radius)},
                                {"max_bend", {}, number_node(section.max_bend)},
                                {"stretch", {}, numbers(section.stretch_limits)}},
                    {}});
  }
  return {std::move(list), {}};
}

Node marker_nodes(const LookConfig& look, const Arm& arm) {
  Node::Array list;
  for (const Marker& marker : look.markers(arm)) {
    list.push_back({Node::Table{{"from", {}, {marker.at - marker.width / 2, {}}},
                                {"to", {}, {marker.at + marker.width / 2, {}}},
                                {"color", {}, numbers(marker.color)}},
                    {}});
  }
  return {std::move(list), {}};
}

Node disk_nodes(const LookConfig& look) {
  Node::Array list;
  for (const Disk& disk : look.disk) {
    list.push_back({Node::Table{{"at", {}, {disk.at, {}}},
                                {"radius", {}, {disk.radius, {}}},
                                {"thickness", {}, {disk.thickness, {}}}},
                    {}});
  }
  return {std::move(list), {}};
}

Node route_nodes(const ViewedRig& rig) {
  Node::Array list;
  for (const PulledTendon& tendon : rig.actuators) {
    Node::Array route;
    for (const auto& point : tendon.route) route.push_back(numbers(point));
    list.push_back({std::move(route), {}});
  }
  return {std::move(list), {}};
}

Node arm_node(const ViewedRig& rig, bool is_visible) {
  const LookConfig look = rig.experiment.true_rig().arm.look;
  return {Node::Table{{"kind", {}, Codec<ArmKind>::write(rig.truth.driven().kind)},
                      {"sections", {}, section_nodes(rig.truth.driven())},
                      {"color", {}, numbers(look.color)},
                      {"tip", {}, Codec<TipKind>::write(look.tip)},
                      {"markers", {}, marker_nodes(look, rig.truth.driven())},
                      {"disks", {}, disk_nodes(look)},
                      {"disk_color", {}, numbers(look.disk_color)},
                      {"base", {}, flat_pose_node(rig.truth.driven().X_WB)},
                      {"tendons", {}, route_nodes(rig)},
                      {"elastic", {}, {rig.is_rod, {}}},
                      {"visible", {}, {is_visible, {}}}},
          {}};
}

Node screen_nodes(const Scene& stand) {
  Node::Array list;
  for (const Screen& screen : stand.screens) {
    list.push_back({Node::Table{{"pose", {}, flat_pose_node(screen.X_WS)},
                                {"size", {}, numbers(screen.size)},
                                {"brightness", {}, {gray_of(screen.brightness), {}}}},
                    {}});
  }
  return {std::move(list), {}};
}

Node etalon_node(const Scene& stand) {
  if (!stand.etalon) return {};
  const Etalon& etalon = *stand.etalon;
  return {Node::Table{{"pose", {}, flat_pose_node(etalon.X_WE)},
                      {"radius", {}, {etalon.radius, {}}},
                      {"height", {}, {etalon.height, {}}},
                      {"line_width", {}, {etalon.line_width, {}}},
                      {"color", {}, numbers(etalon.albedo)},
                      {"line_color", {}, numbers(etalon.line_albedo)}},
          {}};
}

// Returns the obstacles as in the experiment's file, each with the name used in messages.
Node obstacle_nodes(const ViewedRig& rig) {
  Node::Array list;
  for (std::size_t i = 0; i < rig.obstacles.size(); ++i) {
    ObstacleConfig config = rig.experiment.obstacle[i];
    std::visit([&](auto& obstacle) { obstacle.name = rig.obstacles[i].name; }, config);
    list.push_back(Codec<ObstacleConfig>::write(config));
  }
  return {std::move(list), {}};
}

// Returns region and colour of a camera's [[seeing]].
Node seeing_node(const SeeingConfig& seeing) {
  Node::Table table;
  if (!seeing.region.empty()) {
    Node::Array corners;
    for (const auto& corner : seeing.region) corners.push_back(numbers(corner));
    table.push_back({"region", {}, {std::move(corners), {}}});
  }
  if (seeing.color) table.push_back({"color", {}, numbers(*seeing.color)});
  if (!seeing.background.empty()) table.push_back({"background", {}, {true, {}}});
  return {std::move(table), {}};
}

Node camera_nodes(const ViewedRig& rig) {
  Node::Array list;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const SensorConfig& sensor = rig.sensors[i];
    const std::string& name = rig.cameras[i].config().name;
    Node::Table camera{{"name", {}, text_node(name)},
                       {"width", {}, {sensor.width, {}}},
                       {"height", {}, {sensor.height, {}}},
                       {"channels", {}, {std::int64_t{sensor.channels()}, {}}}};
    const auto seeing = std::ranges::find(rig.experiment.seeing, name, &SeeingConfig::camera);
    if (seeing != rig.experiment.seeing.end()) camera.push_back({"seeing", {}, seeing_node(*seeing)});
    list.push_back({std::move(camera), {}});
  }
  return {std::move(list), {}};
}

std::array<double, 2> tendon_range(const Arm& arm, const Tendon& tendon) {
  constexpr double a_turn = 2 * std::numbers::pi;
  std::array<double, 2> range{};
  for (std::size_t i = 0; i <= tendon.section; ++i) {
    const Section& section = arm.sections[i];
    // For a planar arm only the offset within the plane counts.
    const double offset =
        arm.kind == ArmKind::planar ? std::abs(tendon.offset().x()) : tendon.offset().norm();
    const double bend = offset * std::min(section.max_bend, a_turn);
    range[0] += -bend - section.length * (section.stretch_limits[1] - 1);
    range[1] += bend - section.length * (section.stretch_limits[0] - 1);
  }
  return range;
}

Node tendon_nodes(const ViewedRig& rig) {
  if (!rig.drive) return {};
  Node::Array list;
  for (const Tendon& tendon : rig.drive->tendons) {
    list.push_back({Node::Table{{"section", {}, {static_cast<std::int64_t>(tendon.section), {}}},
                                {"displacement", {}, numbers(tendon_range(rig.model.driven(), tendon))},
                                {"radius", {}, {tendon.radius, {}}},
                                {"angle", {}, {tendon.angle, {}}}},
                    {}});
  }
  return {std::move(list), {}};
}

Node actuator_nodes(const ViewedRig& rig) {
  Node::Array list;
  for (std::size_t i = 0; i < rig.actuators.size(); ++i) {
    const PulledTendon& tendon = rig.actuators[i];
    list.push_back({Node::Table{{"name", {}, text_node(fmt::format("Tendon {}", i + 1))},
                                {"section", {}, {static_cast<std::int64_t>(tendon.section), {}}},
                                {"range", {}, numbers(tendon.range)},
                                {"together", {}, numbers(tendon.together)},
                                {"motor", {}, {rig.drive.has_value(), {}}}},
                    {}});
  }
  return {std::move(list), {}};
}

// Returns the limits of a camera's three axes under their names.
Node axes_node(const Camera& camera, const std::array<AxisConfig, 3>& axes,
               const std::array<const char*, 3>& names) {
  Node::Table table{{"camera", {}, text_node(camera.config().name)}};
  for (std::size_t i = 0; i < names.size(); ++i) table.push_back({names[i], {}, numbers(axes[i].limits)});
  return {std::move(table), {}};
}

Node bend_nodes(const Arm& arm) {
  Node::Array list;
  for (const Section& section : arm.sections) {
    list.push_back({Node::Table{{"bend", {}, number_node(section.max_bend)},
                                {"stretch", {}, numbers(section.stretch_limits)},
                                {"bend_rate", {}, number_node(section.max_bend_rate)}},
                    {}});
  }
  return {std::move(list), {}};
}

Node task_nodes(const Experiment& experiment) {
  Node::Array list;
  for (const TaskConfig& task : experiment.task) {
    list.push_back({Node::Table{{"name", {}, text_node(task_name(task))},
                                {"kind", {}, text_node(std::string(task_kind(task)))}},
                    {}});
  }
  return {std::move(list), {}};
}

}  // namespace

const Table<Mark>& fields_of(const Mark*) {
  static const auto table = Table<Mark>("mark", "Marked time of a recording.")
                                .field("time", &Mark::time, {.meaning = "s"})
                                .field("end", &Mark::end, {.meaning = "s"})
                                .field("level", &Mark::level, {})
                                .field("name", &Mark::name, {})
                                .field("text", &Mark::text, {});
  return table;
}

const Table<Quantity>& fields_of(const Quantity*) {
  static const auto table = Table<Quantity>("quantity", "Quantity of a recording over time.")
                                .field("name", &Quantity::name, {})
                                .field("unit", &Quantity::unit, {})
                                .field("group", &Quantity::group, {});
  return table;
}

Node flat_pose_node(const Pose& X_WP) {
  const Eigen::Vector3d& p = X_WP.position;
  const Eigen::Vector4d q = quaternion_wxyz(X_WP.rotation);
  return numbers(std::array{p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3]});
}

Node scene_node(const ViewedRig& rig) {
  const StandConfig config = rig.experiment.true_stand();
  const SceneMaker maker(rig.truth.driven(), rig.experiment.true_rig().arm.look, config,
                         rig.experiment.obstacle);
  const Scene& stand = maker.stand();
  return {Node::Table{{"arm", {}, arm_node(rig, config.arm)},
                      {"screens", {}, screen_nodes(stand)},
                      {"etalon", {}, etalon_node(stand)},
                      {"obstacles", {}, obstacle_nodes(rig)},
                      {"cameras", {}, camera_nodes(rig)},
                      {"light",
                       {},
                       {Node::Table{{"towards", {}, numbers(stand.light.direction)},
                                    {"ambient", {}, {stand.light.ambient, {}}},
                                    {"directional", {}, {stand.light.directional, {}}}},
                        {}}},
                      {"background", {}, {gray_of(stand.background), {}}}},
          {}};
}

Node controls_node(const ViewedRig& rig) {
  Node::Array heads, stages;
  for (const Camera& camera : rig.cameras) {
    Node head = axes_node(camera, camera.head_axes(), {"pan", "tilt", "zoom"});
    const std::vector<ZoomRow>& rows = camera.config().lens.zoom;
    const bool has_counts = !rows.empty() && rows.front().count;
    std::get<Node::Table>(head.value).push_back({"zoom_unit", {}, text_node(has_counts ? "count" : "ratio")});
    heads.push_back(std::move(head));
    stages.push_back(axes_node(camera, camera.stage_axes(), {"x", "y", "z"}));
  }
  return {Node::Table{{"sections", {}, bend_nodes(rig.model.driven())},
                      {"tendons", {}, tendon_nodes(rig)},
                      {"heads", {}, {std::move(heads), {}}},
                      {"stages", {}, {std::move(stages), {}}},
                      {"tasks", {}, task_nodes(rig.experiment)}},
          {}};
}

Node live_controls_node(const ViewedRig& rig) {
  Node controls = controls_node(rig);
  auto& table = std::get<Node::Table>(controls.value);
  if (!rig.actuators.empty()) {
    std::ranges::find(table, "tendons", &Node::Member::key)->node = {};
    table.push_back({"actuators", {}, actuator_nodes(rig)});
  }
  table.push_back({"weight", {}, {rig.has_weight, {}}});
  table.push_back({"inertia", {}, {rig.has_inertia, {}}});
  table.push_back({"contact", {}, {rig.touches, {}}});
  if (rig.push)
    table.push_back({"push",
                     {},
                     {Node::Table{{"length", {}, {rig.push->length, {}}},
                                  {"stiffness", {}, {rig.push->stiffness, {}}},
                                  {"most", {}, {rig.push->most, {}}}},
                      {}}});
  return controls;
}

}  // namespace flexura
