#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstddef>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "flexura/safety/motion_check.h"
#include "flexura/safety/spans.h"
#include "tests/support/arms.h"
#include "tests/support/motions.h"
#include "tests/support/sampled_clearance.h"

namespace flexura {

/// What a comparison of checks with dense samples came to.
struct SampledComparison {
  std::size_t motions = 0;
  std::size_t samples = 0;          ///< Of limits, of all motions together.
  std::size_t spans = 0;            ///< Violations that the check reported.
  std::size_t contact_spans = 0;    ///< Of these, contacts.
  std::size_t above = 0;            ///< Values above their limit in the samples.
  std::size_t missed = 0;           ///< Of these, outside every reported span.
  std::size_t refuted = 0;          ///< Reported spans of limits, longer than two samples, without one.
  std::size_t contact_samples = 0;  ///< States whose clearances were computed.
  std::size_t contacts = 0;         ///< Of these, in contact, by the thing touched.
  std::size_t contacts_missed = 0;  ///< Of these, outside every reported span.
};

/// Limits that a random motion sometimes breaks.
inline void limit_randomly(TestRandom& random, Arm& arm) {
  for (Section& section : arm.sections) {
    section.max_bend = random.uniform(1.5, 4.5);
    section.max_bend_rate = random.uniform(0.5, 20);
    section.stretch_limits = {random.uniform(0.7, 0.95), random.uniform(1.05, 1.3)};
    const double radius = section.length * random.uniform(0.05, 0.4);
    section.radius = {radius, radius * random.uniform(0.6, 1.0)};
  }
}

/// One obstacle of every kind, near the arm.
inline std::vector<ObstacleConfig> random_obstacles(TestRandom& random, const Arm& arm) {
  const auto place = [&] {
    const Eigen::Vector3d p = arm.X_WB.position + arm.length() * random.vector<3>(-0.8, 0.8);
    return std::array{p.x(), p.y(), p.z()};
  };
  const auto size = [&] { return arm.length() * random.uniform(0.02, 0.2); };
  const Eigen::Vector3d n = random.vector<3>(-1, 1);
  const Eigen::Quaterniond q(so3_exp(random.vector<3>(-2, 2)));
  return {PlaneConfig{.point = place(), .normal = {n.x(), n.y(), n.z()}},
          SphereConfig{.center = place(), .radius = size()},
          CapsuleConfig{.from = place(), .to = place(), .radius = size()},
          BoxConfig{.center = place(),
                    .half_sizes = {size(), size(), size()},
                    .rotation = {q.w(), q.x(), q.y(), q.z()}}};
}

/// Holds one check against samples of its motion, which starts at time 0.
class SampledCheck {
 public:
  SampledCheck(const Arm& arm, const std::vector<Obstacle>& obstacles, const Motion& motion,
               const SafetyReport& report, std::size_t samples, SampledComparison& result)
      : arm_(arm), obstacles_(obstacles), motion_(motion), samples_(samples), result_(result) {
    for (const Violation& v : report.violations) {
      const bool is_contact = v.hazard == Hazard::self_contact || v.hazard == Hazard::obstacle;
      const std::size_t section = is_contact ? 0 : v.section.value_or(0);
      reported_[{v.hazard, section, v.name}].push_back({{v.start, v.end}, is_contact});
      ++(is_contact ? result_.contact_spans : result_.spans);
    }
    ++result_.motions;
  }

  void compare_limits() {
    ArmState before;
    const double h = motion_.duration() / static_cast<double>(samples_);
    for (std::size_t k = 0; k <= samples_; ++k) {
      const double time = time_of(k);
      const ArmState state = motion_.at(time);
      for (std::size_t i = 0; i < arm_.sections.size(); ++i) {
        const Section& section = arm_.sections[i];
        const double bend = state.bends[i].norm();
        const double stretch = state.stretches[i];
        const double radius = std::max(section.radius[0], section.radius[1]);
        above(Hazard::bend, i, time, bend - section.max_bend);
        above(Hazard::stretch, i, time, stretch - section.stretch_limits[1]);
        above(Hazard::stretch, i, time, section.stretch_limits[0] - stretch);
        above(Hazard::folding, i, time, bend * radius / (section.length * stretch) - 1);
        if (k == 0) continue;
        // The mean rate from sample to sample, which some rate between them reaches; allow for its rounding.
        const double rate = (state.bends[i] - before.bends[i]).norm() / h - 1e-14 / h;
        above(Hazard::bend_rate, i, time, rate - section.max_bend_rate, h);
      }
      before = state;
    }
    result_.samples += samples_ + 1;
    for (const auto& [what, spans] : reported_) {
      for (const Reported& one : spans)
        if (!one.confirmed && one.span.end - one.span.start > 2 * h) ++result_.refuted;
    }
  }

  /// Clearances at every hundredth sample; and between two of these those that at one of them are less than
  /// four times what any point of the arm moves in between, and are not reported as a contact there.
  void compare_contacts() {
    constexpr std::size_t coarse = 100;
    std::vector<Eigen::Vector3d> points;
    std::vector<std::size_t> all(obstacles_.size() + 1);
    std::iota(all.begin(), all.end(), std::size_t{0});
    for (std::size_t k = 0; k <= samples_; k += coarse) {
      const ArmState state = motion_.at(time_of(k));
      const std::vector<Eigen::Vector3d> before = std::move(points);
      points = is_possible(state) ? SampledArm(arm_, state).points() : std::vector<Eigen::Vector3d>{};
      count_contacts(k, all);
      if (before.empty() || points.empty()) continue;
      double moved = 0;
      for (std::size_t i = 0; i < points.size(); ++i) moved = std::max(moved, (points[i] - before[i]).norm());
      std::vector<std::size_t> near = near_contact(k - coarse, 4 * moved);
      for (const std::size_t thing : near_contact(k, 4 * moved))
        if (std::ranges::count(near, thing) == 0) near.push_back(thing);
      for (std::size_t fine = k - coarse + 1; !near.empty() && fine < k; ++fine) count_contacts(fine, near);
    }
  }

 private:
  struct Key {
    Hazard hazard;
    std::size_t section;
    std::string name;
    auto operator<=>(const Key&) const = default;
  };
  struct Reported {
    Span span;
    bool confirmed = false;
  };

  [[nodiscard]] double time_of(std::size_t k) const {
    return k == samples_ ? motion_.duration()
                         : motion_.duration() * static_cast<double>(k) / static_cast<double>(samples_);
  }

  // Takes a value's excess over its limit, which occurs somewhere in the time `within` before.
  void above(Hazard hazard, std::size_t section, double time, double excess, double within = 0) {
    constexpr double doubtful = 1e-8;  // neither above nor below, by rounding
    constexpr double slack = 1e-6;     // s; reported spans are right to 1e-7
    if (excess <= 0) return;
    bool is_reported = false;
    for (Reported& one : reported_[{hazard, section, {}}]) {
      if (one.span.start > time + slack || time - within > one.span.end + slack) continue;
      is_reported = one.confirmed = true;
    }
    if (excess <= doubtful) return;
    ++result_.above;
    if (!is_reported) ++result_.missed;
  }

  // What the arm may touch is numbered: obstacles from 0, and last the arm itself.
  [[nodiscard]] double clearance(const SampledArm& arm, std::size_t thing, double need) const {
    return thing < obstacles_.size() ? arm.clearance(obstacles_[thing], need) : arm.clearance(need);
  }
  [[nodiscard]] bool is_reported(std::size_t thing, double time) const {
    constexpr double slack = 1e-4;  // s, to which reported contacts are right
    const bool is_obstacle = thing < obstacles_.size();
    const auto found = reported_.find({is_obstacle ? Hazard::obstacle : Hazard::self_contact, 0,
                                       is_obstacle ? obstacles_[thing].name : ""});
    return found != reported_.end() && std::ranges::any_of(found->second, [&](const Reported& one) {
             return one.span.start - slack <= time && time <= one.span.end + slack;
           });
  }

  // What is not reported and nearer than `need`.
  [[nodiscard]] std::vector<std::size_t> near_contact(std::size_t k, double need) const {
    const SampledArm arm(arm_, motion_.at(time_of(k)));
    std::vector<std::size_t> near;
    for (std::size_t thing = 0; thing <= obstacles_.size(); ++thing) {
      if (!is_reported(thing, time_of(k)) && clearance(arm, thing, need) < need) near.push_back(thing);
    }
    return near;
  }

  // An arm without length has no clearances.
  void count_contacts(std::size_t k, const std::vector<std::size_t>& things) {
    const ArmState state = motion_.at(time_of(k));
    if (!is_possible(state)) return;
    const SampledArm arm(arm_, state);
    ++result_.contact_samples;
    for (const std::size_t thing : things) {
      if (clearance(arm, thing, 0) >= -2e-6) continue;  // less counts as none
      ++result_.contacts;
      if (!is_reported(thing, time_of(k))) ++result_.contacts_missed;
    }
  }

  const Arm& arm_;
  const std::vector<Obstacle>& obstacles_;
  const Motion& motion_;
  std::size_t samples_;
  SampledComparison& result_;
  std::map<Key, std::vector<Reported>> reported_;
};

/// Checks one random motion of every kind, on an arm with random limits among random obstacles.
inline void compare_with_samples(TestRandom& random, std::size_t samples, SampledComparison& result) {
  Arm arm = random_arm(random);
  if (random.integer(0, 3) == 0) arm.kind = ArmKind::planar;
  limit_randomly(random, arm);
  const std::vector<Obstacle> around = obstacles(random_obstacles(random, arm));
  for (const MotionPtr& motion : random_motions(random, arm)) {
    const SafetyReport report = check_motions(arm, around, motion->at(0), {{motion, 0}}, 0.02);
    SampledCheck check(arm, around, *motion, report, samples, result);
    check.compare_limits();
    check.compare_contacts();
  }
}

}  // namespace flexura
