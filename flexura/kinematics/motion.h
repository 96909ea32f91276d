#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "flexura/kinematics/profile.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Upper bounds on how fast a section changes.
struct SectionRates {
  double bend = 0;     ///< |d bend/dt|, rad/s.
  double stretch = 0;  ///< |d stretch/dt|, 1/s.
};

/// A law of motion: the arm's state over the time of one task. A value that does not change; safe to share.
class Motion {
 public:
  virtual ~Motion() = default;
  Motion() = default;
  Motion(const Motion&) = delete;
  Motion& operator=(const Motion&) = delete;

  [[nodiscard]] virtual double duration() const = 0;  ///< s, >= 0.
  /// The state at `time` in [0, duration()] s. What a law does not compute to a finite number comes out as it
  /// is.
  [[nodiscard]] virtual ArmState at(double time) const = 0;
  /// Bounds that hold for `section` everywhere in [start, end] s; empty where the law has none that is known.
  [[nodiscard]] virtual std::optional<SectionRates> rates(std::size_t section, double start,
                                                          double end) const = 0;
};

/// Shared by who plays it and who checks it.
using MotionPtr = std::shared_ptr<const Motion>;

/// The arm stays in `state` for `duration` s.
[[nodiscard]] MotionPtr hold_motion(ArmState state, double duration);

/// From one state to another, every section on a straight line in bend and stretch, each with its own time
/// profile (one a section, all of one duration; else std::invalid_argument).
[[nodiscard]] MotionPtr point_to_point_motion(ArmState from, ArmState to, std::vector<Profile> profiles);

/// bend_i(t) = from_i + amplitude_i (sin(2 pi t / period + phase_i) - sin(phase_i)) for `duration` s: starts
/// where the arm is. One amplitude (rad) and phase (rad) a section, else std::invalid_argument; the period,
/// s, is above 0.
[[nodiscard]] MotionPtr sine_motion(ArmState from, std::vector<Eigen::Vector2d> amplitudes,
                                    std::vector<double> phases, double period, double duration);

/// How a motion passes from one keyframe to the next: in a straight line, or without a corner (cubic Hermite
/// pieces whose slopes are the parabola's through three neighbouring keyframes, and zero at both ends).
enum class Interpolation { linear, smooth };

/// Through `states` at `times` (s, rising from 0, at least two; else std::invalid_argument).
[[nodiscard]] MotionPtr keyframe_motion(std::vector<double> times, const std::vector<ArmState>& states,
                                        Interpolation interpolation);

/// Any function of the time from 0 to `duration`, s, such as an expression a user wrote; it may do anything,
/// so no rates are known.
[[nodiscard]] MotionPtr function_motion(double duration, std::function<ArmState(double time)> state_at);

}  // namespace flexura
