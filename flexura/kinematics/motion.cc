#include "flexura/kinematics/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace flexura {
namespace {

class HoldMotion : public Motion {
 public:
  HoldMotion(ArmState state, double duration) : state_(std::move(state)), duration_(duration) {}
  [[nodiscard]] double duration() const override { return duration_; }
  [[nodiscard]] ArmState at(double) const override { return state_; }
  [[nodiscard]] std::optional<SectionRates> rates(std::size_t, double, double) const override {
    return SectionRates{};
  }

 private:
  ArmState state_;
  double duration_;
};

class PointToPointMotion : public Motion {
 public:
  PointToPointMotion(ArmState from, ArmState to, std::vector<Profile> profiles)
      : from_(std::move(from)), to_(std::move(to)), profiles_(std::move(profiles)) {
    const bool one_duration = std::ranges::all_of(profiles_, [&](const Profile& profile) {
      return profile.duration() == profiles_.front().duration();
    });
    if (profiles_.size() != from_.bends.size() || profiles_.empty() || !one_duration) {
      throw std::invalid_argument(
          "a point to point motion needs one profile per section, all with equal durations");
    }
  }
  [[nodiscard]] double duration() const override { return profiles_.front().duration(); }

  [[nodiscard]] ArmState at(double time) const override {
    if (time <= 0) return from_;
    if (time >= duration()) return to_;
    ArmState state = from_;
    for (std::size_t i = 0; i < profiles_.size(); ++i) {
      const double done = profiles_[i].fraction(time);
      state.bends[i] = (1 - done) * from_.bends[i] + done * to_.bends[i];
      state.stretches[i] = (1 - done) * from_.stretches[i] + done * to_.stretches[i];
    }
    return state;
  }

  [[nodiscard]] std::optional<SectionRates> rates(std::size_t section, double start,
                                                  double end) const override {
    const double rate = profiles_[section].max_rate(start, end);
    return SectionRates{rate * (to_.bends[section] - from_.bends[section]).norm(),
                        rate * std::abs(to_.stretches[section] - from_.stretches[section])};
  }

 private:
  ArmState from_;
  ArmState to_;
  std::vector<Profile> profiles_;
};

class SineMotion : public Motion {
 public:
  SineMotion(ArmState from, std::vector<Eigen::Vector2d> amplitudes, std::vector<double> phases,
             double period, double duration)
      : from_(std::move(from)),
        amplitudes_(std::move(amplitudes)),
        phases_(std::move(phases)),
        frequency_(2 * std::numbers::pi / period),
        duration_(duration) {
    if (amplitudes_.size() != from_.bends.size() || phases_.size() != from_.bends.size()) {
      throw std::invalid_argument("a sine needs one amplitude and one phase per section");
    }
  }
  [[nodiscard]] double duration() const override { return duration_; }

  [[nodiscard]] ArmState at(double time) const override {
    ArmState state = from_;
    for (std::size_t i = 0; i < phases_.size(); ++i) {
      state.bends[i] += amplitudes_[i] * (std::sin(frequency_ * time + phases_[i]) - std::sin(phases_[i]));
    }
    return state;
  }

  // The rate is amplitude * frequency * |cos|, largest at a multiple of pi or at an end.
  [[nodiscard]] std::optional<SectionRates> rates(std::size_t section, double start,
                                                  double end) const override {
    const double from = frequency_ * start + phases_[section];
    const double to = frequency_ * end + phases_[section];
    const bool has_peak = std::floor(to / std::numbers::pi) * std::numbers::pi >= from;
    const double most = has_peak ? 1.0 : std::max(std::abs(std::cos(from)), std::abs(std::cos(to)));
    return SectionRates{amplitudes_[section].norm() * frequency_ * most, 0};
  }

 private:
  ArmState from_;
  std::vector<Eigen::Vector2d> amplitudes_;
  std::vector<double> phases_;
  double frequency_;  // rad/s.
  double duration_;
};

// Returns a section's bend and stretch as one vector, so that keyframes handle both.
Eigen::Vector3d section_vector(const ArmState& state, std::size_t section) {
  return {state.bends[section].x(), state.bends[section].y(), state.stretches[section]};
}

class KeyframeMotion : public Motion {
 public:
  KeyframeMotion(std::vector<double> times, const std::vector<ArmState>& states, Interpolation interpolation)
      : times_(std::move(times)) {
    const bool rising = std::ranges::adjacent_find(times_, std::ranges::greater_equal{}) == times_.end();
    if (times_.size() < 2 || times_.size() != states.size() || times_.front() != 0 || !rising) {
      throw std::invalid_argument("keyframes need two or more states at times that increase from 0");
    }
    const std::size_t sections = states.front().bends.size();
    for (const ArmState& state : states) {
      if (state.bends.size() != sections || state.stretches.size() != sections) {
        throw std::invalid_argument("keyframes need one bend and one stretch per section");
      }
      auto& row = values_.emplace_back();
      for (std::size_t i = 0; i < sections; ++i) row.push_back(section_vector(state, i));
    }
    for (std::size_t k = 0; k < times_.size(); ++k) {
      auto& row = slopes_.emplace_back(sections, Eigen::Vector3d::Zero());
      const bool inner = k > 0 && k + 1 < times_.size();
      for (std::size_t i = 0; i < sections && inner && interpolation == Interpolation::smooth; ++i)
        row[i] = slope(k, i);
    }
    is_linear_ = interpolation == Interpolation::linear;
  }

  [[nodiscard]] double duration() const override { return times_.back(); }

  [[nodiscard]] ArmState at(double time) const override {
    const std::size_t k = piece_at(time);
    const double width = times_[k + 1] - times_[k];
    const double x = std::clamp((time - times_[k]) / width, 0.0, 1.0);
    ArmState state = ArmState::straight(values_.front().size());
    for (std::size_t i = 0; i < values_.front().size(); ++i) {
      const Eigen::Vector3d value = is_linear_
                                        ? Eigen::Vector3d((1 - x) * values_[k][i] + x * values_[k + 1][i])
                                        : hermite(k, i, x, width);
      state.bends[i] = value.head<2>();
      state.stretches[i] = value.z();
    }
    return state;
  }

  [[nodiscard]] std::optional<SectionRates> rates(std::size_t section, double start,
                                                  double end) const override {
    SectionRates most;
    const std::size_t first = piece_at(start);
    for (std::size_t k = first; k + 1 < times_.size() && (k == first || times_[k] < end); ++k) {
      const double width = times_[k + 1] - times_[k];
      const Eigen::Vector3d mean = (values_[k + 1][section] - values_[k][section]) / width;
      if (is_linear_) {
        include(mean, most);
        continue;
      }
      // The rate of a cubic is a quadratic Bezier curve: its control points are the slopes at the ends and 3
      // mean - (their sum) in the middle. A part of it, from a to b, is one too, within the hull of its
      // control points. These are the values (a, a), (a, b) and (b, b) of its blossom.
      const Eigen::Vector3d& p0 = slopes_[k][section];
      const Eigen::Vector3d& p2 = slopes_[k + 1][section];
      const Eigen::Vector3d p1 = 3 * mean - p0 - p2;
      const double a = std::clamp((start - times_[k]) / width, 0.0, 1.0);
      const double b = std::clamp((end - times_[k]) / width, 0.0, 1.0);
      for (const auto& [x, y] : {std::pair(a, a), std::pair(a, b), std::pair(b, b)})
        include((1 - x) * (1 - y) * p0 + ((1 - x) * y + x * (1 - y)) * p1 + x * y * p2, most);
    }
    return most;
  }

 private:
  static void include(const Eigen::Vector3d& rate, SectionRates& most) {
    most.bend = std::max(most.bend, rate.head<2>().norm());
    most.stretch = std::max(most.stretch, std::abs(rate.z()));
  }

  // Returns the slope at k of the parabola through the keyframes k - 1, k and k + 1.
  [[nodiscard]] Eigen::Vector3d slope(std::size_t k, std::size_t i) const {
    const double before = times_[k] - times_[k - 1];
    const double after = times_[k + 1] - times_[k];
    const Eigen::Vector3d mean_before = (values_[k][i] - values_[k - 1][i]) / before;
    const Eigen::Vector3d mean_after = (values_[k + 1][i] - values_[k][i]) / after;
    return (after * mean_before + before * mean_after) / (before + after);
  }

  [[nodiscard]] Eigen::Vector3d hermite(std::size_t k, std::size_t i, double x, double width) const {
    const double y = 1 - x;
    return y * y * (1 + 2 * x) * values_[k][i] + x * x * (1 + 2 * y) * values_[k + 1][i] +
           width * x * y * (y * slopes_[k][i] - x * slopes_[k + 1][i]);
  }

  [[nodiscard]] std::size_t piece_at(double time) const {
    const auto after = std::ranges::upper_bound(times_, time);
    const auto index = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - times_.begin(), 1)) - 1;
    return std::min(index, times_.size() - 2);
  }

  std::vector<double> times_;
  std::vector<std::vector<Eigen::Vector3d>> values_;  // By keyframe and section.
  std::vector<std::vector<Eigen::Vector3d>> slopes_;  // Per s.
  bool is_linear_ = true;
};

class FunctionMotion : public Motion {
 public:
  FunctionMotion(double duration, std::function<ArmState(double)> state_at)
      : duration_(duration), state_at_(std::move(state_at)) {}
  [[nodiscard]] double duration() const override { return duration_; }
  [[nodiscard]] ArmState at(double time) const override { return state_at_(time); }
  [[nodiscard]] std::optional<SectionRates> rates(std::size_t, double, double) const override {
    return std::nullopt;
  }

 private:
  double duration_;
  std::function<ArmState(double)> state_at_;
};

}  // namespace

MotionPtr hold_motion(ArmState state, double duration) {
  return std::make_shared<const HoldMotion>(std::move(state), duration);
}

MotionPtr point_to_point_motion(ArmState from, ArmState to, std::vector<Profile> profiles) {
  return std::make_shared<const PointToPointMotion>(std::move(from), std::move(to), std::move(profiles));
}

MotionPtr sine_motion(ArmState from, std::vector<Eigen::Vector2d> amplitudes, std::vector<double> phases,
                      double period, double duration) {
  return std::make_shared<const SineMotion>(std::move(from), std::move(amplitudes), std::move(phases), period,
                                            duration);
}

MotionPtr keyframe_motion(std::vector<double> times, const std::vector<ArmState>& states,
                          Interpolation interpolation) {
  return std::make_shared<const KeyframeMotion>(std::move(times), states, interpolation);
}

MotionPtr function_motion(double duration, std::function<ArmState(double)> state_at) {
  return std::make_shared<const FunctionMotion>(duration, std::move(state_at));
}

}  // namespace flexura
