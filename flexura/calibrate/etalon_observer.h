#pragma once

#include <memory>
#include <vector>

#include "flexura/calibrate/etalon_figure.h"
#include "flexura/calibrate/etalon_view.h"
#include "flexura/calibrate/rig_observer.h"

namespace flexura {

/// Returns the cylinder points of an observation: two on each side, two on each identifiable red line, and
/// one on each rim. The direction of `view` around the cylinder must be correct within 40 degrees. The camera
/// may be upright or upside down.
[[nodiscard]] std::vector<EtalonPoint> etalon_points(const EtalonObservation& seen,
                                                     const EtalonFigure& etalon, const View& view);

/// Returns the observation as a SeenArm, for the log and for sessions. Each point of a red line becomes a
/// marker, whose position is the point's height. The four corners of the silhouette become points.
[[nodiscard]] SeenArm drawn_etalon(const EtalonObservation& seen, const EtalonConfig& etalon,
                                   const View& view);

/// Returns the observer for a session with the configured calibration cylinder. The observer reports
/// observations as SeenArm (drawn_etalon). All arguments must outlive the observer.
[[nodiscard]] std::unique_ptr<RigObserver> etalon_observer(const RigModel& nominal, const RigPrior& prior,
                                                           const RigSessionConfig& config);

}  // namespace flexura
