#include "flexura/view/pixel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>

#include "flexura/base/node.h"
#include "flexura/render/truth.h"

namespace flexura {
namespace {

Node optional_number(const std::optional<double>& value) { return value ? Node{*value, {}} : Node{}; }

}  // namespace

PixelProbe::PixelProbe(ViewedRigPtr rig)
    : rig_(std::move(rig)),
      maker_(rig_->truth.driven(), rig_->experiment.true_rig().arm.look, rig_->experiment.true_stand(),
             rig_->experiment.obstacle) {}

SeenPixel PixelProbe::look(const Shot& shot, int u, int v) {
  const double time = times_of_frame_at(*shot.sensor, shot.start).middle;
  const Backbone backbone = shot.backbone(time);
  const Scene scene = maker_.scene(backbone);
  renderer_.prepare(scene, shot.view(time));
  const PixelTruth truth = pixel_truth(renderer_, u, v);
  SeenPixel seen{label(truth.label), {}, {}};
  if (std::isfinite(truth.depth)) seen.depth = truth.depth;
  if (std::isfinite(truth.s)) seen.s = backbone.s_rest_at(truth.s);
  return seen;
}

// Things are counted from 1, as people count them.
std::string PixelProbe::label(const SurfaceLabel& label) const {
  const int number = label.index + 1;
  switch (label.kind) {
    case SurfaceKind::background:
      return "background";
    case SurfaceKind::section:
      return fmt::format("section {}", number);
    case SurfaceKind::cap:
      return label.index == 0 ? "base" : "tip";
    case SurfaceKind::marker:
      return fmt::format("marker {}", number);
    case SurfaceKind::disk:
      return fmt::format("disk {}", number);
    case SurfaceKind::screen:
      return fmt::format("screen {}", number);
    case SurfaceKind::etalon:
      return "etalon";
    case SurfaceKind::etalon_line:
      return fmt::format("etalon line {}", number);
    case SurfaceKind::obstacle:
      break;
  }
  return label.index < rig_->obstacles.size() ? rig_->obstacles[label.index].name : "obstacle";
}

Node pixel_node(const Picture& picture, std::int64_t bits, int u, int v, std::int64_t number,
                const std::optional<SeenPixel>& seen) {
  Node::Array value;
  std::visit(
      [&](const auto& image) {
        if (u < 0 || v < 0 || u >= image.width() || v >= image.height())
          throw std::out_of_range(fmt::format("({}, {}) is outside the image: expected less than {} x {}", u,
                                              v, image.width(), image.height()));
        for (int channel = 0; channel < image.channels(); ++channel)
          value.push_back({static_cast<std::int64_t>(image.at(u, v, channel)), {}});
      },
      picture);
  return {Node::Table{{"value", {}, {std::move(value), {}}},
                      {"bits", {}, {bits, {}}},
                      {"label", {}, {seen ? seen->label : std::string(), {}}},
                      {"depth", {}, optional_number(seen ? seen->depth : std::nullopt)},
                      {"s", {}, optional_number(seen ? seen->s : std::nullopt)},
                      {"number", {}, {number, {}}}},
          {}};
}

}  // namespace flexura
