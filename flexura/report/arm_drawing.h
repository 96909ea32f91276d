#pragma once

#include <string>
#include <string_view>

#include "flexura/report/motion.h"
#include "flexura/report/scene.h"
#include "flexura/report/svg.h"

namespace flexura {

/// Returns a drawing of the arm in state i with its end effector's coordinates, as in the paper's Figs. 6 to
/// 8. `when` names the state: "start", "middle", "end".
[[nodiscard]] Drawing arm_picture(const ReportMotion& motion, const PlotScene& scene, std::size_t i,
                                  std::string_view when);

/// Returns a drawing of two shapes of one arm among obstacles. `shape` is drawn as the arm, and `ghost` as a
/// line behind the arm.
[[nodiscard]] Drawing two_shapes_picture(const Arm& arm, const std::vector<ObstacleConfig>& obstacles,
                                         const Backbone& shape, const Backbone& ghost,
                                         std::string_view heading);

/// Returns the violations at a moment as text, at most four: "0 s to 2 s: section 1: bend 62 deg, limit 60
/// deg; ...".
[[nodiscard]] std::string moment_text(const ReportMotion& motion, const UnsafeMoment& moment);

/// Returns a drawing of the arm at the worst moment of violations.
[[nodiscard]] Drawing unsafe_picture(const ReportMotion& motion, const PlotScene& scene,
                                     const UnsafeMoment& moment);

/// Returns a drawing of the tip's path from start to end.
[[nodiscard]] Drawing tip_path_picture(const ReportMotion& motion);

/// Returns the drawing for the page's player: axes, the first and last shape as lines, the tip's path, and an
/// empty group for each view. Each group has the class "view". The attributes of this group convert metres to
/// page units: x = data-x + data-scale X, y = data-y - data-scale Y.
[[nodiscard]] Drawing player_picture(const ReportMotion& motion, const PlotScene& scene);

}  // namespace flexura
