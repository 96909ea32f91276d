#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/model/arm_model.h"
#include "flexura/model/backbone.h"
#include "flexura/model/obstacle.h"
#include "flexura/report/report.h"

namespace flexura {

/// At most this many states, and this many numbers in them, go into a report.
inline constexpr std::size_t max_shown_states = 2000;
inline constexpr std::size_t max_shown_numbers = 200'000;

/// Indices of at most `most` (>= 2) of the ascending `times`: the first and the last, those nearest to the
/// times in `wanted` (evenly thinned when they would fill more than half), the rest evenly spaced. Ascending.
[[nodiscard]] std::vector<std::size_t> kept_indices(const std::vector<double>& times,
                                                    const std::vector<double>& wanted, std::size_t most);

/// Violations to be drawn in one picture, of the moment when they are worst.
struct UnsafeMoment {
  std::vector<std::size_t> violations;  ///< Their places in ReportMotion::violations.
  std::size_t state = 0;                ///< Index of the state nearest to the moment asked for.
};

/// The part of a run that its report shows.
struct ReportMotion {
  Arm arm;
  ArmModel model = ArmModel(arm);
  std::vector<double> times;        ///< s
  std::vector<ArmState> states;     ///< One a time.
  std::vector<Backbone> backbones;  ///< One a time.
  std::vector<double> event_times;  ///< s, each once, inside the run; empty when there are too many to mark.
  std::size_t recorded = 0;         ///< States in the run.
  std::size_t middle = 0;           ///< Index of the state nearest to half time.
  std::vector<UnsafeMoment> unsafe_moments;
  std::vector<ReportData::Safety::Violation> violations;
  std::vector<ObstacleConfig> obstacles;
  CurveKind curve = CurveKind::arcs;  ///< As in ReportData.
  double tension = 0.5;
  bool in_plane = false;          ///< The arm moves in a plane parallel to XOY.
  bool stretches_change = false;  ///< Some stretch is not 1 all the time.

  [[nodiscard]] std::size_t count() const { return times.size(); }
  /// Whether a violation is drawn on the section at state i.
  [[nodiscard]] bool is_unsafe(std::size_t section, std::size_t i) const;
  [[nodiscard]] std::size_t end() const { return times.size() - 1; }
  [[nodiscard]] const Eigen::Vector3d& tip(std::size_t i) const { return backbones[i].tip().position; }
  /// Whether cord angles count from the world's +X as in the paper: an arm in XOY whose archings are
  /// counter-clockwise to camera 1.
  [[nodiscard]] bool has_cord_angles() const { return in_plane && arm.X_WB.rotation(2, 1) < 0.0; }
  /// 2 when the tip moves in XOY itself, else 3.
  [[nodiscard]] int tip_coordinates() const;
  /// "E(-10.738, 5.201)" at state i, m, with tip_coordinates() of them.
  [[nodiscard]] std::string tip_text(std::size_t i) const;
};

/// Checks the data (std::invalid_argument) and thins it.
[[nodiscard]] ReportMotion motion_of(const ReportData& data);

}  // namespace flexura
