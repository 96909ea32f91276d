#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "flexura/kinematics/profile.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Upper bounds on a section's rates.
struct SectionRates {
  double bend = 0;     ///< |d bend/dt|, rad/s.
  double stretch = 0;  ///< |d stretch/dt|, 1/s.
};

/// A law of motion: the arm's state over the time of one task. Immutable; safe to share.
class Motion {
 public:
  virtual ~Motion() = default;
  Motion() = default;
  Motion(const Motion&) = delete;
  Motion& operator=(const Motion&) = delete;

  [[nodiscard]] virtual double duration() const = 0;  ///< In s, >= 0.
  /// Returns the state at `time` in [0, duration()] s. Values of a law that are not finite are returned as
  /// they are.
  [[nodiscard]] virtual ArmState at(double time) const = 0;
  /// Returns bounds for `section` in all of [start, end] s; std::nullopt if they are unknown.
  [[nodiscard]] virtual std::optional<SectionRates> rates(std::size_t section, double start,
                                                          double end) const = 0;
};

/// Shared by the player and the checks.
using MotionPtr = std::shared_ptr<const Motion>;

/// Returns a motion that stays in `state` for `duration` s.
[[nodiscard]] MotionPtr hold_motion(ArmState state, double duration);

/// Returns a motion between two states. Every section moves on a straight line in bend and stretch, each with
/// its own time profile. Throws std::invalid_argument unless there is one profile per section, all of one
/// duration.
[[nodiscard]] MotionPtr point_to_point_motion(ArmState from, ArmState to, std::vector<Profile> profiles);

/// Returns bend_i(t) = from_i + amplitude_i (sin(2 pi t / period + phase_i) - sin(phase_i)) for `duration` s,
/// which starts at the arm's state. Throws std::invalid_argument unless there are one amplitude (rad) and one
/// phase (rad) per section. The period, s, is above 0.
[[nodiscard]] MotionPtr sine_motion(ArmState from, std::vector<Eigen::Vector2d> amplitudes,
                                    std::vector<double> phases, double period, double duration);

/// Interpolation between keyframes: linear, or smooth. Smooth has cubic Hermite pieces with the slopes of the
/// parabola through three neighbouring keyframes, and zero at both ends.
enum class Interpolation { linear, smooth };

/// Returns a motion through `states` at `times` (s). Throws std::invalid_argument unless there are at least
/// two times, increasing from 0.
[[nodiscard]] MotionPtr keyframe_motion(std::vector<double> times, const std::vector<ArmState>& states,
                                        Interpolation interpolation);

/// Returns a motion by any function of the time from 0 to `duration`, s, such as a user's expression. Its
/// rates are unknown.
[[nodiscard]] MotionPtr function_motion(double duration, std::function<ArmState(double time)> state_at);

}  // namespace flexura
