#pragma once

#include <array>
#include <cstddef>
#include <optional>
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

/// The eyes of a session before the calibration cylinder. What they say of a picture is as drawn_etalon has
/// it.
class EtalonEyes : public RigEyes {
 public:
  /// All outlive it; the configuration has an etalon.
  EtalonEyes(const RigModel& believed, const RigPrior& prior, const RigSessionConfig& config);

  std::optional<Eigen::Vector2d> whereabouts() const override { return last_.centroid; }
  RigReading read(const RigModel* found) const override;
  RigImage told(const RigModel& model, const RigSight& sight) const override;

 private:
  std::vector<ArmState>& poses() override { return poses_; }
  std::vector<RigStance>& stances() override { return stances_; }
  bool look(std::size_t i, const Picture& picture) override;
  SeenArm unkept(const View& view) const override;
  SeenArm keep(std::size_t stance, std::size_t pose, const RigModel* found) override;

  struct Look {
    std::size_t stance = 0, pose = 0;
    EtalonSighting seen;
  };
  [[nodiscard]] RigObservations observations(const RigModel& model) const;
  [[nodiscard]] RigReading read_by(const RigModel& first) const;

  const RigPrior& prior_;
  const RigSessionConfig& config_;
  EtalonFigure etalon_;
  std::vector<ArmState> poses_;
  std::vector<RigStance> stances_;
  std::vector<Look> looks_;
  EtalonView last_;
};

}  // namespace flexura
