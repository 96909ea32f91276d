#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/safety/limits.h"
#include "flexura/safety/motion_check.h"
#include "tests/support/arms.h"
#include "tests/support/motions.h"

namespace flexura {

/// What a comparison of checks with dense samples came to.
struct SampledComparison {
  std::size_t motions = 0;
  std::size_t samples = 0;  ///< Of all motions together.
  std::size_t spans = 0;    ///< Violations that the check reported.
  std::size_t above = 0;    ///< Values above their limit in the samples.
  std::size_t missed = 0;   ///< Of these, outside every reported span.
  std::size_t refuted = 0;  ///< Spans longer than two samples without one.
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

namespace sampled_check {

inline bool is_reported(const SafetyReport& report, Hazard hazard, std::size_t section, double time) {
  for (const Violation& v : report.violations) {
    if (v.hazard == hazard && v.section == section && v.start <= time + 1e-6 && time <= v.end + 1e-6)
      return true;
  }
  return false;
}

// Holds a check against samples of the motion. Values that are less than a rounding above their limit are
// neither above nor below it.
inline void compare(const Arm& arm, const Motion& motion, const SafetyReport& report, std::size_t samples,
                    SampledComparison& result) {
  constexpr double doubtful = 1e-8;
  const std::vector<LimitWatch> watches = limit_watches(arm);
  std::vector<bool> confirmed(report.violations.size(), false);
  const auto above = [&](Hazard hazard, std::size_t section, double time, double value, double limit) {
    if (value <= limit) return;
    for (std::size_t i = 0; i < confirmed.size(); ++i) {
      const Violation& v = report.violations[i];
      if (v.hazard == hazard && v.section == section && v.start <= time && time <= v.end) confirmed[i] = true;
    }
    if (value <= limit + doubtful) return;
    ++result.above;
    if (!is_reported(report, hazard, section, time)) ++result.missed;
  };
  ArmState before;
  const double h = motion.duration() / static_cast<double>(samples);
  for (std::size_t k = 0; k <= samples; ++k) {
    const double time = std::min(static_cast<double>(k) * h, motion.duration());
    const ArmState state = motion.at(time);
    for (const LimitWatch& w : watches)
      above(w.hazard, w.section, time, w.sign * w.value(state), w.sign * w.limit);
    for (std::size_t i = 0; k > 0 && i < arm.sections.size(); ++i) {
      // The mean rate from sample to sample, which some rate between them reaches; allow for its rounding.
      const double rate = (state.bends[i] - before.bends[i]).norm() / h - 1e-14 / h;
      bool reported = false;
      if (rate <= arm.sections[i].max_bend_rate) continue;
      for (std::size_t v = 0; v < confirmed.size(); ++v) {
        const Violation& found = report.violations[v];
        if (found.hazard != Hazard::bend_rate || found.section != i) continue;
        if (found.start <= time + 1e-6 && time - h <= found.end + 1e-6) confirmed[v] = reported = true;
      }
      ++result.above;
      if (!reported) ++result.missed;
    }
    before = state;
  }
  for (std::size_t i = 0; i < confirmed.size(); ++i) {
    const Violation& v = report.violations[i];
    if (v.hazard == Hazard::self_contact || v.hazard == Hazard::obstacle || v.hazard == Hazard::jump)
      continue;
    ++result.spans;
    if (!confirmed[i] && v.end - v.start > 2 * h) ++result.refuted;
  }
  result.samples += samples + 1;
}

}  // namespace sampled_check

/// Checks random motions of every kind on arms of random limits and holds each report against samples.
inline SampledComparison compare_with_samples(int cases, std::size_t samples) {
  SampledComparison result;
  for_random_cases(cases, [&](TestRandom& random) {
    Arm arm = random_arm(random);
    limit_randomly(random, arm);
    for (const MotionPtr& motion : random_motions(random, arm)) {
      const SafetyReport report = check_motions(arm, {}, motion->at(0), {{motion, 0}}, 0.02);
      sampled_check::compare(arm, *motion, report, samples, result);
      ++result.motions;
    }
    EXPECT_EQ(result.missed, 0u);
    EXPECT_EQ(result.refuted, 0u);
  });
  EXPECT_GT(result.above, samples);
  EXPECT_GT(result.spans, static_cast<std::size_t>(cases));
  return result;
}

}  // namespace flexura
