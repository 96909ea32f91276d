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

/// Most states in a report, and most numbers in them.
inline constexpr std::size_t max_shown_states = 2000;
inline constexpr std::size_t max_shown_numbers = 200'000;

/// Returns indices of at most `most` (>= 2) of the increasing `times`. These are the first and the last,
/// those nearest to the times in `desired` (thinned evenly above half of all), and others evenly spaced. The
/// result is increasing.
[[nodiscard]] std::vector<std::size_t> kept_indices(const std::vector<double>& times,
                                                    const std::vector<double>& desired, std::size_t most);

/// Violations of one picture, at the moment when they are worst.
struct UnsafeMoment {
  std::vector<std::size_t> violations;  ///< Indices in ReportMotion::violations.
  std::size_t state = 0;                ///< Index of the state nearest to the requested moment.
};

/// The part of a run that its report shows.
struct ReportMotion {
  Arm arm;
  ArmModel model = ArmModel(arm);
  std::vector<double> times;        ///< In s.
  std::vector<ArmState> states;     ///< One per time.
  std::vector<Backbone> backbones;  ///< One per time.
  std::vector<double> event_times;  ///< In s, distinct, inside the run; empty if there are too many to mark.
  std::size_t recorded = 0;         ///< Number of states in the run.
  std::size_t middle = 0;           ///< Index of the state nearest to half the time.
  std::vector<UnsafeMoment> unsafe_moments;
  std::vector<ReportData::Safety::Violation> violations;
  std::vector<ObstacleConfig> obstacles;
  CurveKind curve = CurveKind::arcs;  ///< As in ReportData.
  double tension = 0.5;
  bool in_plane = false;          ///< The arm moves in a plane parallel to XOY.
  bool stretches_change = false;  ///< Some stretch is not always 1.
  bool is_still = false;          ///< The arm never moves.

  [[nodiscard]] std::size_t count() const { return times.size(); }
  /// Returns true if a violation is drawn on the section in state i.
  [[nodiscard]] bool is_unsafe(std::size_t section, std::size_t i) const;
  [[nodiscard]] std::size_t end() const { return times.size() - 1; }
  [[nodiscard]] const Eigen::Vector3d& tip(std::size_t i) const { return backbones[i].tip().position; }
  /// Returns true if cord angles are relative to the world's +X as in the paper: for an arm in XOY whose
  /// archings are counter-clockwise for camera 1.
  [[nodiscard]] bool has_cord_angles() const { return in_plane && arm.X_WB.rotation(2, 1) < 0.0; }
  /// Returns 2 if the tip moves in XOY itself, otherwise 3.
  [[nodiscard]] int tip_coordinates() const;
  /// Returns "E(-10.738, 5.201)" in state i, m, with tip_coordinates() coordinates.
  [[nodiscard]] std::string tip_text(std::size_t i) const;
};

/// Checks the data and thins it. Throws std::invalid_argument if it is invalid.
[[nodiscard]] ReportMotion motion_of(const ReportData& data);

}  // namespace flexura
