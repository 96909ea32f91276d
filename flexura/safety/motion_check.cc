#include "flexura/safety/motion_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/shaped_motion.h"
#include "flexura/math/dense.h"
#include "flexura/safety/checked_motion.h"
#include "flexura/safety/contact_watch.h"
#include "flexura/safety/jumps.h"

namespace flexura {
namespace {

// Adds a note if the tip's Jacobian has a lower rank than in almost every other state of the arm.
void note_singular(const Arm& arm, const ArmState& state, double time, SafetyReport& report) {
  if (!is_possible(state)) return;
  std::vector<Eigen::Index> free;  // Columns of the Jacobian.
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const auto first = static_cast<Eigen::Index>(3 * i);
    free.push_back(first);
    if (arm.kind == ArmKind::spatial) free.push_back(first + 1);
    if (arm.sections[i].can_stretch()) free.push_back(first + 2);
  }
  const Eigen::MatrixXd velocities = tip_jacobian(arm, state).topRows<3>()(Eigen::all, free);
  const Eigen::VectorXd speeds = singular_values(velocities);
  const auto now = static_cast<std::size_t>((speeds.array() > 1e-9 * speeds.maxCoeff()).count());
  // The tip of one spatial section without stretch reaches only a surface.
  const std::size_t usual = std::min<std::size_t>(arm.kind == ArmKind::planar ? 2 : 3, free.size());
  if (now == usual) return;
  report.notes.push_back(
      fmt::format("{:.6g} s: singular: the tip Jacobian has rank {} of {}", time, now, usual));
}

std::vector<ContactWatch> contact_watches(const Arm& arm, const std::vector<Obstacle>& obstacles) {
  std::vector<ContactWatch> watches{ContactWatch(arm)};
  for (const Obstacle& obstacle : obstacles) watches.emplace_back(arm, obstacle);
  return watches;
}

// `before` is the state of the arm before the motion.
void check_one(const CheckedMotion& checked, const ArmState& before) {
  const Motion& motion = checked.motion();
  const ArmState first = motion.at(0);
  const double jump = largest_change(before, first);
  if (jump > smallest_jump && std::isfinite(jump)) {
    const std::size_t section = most_changed(before, first);
    checked.add_jump({0, 0}, section, changes_stretch(before, first, section), {0, jump});
  }
  if (!motion.rates(0, 0, motion.duration())) {
    check_sampled(checked);
  } else if (!is_possible(first)) {
    checked.add_impossible(0);
  } else if (!is_possible(motion.at(motion.duration()))) {
    checked.add_impossible(motion.duration());
  } else {
    check_bounded(checked);
  }
}

bool is_nowhere(const Violation& violation) { return violation.hazard == Hazard::not_finite; }

SafetyReport check_with(const Arm& arm, const std::vector<ContactWatch>& contacts, const ArmState& initial,
                        const std::vector<TimedMotion>& motions, double step, Progress* progress,
                        bool is_shape = false) {
  SafetyReport report;
  note_singular(arm, initial, 0, report);
  ArmState before = initial;
  for (std::size_t i = 0; i < motions.size() && report.is_complete; ++i) {
    const auto go_on = [&](double done) {
      if (progress == nullptr) return true;
      progress->update((static_cast<double>(i) + done) / static_cast<double>(motions.size()),
                       "check: " + motions[i].name);
      if (progress->is_cancelled()) report.is_complete = false;
      return report.is_complete;
    };
    const CheckedMotion checked{arm, contacts, motions[i], step, report, go_on, is_shape};
    check_one(checked, before);
    const Motion& motion = checked.motion();
    before = motion.at(motion.duration());
    note_singular(arm, before, motions[i].start + motion.duration(), report);
  }
  if (!report.is_complete) report.caveats.emplace_back("cancelled: the motion is not completely checked");
  report.sort();
  report.notes.erase(std::ranges::unique(report.notes).begin(), report.notes.end());
  return report;
}

}  // namespace

bool is_of_shape(Hazard hazard) {
  return hazard == Hazard::folding || hazard == Hazard::self_contact || hazard == Hazard::obstacle ||
         hazard == Hazard::not_finite;
}

bool is_possible(const ArmState& state) { return !impossible_section(state); }

std::optional<std::size_t> impossible_section(const ArmState& state) {
  for (std::size_t i = 0; i < state.bends.size(); ++i) {
    const double stretch = state.stretches[i];
    const bool is_bent = state.bends[i].norm() <= largest_bend;  // False if it is not a number.
    if (!is_bent || !std::isfinite(stretch) || stretch <= 0) return i;
  }
  return std::nullopt;
}

SafetyReport check_motions(const Arm& arm, const std::vector<Obstacle>& obstacles, const ArmState& initial,
                           const std::vector<TimedMotion>& motions, double step, Progress* progress) {
  return check_with(arm, contact_watches(arm, obstacles), initial, motions, step, progress);
}

SafetyReport check_motions(const ArmModel& model, const std::vector<Obstacle>& obstacles,
                           const ArmState& initial, const std::vector<TimedMotion>& motions, double step,
                           Progress* progress) {
  const Actuation& actuation = model.actuation();
  if (actuation.is_identity())
    return check_motions(model.shaped(), obstacles, initial, motions, step, progress);
  SafetyReport report = check_with(model.driven(), {}, initial, motions, step, progress);
  if (!report.is_complete) return report;
  std::erase_if(report.violations, [](const Violation& violation) {
    return is_of_shape(violation.hazard) && violation.hazard != Hazard::not_finite;
  });
  std::vector<TimedMotion> shaped;
  shaped.reserve(motions.size());
  for (const TimedMotion& motion : motions)
    shaped.push_back({shaped_motion(actuation, motion.motion), motion.start, motion.name});
  const SafetyReport of_shape = check_with(model.shaped(), contact_watches(model.shaped(), obstacles),
                                           actuation.shape(initial), shaped, step, progress, true);
  for (Violation violation : of_shape.violations) {
    if (!is_of_shape(violation.hazard)) continue;
    // If the command has no value, the shape has none either.
    if (violation.hazard == Hazard::not_finite && std::ranges::any_of(report.violations, is_nowhere))
      continue;
    if (violation.section) violation.section = actuation.section_of()[*violation.section];
    if (violation.other_section) violation.other_section = actuation.section_of()[*violation.other_section];
    report.violations.push_back(std::move(violation));
  }
  report.is_complete = of_shape.is_complete;
  if (!report.is_complete) report.caveats = of_shape.caveats;
  // Rates of a rod's shape are unknown, so that the shape is sampled.
  if (report.is_complete && !actuation.is_linear())
    report.caveats.insert(report.caveats.end(), of_shape.caveats.begin(), of_shape.caveats.end());
  report.sort();
  return report;
}

}  // namespace flexura
