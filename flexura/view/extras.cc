#include "flexura/view/extras.h"

#include <Eigen/Core>
#include <cmath>

#include "flexura/base/node.h"
#include "flexura/store/json.h"
#include "flexura/view/describe.h"

namespace flexura {
namespace {

Node ghost_node(const GhostArm& ghost) {
  Node::Array poses;
  for (const ArmSample& sample : ghost.samples) poses.push_back(flat_pose_node(sample.X_WS));
  return {Node::Table{{"id", {}, text_node(ghost.id)},
                      {"label", {}, text_node(ghost.label)},
                      {"color", {}, text_node(ghost.color)},
                      {"poses", {}, {std::move(poses), {}}}},
          {}};
}

Node overlay_node(const PictureLayers& overlay) {
  Node::Table table{{"camera", {}, text_node(overlay.camera)}};
  if (overlay.number) table.push_back({"number", {}, {*overlay.number, {}}});
  if (!overlay.reason.empty()) table.push_back({"reason", {}, text_node(overlay.reason)});
  table.push_back({"layers", {}, {overlay.layers, {}}});
  return {std::move(table), {}};
}

Node along_node(const Extras& extras) {
  Node::Array curves;
  for (const AlongCurve& curve : extras.along) {
    Node::Array values;
    for (const double value : curve.values) values.push_back(number_node(value));
    curves.push_back({Node::Table{{"id", {}, text_node(curve.id)},
                                  {"label", {}, text_node(curve.label)},
                                  {"color", {}, text_node(curve.color)},
                                  {"values", {}, {std::move(values), {}}}},
                      {}});
  }
  return {Node::Table{{"label", {}, text_node(extras.along_label)},
                      {"unit", {}, text_node(extras.along_unit)},
                      {"length", {}, {extras.length, {}}},
                      {"curves", {}, {std::move(curves), {}}}},
          {}};
}

// Returns [[u, v], ...].
Node pixels_node(const std::vector<Eigen::Vector2d>& pixels) {
  const auto shown = [](double pixel) { return Node{std::round(100 * pixel) / 100, {}}; };
  Node::Array list;
  for (const Eigen::Vector2d& pixel : pixels)
    list.push_back({Node::Array{shown(pixel.x()), shown(pixel.y())}, {}});
  return {std::move(list), {}};
}

Node::Table marked(const LayerMark& mark, const char* kind) {
  Node::Table table{{"id", {}, text_node(mark.id)},
                    {"label", {}, text_node(mark.label)},
                    {"kind", {}, text_node(kind)},
                    {"color", {}, text_node(mark.color)}};
  if (!mark.of.empty()) table.push_back({"of", {}, text_node(mark.of)});
  return table;
}

}  // namespace

Node line_layer(const std::string& id, const std::string& color, const std::vector<Eigen::Vector2d>& points,
                bool is_dashed) {
  return {Node::Table{{"id", {}, text_node(id)},
                      {"kind", {}, text_node("polyline")},
                      {"color", {}, text_node(color)},
                      {"points", {}, pixels_node(points)},
                      {"closed", {}, {false, {}}},
                      {"dashed", {}, {is_dashed, {}}}},
          {}};
}

Node points_layer(const LayerMark& mark, const std::vector<Eigen::Vector2d>& points) {
  Node::Table table = marked(mark, "points");
  table.push_back({"points", {}, pixels_node(points)});
  return {std::move(table), {}};
}

Node lines_layer(const LayerMark& mark, const std::vector<std::vector<Eigen::Vector2d>>& lines,
                 bool is_dashed) {
  Node::Table table = marked(mark, "lines");
  Node::Array list;
  for (const auto& line : lines) list.push_back(pixels_node(line));
  table.push_back({"lines", {}, {std::move(list), {}}});
  table.push_back({"dashed", {}, {is_dashed, {}}});
  return {std::move(table), {}};
}

std::string extras_message(const Extras& extras) {
  constexpr char kind = 3;
  Node::Array ghosts, overlays;
  for (const GhostArm& ghost : extras.ghosts) ghosts.push_back(ghost_node(ghost));
  for (const PictureLayers& overlay : extras.overlays) overlays.push_back(overlay_node(overlay));
  Node::Table values;
  for (const auto& [name, value] : extras.values) values.push_back({name, {}, number_node(value)});
  Node::Table table{{"time", {}, {extras.time, {}}},
                    {"title", {}, text_node(extras.title)},
                    {"text", {}, text_node(extras.text)},
                    {"ghosts", {}, {std::move(ghosts), {}}},
                    {"overlays", {}, {std::move(overlays), {}}}};
  if (!extras.along.empty()) table.push_back({"along", {}, along_node(extras)});
  table.push_back({"values", {}, {std::move(values), {}}});
  return kind + write_json({std::move(table), {}});
}

}  // namespace flexura
