#include "flexura/rig/truth_files.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "flexura/base/node.h"
#include "flexura/camera/mount.h"
#include "flexura/log/messages.h"
#include "flexura/picture/image_file.h"
#include "flexura/render/renderer.h"
#include "flexura/render/silhouette.h"
#include "flexura/render/truth.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"

namespace flexura {
namespace {

Node numbers(std::span<const double> values) {
  Node::Array entries;
  for (const double value : values) entries.push_back(number_node(value));
  return {std::move(entries), {}};
}

// Null if the lens does not show the point.
Node pixel_node(const std::optional<Eigen::Vector2d>& pixel) {
  return pixel ? numbers(std::span(pixel->data(), 2)) : Node{};
}

Node camera_node(const View& view) {
  const Intrinsics& lens = view.lens.intrinsics();
  const std::optional<double> roll = roll_of(view.X_WC.rotation);
  return {Node::Table{{"width", {}, {std::int64_t{view.width}, {}}},
                      {"height", {}, {std::int64_t{view.height}, {}}},
                      {"fx", {}, {lens.fx, {}}},
                      {"fy", {}, {lens.fy, {}}},
                      {"cx", {}, {lens.cx, {}}},
                      {"cy", {}, {lens.cy, {}}},
                      {"model", {}, {flexura::name_of(lens.distortion.model()), {}}},
                      {"distortion", {}, numbers(lens.distortion)},
                      {"pose", {}, pose_node(view.X_WC)},
                      {"roll", {}, roll ? number_node(*roll) : Node{}}},
          {}};
}

std::string_view name_of(SurfaceKind kind) {
  constexpr std::array<std::string_view, 9> names = {
      "background", "section", "cap", "marker", "disk", "screen", "etalon", "etalon_line", "obstacle"};
  return names[static_cast<std::size_t>(kind)];
}

Node labels_node(const Image<std::uint16_t>& labels) {
  const std::set<std::uint16_t> values(labels.values().begin(), labels.values().end());
  Node::Array list;
  for (const std::uint16_t value : values) {
    const SurfaceLabel label = label_from_value(value);
    list.push_back({Node::Table{{"value", {}, {std::int64_t{value}, {}}},
                                {"kind", {}, {std::string(name_of(label.kind)), {}}},
                                {"index", {}, {std::int64_t{label.index}, {}}}},
                    {}});
  }
  return {std::move(list), {}};
}

Node::Table axis_members(const AxisPoint& point) {
  return {{"s", {}, {point.s, {}}},
          {"pixel", {}, pixel_node(point.pixel)},
          {"depth", {}, number_node(point.depth)},
          {"visible", {}, {point.is_visible, {}}}};
}

Node axis_node(const Renderer& renderer, const std::vector<Arc>& tube) {
  constexpr int pieces = 200;
  std::vector<double> places;
  if (!tube.empty()) {
    const double length = tube.back().s + tube.back().length;
    for (int i = 0; i <= pieces; ++i) places.push_back(length * i / pieces);
  }
  Node::Array list;
  for (const AxisPoint& point : projected_axis(renderer, places)) list.push_back({axis_members(point), {}});
  return {std::move(list), {}};
}

Node outlines_node(const Renderer& renderer) {
  Node::Array list;
  for (const Outline& outline : outlines(renderer)) {
    Node::Array points;
    for (const OutlinePoint& point : outline.points) {
      points.push_back({Node::Table{{"s", {}, {point.s, {}}},
                                    {"pixel", {}, pixel_node(point.pixel)},
                                    {"visible", {}, {point.is_visible, {}}}},
                        {}});
    }
    const bool is_contour = outline.kind == OutlineKind::contour;
    list.push_back({Node::Table{{"kind", {}, {std::string(is_contour ? "contour" : "rim"), {}}},
                                {"points", {}, {std::move(points), {}}}},
                    {}});
  }
  return {std::move(list), {}};
}

Node markers_node(const Renderer& renderer) {
  Node::Array list;
  for (const MarkerView& marker : marker_views(renderer)) {
    Node::Table members = axis_members(marker.center);
    members.push_back({"area", {}, {marker.area, {}}});
    const bool is_seen = marker.area > 0;
    members.push_back({"centroid", {}, is_seen ? numbers(std::span(marker.centroid.data(), 2)) : Node{}});
    list.push_back({std::move(members), {}});
  }
  return {std::move(list), {}};
}

}  // namespace

std::vector<std::filesystem::path> write_truth(const ShownScene& shown, const std::optional<ShownScene>& next,
                                               const std::filesystem::path& image) {
  Renderer renderer;
  renderer.prepare(shown.scene, shown.view);
  TruthMaps maps;
  truth_maps(renderer, maps);
  std::vector<std::filesystem::path> files;
  const auto write = [&](const char* ending, std::string_view bytes) {
    std::filesystem::path file = image;
    file.replace_filename(image.stem().string() + ending);
    replace_file(file, bytes);
    files.push_back(std::move(file));
  };
  write("_depth.tiff", tiff(maps.depth));
  write("_s.tiff", tiff(maps.s));
  write("_labels.png", png(maps.label));
  if (next) {
    write("_flow.tiff", tiff(optical_flow(renderer, next->scene, next->view)));
  } else {
    // Removes the flow of another instant, which would remain beside these files.
    std::filesystem::path file = image;
    std::filesystem::remove(file.replace_filename(image.stem().string() + "_flow.tiff"));
  }
  const Node truth{Node::Table{{"camera", {}, camera_node(shown.view)},
                               {"labels", {}, labels_node(maps.label)},
                               {"axis", {}, axis_node(renderer, shown.scene.arm.tube)},
                               {"outlines", {}, outlines_node(renderer)},
                               {"markers", {}, markers_node(renderer)}},
                   {}};
  write("_truth.json", write_json(truth, 1) + "\n");
  return files;
}

}  // namespace flexura
