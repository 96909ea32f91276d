#include "flexura/port/camera_moves.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace flexura {

std::string missing_head(const CameraPorts& ports) {
  if (ports.head != nullptr) return "";
  return fmt::format("camera {} has no head: it cannot pan, tilt or zoom", ports.name);
}

std::string missing_stage(const CameraPorts& ports, const Camera& optics) {
  const bool travels = std::ranges::any_of(
      optics.stage_axes(), [](const AxisConfig& axis) { return axis.limits[0] < axis.limits[1]; });
  if (ports.stage != nullptr || !travels) return "";
  return fmt::format("camera {} has no stage: it cannot be translated, but its mount.stage has travel",
                     ports.name);
}

CommandOutcome command_head(const CameraPorts& ports, const Camera& optics, const HeadState& state) {
  if (ports.head != nullptr) return ports.head->command(state);
  if (state == optics.initial_head()) return Accepted{};
  return PortFault{FaultKind::refused, missing_head(ports)};
}

CommandOutcome command_stage(const CameraPorts& ports, const Camera& optics, const StageState& state) {
  if (ports.stage != nullptr) return ports.stage->command(state);
  if (state == optics.initial_stage()) return Accepted{};
  return PortFault{FaultKind::refused,
                   fmt::format("camera {} has no stage: it cannot be translated", ports.name)};
}

CommandOutcome halt_camera(const CameraPorts& ports) {
  CommandOutcome head = Accepted{}, stage = Accepted{};
  if (ports.head != nullptr) head = ports.head->halt();
  if (ports.stage != nullptr) stage = ports.stage->halt();
  return head ? stage : head;
}

Outcome<CameraStance> measured_stance(const CameraPorts& ports, const Camera& optics) {
  CameraStance stance = optics.initial_stance();
  if (ports.head != nullptr) {
    const auto head = ports.head->read();
    if (const auto fault = head.fault()) return *fault;
    stance.head = head.value().state;
  }
  if (ports.stage != nullptr) {
    const auto stage = ports.stage->read();
    if (const auto fault = stage.fault()) return *fault;
    stance.stage = stage.value().state;
  }
  return stance;
}

}  // namespace flexura
