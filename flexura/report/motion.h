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

/// Largest number of states in a report, and largest count of numbers in all these states.
inline constexpr std::size_t max_shown_states = 2000;
inline constexpr std::size_t max_shown_numbers = 200'000;

/// Returns increasing indices of at most `most` (>= 2) of the increasing `times`. The indices include the
/// first and the last time, and the times nearest to those in `desired`. If `desired` has more than most / 2
/// times, the result includes only an evenly spaced selection of them. The other indices are evenly spaced.
[[nodiscard]] std::vector<std::size_t> kept_indices(const std::vector<double>& times,
                                                    const std::vector<double>& desired, std::size_t most);

/// Violations that one drawing shows, and the state at the time when these violations are worst.
struct UnsafeMoment {
  std::vector<std::size_t> violations;  ///< Indices in ReportMotion::violations.
  std::size_t state = 0;                ///< Index of the state nearest to the worst time.
};

/// The part of a run that its report shows.
struct ReportMotion {
  Arm arm;
  ArmModel model = ArmModel(arm);
  std::vector<double> times;        ///< Times of the states, s.
  std::vector<ArmState> states;     ///< States of the arm, one per time.
  std::vector<Backbone> backbones;  ///< Backbones of the states, one per time.
  std::vector<double> event_times;  ///< Times of events to mark, s, distinct and inside the run; empty if
                                    ///< there are too many to mark.
  std::size_t recorded = 0;         ///< Number of states in the run.
  std::size_t middle = 0;           ///< Index of the state nearest to half the duration.
  std::vector<UnsafeMoment> unsafe_moments;
  std::vector<ReportData::Safety::Violation> violations;
  std::vector<ObstacleConfig> obstacles;
  CurveKind curve = CurveKind::arcs;  ///< Curve that is drawn along the arm (ReportData::curve).
  double tension = 0.5;
  bool in_plane = false;          ///< Whether the arm moves in a plane parallel to XOY.
  bool stretches_change = false;  ///< Whether any stretch differs from 1 at any time.
  bool is_still = false;          ///< Whether the arm never moves.

  [[nodiscard]] std::size_t count() const { return times.size(); }
  /// Returns true if a violation is marked on the section in state i.
  [[nodiscard]] bool is_unsafe(std::size_t section, std::size_t i) const;
  [[nodiscard]] std::size_t end() const { return times.size() - 1; }
  [[nodiscard]] const Eigen::Vector3d& tip(std::size_t i) const { return backbones[i].tip().position; }
  /// Returns true if cord angles are relative to W's +X, as in the paper. The result is true for an arm in
  /// XOY whose archings are counter-clockwise seen from camera 1.
  [[nodiscard]] bool has_cord_angles() const { return in_plane && arm.X_WB.rotation(2, 1) < 0.0; }
  /// Returns 2 if the tip moves in the plane XOY (Z = 0), otherwise 3.
  [[nodiscard]] int tip_coordinates() const;
  /// Returns the tip's position in state i as a text with tip_coordinates() coordinates, m: "E(-10.738,
  /// 5.201)".
  [[nodiscard]] std::string tip_text(std::size_t i) const;
};

/// Checks the data and reduces the number of states. Throws std::invalid_argument if the data are invalid.
[[nodiscard]] ReportMotion motion_of(const ReportData& data);

}  // namespace flexura
