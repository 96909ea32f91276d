#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "flexura/kinematics/profile.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Upper bounds on the rates of a section's bend and stretch.
struct SectionRates {
  double bend = 0;     ///< Bound on |d bend/dt|, rad/s.
  double stretch = 0;  ///< Bound on |d stretch/dt|, 1/s.
};

/// A motion: the arm's state as a function of time within one task. A motion is immutable, so that threads
/// can share it.
class Motion {
 public:
  virtual ~Motion() = default;
  Motion() = default;
  Motion(const Motion&) = delete;
  Motion& operator=(const Motion&) = delete;

  [[nodiscard]] virtual double duration() const = 0;  ///< Returns the duration, s; >= 0.
  /// Returns the state at `time`, s, in [0, duration()]. Values may be infinite or NaN, for example those of
  /// a user's formula.
  [[nodiscard]] virtual ArmState at(double time) const = 0;
  /// Returns bounds on the rates of `section` that hold during all of [start, end], s; std::nullopt if
  /// unknown.
  [[nodiscard]] virtual std::optional<SectionRates> rates(std::size_t section, double start,
                                                          double end) const = 0;
};

/// A shared motion.
using MotionPtr = std::shared_ptr<const Motion>;

/// Returns a motion that stays in `state` for `duration` s.
[[nodiscard]] MotionPtr hold_motion(ArmState state, double duration);

/// Returns a motion between two states. The bend and stretch of each section change along a straight line,
/// with the section's time profile. Throws std::invalid_argument unless there is one profile per section, and
/// all profiles have equal durations.
[[nodiscard]] MotionPtr point_to_point_motion(ArmState from, ArmState to, std::vector<Profile> profiles);

/// Returns a sinusoidal motion, which starts at the state `from`. The bend of section i is from_i +
/// amplitude_i (sin(2 pi t / period + phase_i) - sin(phase_i)). Amplitudes and phases are in rad. The period,
/// which must be above 0, and the duration are in s. Throws std::invalid_argument unless there are one
/// amplitude and one phase per section.
[[nodiscard]] MotionPtr sine_motion(ArmState from, std::vector<Eigen::Vector2d> amplitudes,
                                    std::vector<double> phases, double period, double duration);

/// Interpolation between keyframes. `linear`: straight lines. `smooth`: cubic Hermite pieces. At an inner
/// keyframe, the slope is the slope of the parabola through the keyframe and its two neighbours. At both
/// ends, the slope is zero.
enum class Interpolation { linear, smooth };

/// Returns a motion through `states` at `times`, s. Throws std::invalid_argument unless there are at least
/// two times, which start at 0 and increase.
[[nodiscard]] MotionPtr keyframe_motion(std::vector<double> times, const std::vector<ArmState>& states,
                                        Interpolation interpolation);

/// Returns a motion that is given by a function of time, such as a user's expression, from time 0 to
/// `duration`, s. The bounds on the rates of this motion are unknown.
[[nodiscard]] MotionPtr function_motion(double duration, std::function<ArmState(double time)> state_at);

}  // namespace flexura
