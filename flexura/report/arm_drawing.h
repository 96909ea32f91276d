#pragma once

#include <string>
#include <string_view>

#include "flexura/report/motion.h"
#include "flexura/report/scene.h"
#include "flexura/report/svg.h"

namespace flexura {

/// The arm at state i with its end effector's coordinates, as in the paper's Figs. 6 to 8. `when` names the
/// state: "start", "middle", "end".
[[nodiscard]] Drawing arm_picture(const ReportMotion& motion, const PlotScene& scene, std::size_t i,
                                  std::string_view when);

/// Two shapes of one arm at once, among obstacles: as it is, and the other one behind it as a line, "ghost".
[[nodiscard]] Drawing two_shapes_picture(const Arm& arm, const std::vector<ObstacleConfig>& obstacles,
                                         const Backbone& shape, const Backbone& ghost,
                                         std::string_view heading);

/// What is wrong at a moment: "0 s to 2 s: section 1: bend 62 deg, limit 60 deg; ...", at most four of it.
[[nodiscard]] std::string moment_text(const ReportMotion& motion, const UnsafeMoment& moment);

/// The arm at the worst moment of violations.
[[nodiscard]] Drawing unsafe_picture(const ReportMotion& motion, const PlotScene& scene,
                                     const UnsafeMoment& moment);

/// The tip's way from start to end.
[[nodiscard]] Drawing tip_path_picture(const ReportMotion& motion);

/// What the player draws into: axes, start and end as ghosts, the tip's path, and for each view an empty
/// group with the class "view" that says how to come from metres to the page: x = data-x + data-scale X, y =
/// data-y - data-scale Y.
[[nodiscard]] Drawing player_picture(const ReportMotion& motion, const PlotScene& scene);

}  // namespace flexura
