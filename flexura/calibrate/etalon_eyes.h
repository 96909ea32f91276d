#pragma once

#include <memory>
#include <vector>

#include "flexura/calibrate/etalon_figure.h"
#include "flexura/calibrate/etalon_view.h"
#include "flexura/calibrate/rig_eyes.h"

namespace flexura {

/// Points of the cylinder that a sighting tells: two of each side and of each red line that can be told from
/// the others, and one of each rim. By a view that is known within 40 degrees around the cylinder, upright or
/// upside down.
[[nodiscard]] std::vector<EtalonPoint> etalon_points(const EtalonSighting& seen, const EtalonFigure& etalon,
                                                     const View& view);

/// The same for the log and for eyes: a marker for each point of a red line (its place: how high up), and of
/// the silhouette its four corners as points.
[[nodiscard]] SeenArm drawn_etalon(const EtalonSighting& seen, const EtalonConfig& etalon, const View& view);

/// The eyes of a session before the calibration cylinder, which its configuration has. What they say of a
/// picture is as drawn_etalon has it. All outlive them.
[[nodiscard]] std::unique_ptr<RigEyes> etalon_eyes(const RigModel& believed, const RigPrior& prior,
                                                   const RigSessionConfig& config);

}  // namespace flexura
