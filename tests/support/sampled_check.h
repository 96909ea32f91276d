#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexura/safety/motion_check.h"
#include "flexura/safety/spans.h"
#include "flexura/safety/tube.h"
#include "flexura/safety/violation.h"
#include "flexura/safety/worst.h"
#include "tests/support/arms.h"
#include "tests/support/motions.h"
#include "tests/support/sampled_clearance.h"

namespace flexura {

/// What a comparison of checks with dense samples came to. Contacts count by the section, or pair of
/// sections, and what it touches.
struct SampledComparison {
  std::size_t motions = 0;
  std::size_t samples = 0;          ///< Of limits, of all motions together.
  std::size_t spans = 0;            ///< Violations that the check reported.
  std::size_t contact_spans = 0;    ///< Of these, contacts.
  std::size_t above = 0;            ///< Values above their limit in the samples.
  std::size_t missed = 0;           ///< Of these, outside every reported span.
  std::size_t contact_samples = 0;  ///< States whose clearances were computed.
  std::size_t contacts = 0;         ///< Of these, in contact.
  std::size_t contacts_missed = 0;  ///< Of these, outside every reported span.
  std::size_t refuted = 0;          ///< Reported spans, longer than two samples, without one.
  std::size_t understated = 0;      ///< Reported spans with a sample worse than their worst value,
  std::size_t flagged = 0;          ///< and those of them of which the check says so itself.
  double most_understated = 0;      ///< Of the others: of contacts, m; of limits, share of the value.
  std::size_t overstated = 0;       ///< Reported spans whose worst value is not there at their worst time.
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
      : arm_(arm),
        obstacles_(obstacles),
        motion_(motion),
        caveats_(report.caveats),
        samples_(samples),
        result_(result) {
    for (const Violation& v : report.violations) {
      const bool is_contact = v.hazard == Hazard::self_contact || v.hazard == Hazard::obstacle;
      const Key key{v.hazard, v.section.value_or(0), v.other_section, v.name, v.limit};
      reported_[key].push_back({{v.start, v.end}, {v.worst_time, v.value}});
      ++(is_contact ? result_.contact_spans : result_.spans);
    }
    ++result_.motions;
    const std::size_t count = arm.sections.size();
    for (std::size_t thing = 0; thing < obstacles.size(); ++thing) {
      for (std::size_t i = 0; i < count; ++i)
        places_.push_back({{Hazard::obstacle, i, std::nullopt, obstacles[thing].name, 0}, thing});
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = i; j < count; ++j) places_.push_back({{Hazard::self_contact, i, j, "", 0}, 0});
    }
  }

  void compare_limits() {
    ArmState before;
    const double h = step();
    for (std::size_t k = 0; k <= samples_; ++k) {
      const double time = time_of(k);
      const ArmState state = motion_.at(time);
      for (std::size_t i = 0; i < arm_.sections.size(); ++i) {
        const Section& section = arm_.sections[i];
        above(Hazard::bend, i, time, state.bends[i].norm(), section.max_bend);
        above(Hazard::stretch, i, time, state.stretches[i], section.stretch_limits[1]);
        above(Hazard::stretch, i, time, state.stretches[i], section.stretch_limits[0], -1);
        above(Hazard::folding, i, time, folding(state, i), 1);
        if (k == 0) continue;
        // The mean rate from sample to sample, which some rate between them reaches; allow for its rounding.
        const double rate = (state.bends[i] - before.bends[i]).norm() / h - 1e-14 / h;
        above(Hazard::bend_rate, i, time, rate, section.max_bend_rate, 1, h);
      }
      before = state;
    }
    result_.samples += samples_ + 1;
    for (const auto& [key, spans] : reported_) {
      if (is_contact(key)) continue;
      for (const Reported& one : spans) {
        compare(key, one, 2 * h, 1e-8 + 1.1e-4 * std::abs(one.worst.value));
        if (key.hazard != Hazard::bend_rate) compare_worst(one, value_of(key, one.worst.time), 1e-9);
      }
    }
  }

  /// Clearances at every hundredth sample; and between two of these those that at one of them are less than
  /// four times what any point of the arm moves in between, and are not reported as a contact there.
  void compare_contacts() {
    std::vector<Eigen::Vector3d> points;
    std::vector<std::size_t> all(places_.size());
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
      for (const std::size_t place : near_contact(k, 4 * moved))
        if (std::ranges::count(near, place) == 0) near.push_back(place);
      for (std::size_t fine = k - coarse + 1; !near.empty() && fine < k; ++fine) count_contacts(fine, near);
    }
    for (const Place& place : places_) {
      for (const Reported& one : reported_[place.key]) {
        compare(place.key, one, 2 * coarse * step(), 1.05e-4);
        // Between neighbours and others the samples are coarse.
        const double close = place.key.hazard == Hazard::self_contact ? 1e-2 * arm_.length() : 2e-6;
        const ArmState state = motion_.at(one.worst.time);
        if (is_possible(state))
          compare_worst(one, -clearance(SampledArm(arm_, state), place, no_distance), close);
      }
    }
  }

 private:
  static constexpr std::size_t coarse = 100;

  struct Key {
    Hazard hazard;
    std::size_t section;
    std::optional<std::size_t> other_section;
    std::string name;
    double limit;
    auto operator<=>(const Key&) const = default;
  };
  // A section before an obstacle, or a pair of sections.
  struct Place {
    Key key;
    std::size_t obstacle;
  };
  struct Reported {
    Span span;
    WorstValue worst;
    bool confirmed = false;
    double sampled_excess = -no_distance;  // over the reported worst value
  };

  static bool is_contact(const Key& key) {
    return key.hazard == Hazard::self_contact || key.hazard == Hazard::obstacle;
  }
  [[nodiscard]] double step() const { return motion_.duration() / static_cast<double>(samples_); }
  [[nodiscard]] double time_of(std::size_t k) const {
    return k == samples_ ? motion_.duration()
                         : motion_.duration() * static_cast<double>(k) / static_cast<double>(samples_);
  }
  [[nodiscard]] double folding(const ArmState& state, std::size_t i) const {
    const Section& section = arm_.sections[i];
    const double radius = std::max(section.radius[0], section.radius[1]);
    return state.bends[i].norm() * radius / (section.length * state.stretches[i]);
  }
  [[nodiscard]] double value_of(const Key& key, double time) const {
    const ArmState state = motion_.at(time);
    if (key.hazard == Hazard::bend) return state.bends[key.section].norm();
    return key.hazard == Hazard::stretch ? state.stretches[key.section] : folding(state, key.section);
  }

  // What all samples said of a reported span.
  void compare(const Key& key, const Reported& one, double long_span, double tolerance) {
    if (!one.confirmed && one.span.end - one.span.start > long_span) ++result_.refuted;
    const bool is_flagged = is_worse_by_its_own_words(key);
    if (one.sampled_excess > tolerance) ++(is_flagged ? result_.flagged : result_.understated);
    const double scale = is_contact(key) ? 1 : std::abs(one.worst.value);
    if (!is_flagged && one.sampled_excess > 0)
      result_.most_understated = std::max(result_.most_understated, one.sampled_excess / scale);
  }
  [[nodiscard]] bool is_worse_by_its_own_words(const Key& key) const {
    const std::string what = key.hazard == Hazard::self_contact ? "contact with itself,"
                             : key.hazard == Hazard::obstacle
                                 ? "contact with " + key.name + ","
                                 : fmt::format("section {}: {},", key.section + 1, name_of(key.hazard));
    return std::ranges::any_of(caveats_, [&](const std::string& caveat) {
      return caveat.starts_with(what) && caveat.find("the worst values may be") != std::string::npos;
    });
  }
  void compare_worst(const Reported& one, double there, double tolerance) {
    if (!(std::abs(there - one.worst.value) <= tolerance) && there != one.worst.value) ++result_.overstated;
  }

  // Takes a value above (sign -1: below) its limit, which occurs somewhere in the time `within` before.
  void above(Hazard hazard, std::size_t section, double time, double value, double limit, double sign = 1,
             double within = 0) {
    constexpr double negligible = 1e-8;  // neither above nor below, by rounding
    constexpr double slack = 1e-6;       // s; reported spans are right to 1e-7
    const double excess = sign * (value - limit);
    if (!(excess > 0)) return;
    bool is_reported = false;
    for (Reported& one : reported_[{hazard, section, std::nullopt, {}, limit}]) {
      if (one.span.start > time + slack || time - within > one.span.end + slack) continue;
      is_reported = one.confirmed = true;
      // By rounding the sample may lie just outside the span.
      one.sampled_excess = std::max(one.sampled_excess, sign * (value - one.worst.value));
    }
    if (excess <= negligible) return;
    ++result_.above;
    if (!is_reported) ++result_.missed;
  }

  [[nodiscard]] double clearance(const SampledArm& arm, const Place& place, double need) const {
    const std::size_t i = place.key.section;
    return place.key.other_section ? arm.clearance(i, *place.key.other_section, need)
                                   : arm.clearance(i, obstacles_[place.obstacle], need);
  }
  [[nodiscard]] Reported* reported(const Place& place, double time) {
    constexpr double slack = 1e-4;  // s, to which reported contacts are right
    for (Reported& one : reported_[place.key])
      if (one.span.start - slack <= time && time <= one.span.end + slack) return &one;
    return nullptr;
  }

  // What is not reported and nearer than `need`.
  [[nodiscard]] std::vector<std::size_t> near_contact(std::size_t k, double need) {
    const SampledArm arm(arm_, motion_.at(time_of(k)));
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (reported(places_[i], time_of(k)) == nullptr && clearance(arm, places_[i], need) < need)
        near.push_back(i);
    }
    return near;
  }

  // An arm without length has no clearances.
  void count_contacts(std::size_t k, const std::vector<std::size_t>& places) {
    const ArmState state = motion_.at(time_of(k));
    if (!is_possible(state)) return;
    const SampledArm arm(arm_, state);
    ++result_.contact_samples;
    for (const std::size_t i : places) {
      const double depth = -clearance(arm, places_[i], 0);
      if (depth <= 0) continue;
      Reported* one = reported(places_[i], time_of(k));
      if (one != nullptr) {
        one->confirmed = true;
        one->sampled_excess = std::max(one->sampled_excess, depth - one->worst.value);
      }
      if (depth <= 2e-6) continue;  // less counts as none
      ++result_.contacts;
      if (one == nullptr) ++result_.contacts_missed;
    }
  }

  const Arm& arm_;
  const std::vector<Obstacle>& obstacles_;
  const Motion& motion_;
  std::vector<std::string> caveats_;
  std::size_t samples_;
  SampledComparison& result_;
  std::map<Key, std::vector<Reported>> reported_;
  std::vector<Place> places_;
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
