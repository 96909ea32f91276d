#pragma once

#include <memory>
#include <vector>

#include "flexura/calibrate/etalon_figure.h"
#include "flexura/calibrate/etalon_view.h"
#include "flexura/calibrate/rig_observer.h"

namespace flexura {

/// Returns the cylinder points of an observation: two of each side and of each identifiable red line, and one
/// of each rim. The bearing of `view` around the cylinder must be known within 40 degrees, upright or upside
/// down.
[[nodiscard]] std::vector<EtalonPoint> etalon_points(const EtalonObservation& seen,
                                                     const EtalonFigure& etalon, const View& view);

/// Returns the observation in the form of a SeenArm, for the log and for sessions. Each point of a red line
/// becomes a marker, placed by its height; the four corners of the silhouette become points.
[[nodiscard]] SeenArm drawn_etalon(const EtalonObservation& seen, const EtalonConfig& etalon,
                                   const View& view);

/// Returns the observer of a session in front of the configured calibration cylinder. It reports pictures as
/// drawn_etalon does. All arguments must outlive it.
[[nodiscard]] std::unique_ptr<RigObserver> etalon_observer(const RigModel& nominal, const RigPrior& prior,
                                                           const RigSessionConfig& config);

}  // namespace flexura
