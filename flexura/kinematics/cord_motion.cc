#include "flexura/kinematics/cord_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "flexura/kinematics/planar.h"

namespace flexura {
namespace {

class CordPointToPointMotion : public Motion {
 public:
  CordPointToPointMotion(ArmState from, ArmState to, std::vector<double> cord_changes,
                         std::vector<Profile> profiles)
      : from_(std::move(from)),
        to_(std::move(to)),
        cord_changes_(std::move(cord_changes)),
        profiles_(std::move(profiles)) {
    const bool one_duration = std::ranges::all_of(profiles_, [&](const Profile& profile) {
      return profile.duration() == profiles_.front().duration();
    });
    if (profiles_.empty() || profiles_.size() != from_.bends.size() ||
        cord_changes_.size() != from_.bends.size() || !one_duration) {
      throw std::invalid_argument(
          "a motion of chord angles needs, per section, one change and one profile; all profiles must have "
          "equal durations");
    }
  }
  [[nodiscard]] double duration() const override { return profiles_.front().duration(); }

  [[nodiscard]] ArmState at(double time) const override {
    if (time <= 0) return from_;
    if (time >= duration()) return to_;
    std::vector<double> changes;
    changes.reserve(profiles_.size());
    ArmState state = from_;
    for (std::size_t i = 0; i < profiles_.size(); ++i) {
      const double done = profiles_[i].fraction(time);
      changes.push_back(done * cord_changes_[i]);
      state.stretches[i] = (1 - done) * from_.stretches[i] + done * to_.stretches[i];
    }
    // Changes follow eq. 5 without its constant, the base's tangent angle.
    const std::vector<double> archings = archings_from_cord_angles(changes, 0.0);
    for (std::size_t i = 0; i < archings.size(); ++i) state.bends[i] += bend_from_arching(archings[i]);
    return state;
  }

  // Inverts eq. 5 for rates in known intervals. The bounds converge to the rate as the intervals shrink.
  [[nodiscard]] std::optional<SectionRates> rates(std::size_t section, double start,
                                                  double end) const override {
    using Interval = std::array<double, 2>;
    const auto cord_rate = [&](std::size_t i) -> Interval {
      const double least = profiles_[i].min_rate(start, end) * cord_changes_[i];
      const double most = profiles_[i].max_rate(start, end) * cord_changes_[i];
      return {std::min(least, most), std::max(least, most)};
    };
    Interval tangent{0.0, 0.0};
    for (std::size_t i = 0; i < section; ++i) {
      const auto [low, high] = cord_rate(i);
      tangent = {2 * low - tangent[1], 2 * high - tangent[0]};
    }
    const auto [low, high] = cord_rate(section);
    const double arching = std::max(std::abs(low - tangent[1]), std::abs(high - tangent[0]));
    return SectionRates{2 * arching, profiles_[section].max_rate(start, end) *
                                         std::abs(to_.stretches[section] - from_.stretches[section])};
  }

 private:
  ArmState from_;
  ArmState to_;
  std::vector<double> cord_changes_;  // In rad.
  std::vector<Profile> profiles_;
};

}  // namespace

MotionPtr cord_point_to_point_motion(ArmState from, ArmState to, std::vector<double> cord_changes,
                                     std::vector<Profile> profiles) {
  return std::make_shared<const CordPointToPointMotion>(std::move(from), std::move(to),
                                                        std::move(cord_changes), std::move(profiles));
}

// Each bend is a sum of the cords' sines. Sines of one period add up to a sine, as complex numbers amplitude
// exp(i phase). So this is a sine motion of the bends, with other amplitudes and phases.
MotionPtr cord_sine_motion(ArmState from, const std::vector<double>& amplitudes,
                           const std::vector<double>& phases, double period, double duration) {
  if (amplitudes.size() != from.bends.size() || phases.size() != from.bends.size()) {
    throw std::invalid_argument(
        "a sinusoidal motion of chord angles needs one amplitude and one phase per section");
  }
  std::vector<double> real, imaginary;
  for (std::size_t i = 0; i < amplitudes.size(); ++i) {
    real.push_back(amplitudes[i] * std::cos(phases[i]));
    imaginary.push_back(amplitudes[i] * std::sin(phases[i]));
  }
  real = archings_from_cord_angles(real, 0.0);
  imaginary = archings_from_cord_angles(imaginary, 0.0);
  std::vector<Eigen::Vector2d> bend_amplitudes;
  std::vector<double> bend_phases;
  for (std::size_t i = 0; i < amplitudes.size(); ++i) {
    bend_amplitudes.push_back(bend_from_arching(std::hypot(real[i], imaginary[i])));
    bend_phases.push_back(std::atan2(imaginary[i], real[i]));
  }
  return sine_motion(std::move(from), std::move(bend_amplitudes), std::move(bend_phases), period, duration);
}

}  // namespace flexura
