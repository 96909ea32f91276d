#include "flexura/safety/motion_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "flexura/safety/contact_watch.h"
#include "flexura/safety/jumps.h"
#include "flexura/safety/limits.h"
#include "flexura/safety/sampled_spans.h"
#include "flexura/safety/singular.h"
#include "flexura/safety/spans.h"

namespace flexura {
namespace {

constexpr double time_resolution = 1e-7;     // s, of limits
constexpr double contact_resolution = 1e-4;  // s
// How many intervals are looked into for one limit, and for one thing the arm may touch, which takes longer;
// and for every step of the clock.
constexpr std::size_t limit_intervals = 200'000;
constexpr std::size_t contact_intervals = 5'000;
constexpr std::size_t intervals_of_step = 4;

class MotionCheck {
 public:
  MotionCheck(const Arm& arm, const std::vector<ContactWatch>& contacts, const TimedMotion& timed,
              double step, SafetyReport& report)
      : arm_(arm),
        contacts_(contacts),
        motion_(*timed.motion),
        start_(timed.start),
        task_(timed.name),
        step_(step),
        report_(report) {}

  void check_bounded() {
    for (const LimitWatch& watch : limit_watches(arm_)) {
      const auto value = [&](double t) { return watch.sign * watch.value(motion_.at(t)); };
      const auto rate = [&](double a, double b) { return watch.rate(motion_, a, b); };
      add(watch.hazard, watch.section, watch.limit, watch.sign, watch.threshold(), with_rate(value, rate));
    }
    for (std::size_t i = 0; i < arm_.sections.size(); ++i) {
      const double limit = arm_.sections[i].max_bend_rate;
      if (!std::isfinite(limit)) continue;
      add(Hazard::bend_rate, i, limit, 1, limit_of_rate(limit), bend_rate(motion_, i));
    }
    for (std::size_t i = 0; i < arm_.sections.size(); ++i) {
      check_jumps(i, bend_rate(motion_, i));
      check_jumps(i, stretch_rate(motion_, i));
    }
    for (const ContactWatch& contact : contacts_) {
      const WatchedQuantity depth = contact.depth(motion_);
      const FoundSpans found = spans_above(contact_tolerance, depth, whole(),
                                           {.time = contact_resolution,
                                            .value = contact_motion,
                                            .most_intervals = most_intervals(contact_intervals)});
      for (const Span& span : found.spans) add_contact(contact, span);
      const std::string with = contact.hazard() == Hazard::obstacle ? contact.obstacle_name() : "itself";
      add_undecided("contact with " + with, found);
    }
  }

  void check_sampled() {
    const std::size_t impossible = first_impossible();
    if (impossible <= last_sample()) add_impossible(time_of(impossible));
    if (impossible > 0) {
      sample(impossible - 1);
      for (const Jump& jump : find_jumps(motion_, step_, time_of(impossible - 1))) add_jump(jump);
    }
    report_.caveats.push_back(fmt::format("{}: sampled every {:.6g} s: the law has no bound on its rates",
                                          span_text(whole(), start_), step_));
  }

  void add_impossible(double time) {
    report_.violations.push_back({.hazard = Hazard::not_finite,
                                  .start = start_ + time,
                                  .end = start_ + time,
                                  .worst_time = start_ + time,
                                  .section = impossible_section(motion_.at(time)),
                                  .name = task_});
  }

  void add_jump(const Jump& jump) { add_jump({jump.time, jump.time}, jump.section, {jump.time, jump.size}); }

 private:
  void add_jump(const Span& span, std::size_t section, const WorstValue& size) {
    report_.violations.push_back({.hazard = Hazard::jump,
                                  .start = start_ + span.start,
                                  .end = start_ + span.end,
                                  .worst_time = start_ + size.time,
                                  .section = section,
                                  .name = task_,
                                  .value = size.value});
  }

  // Where a law that knows its rates is faster than anything that moves: keyframes a moment apart.
  void check_jumps(std::size_t section, const WatchedQuantity& rate) {
    const SpanSearch search{.time = time_resolution,
                            .value = jump_rate * limit_tolerance,
                            .most_intervals = most_intervals(limit_intervals)};
    for (const Span& span : spans_above(jump_rate, rate, whole(), search).spans) {
      const ArmState before = motion_.at(span.start);
      const auto change = [&](double t) { return largest_change(before, motion_.at(t)); };
      const WorstValue size = worst_in(change, span);
      if (size.value > smallest_jump) add_jump(span, section, size);
    }
  }

  static double limit_of_rate(double limit) { return limit * (1 + limit_tolerance); }
  [[nodiscard]] Span whole() const { return {0, motion_.duration()}; }
  [[nodiscard]] std::size_t last_sample() const {
    return static_cast<std::size_t>(std::ceil(motion_.duration() / step_));
  }
  [[nodiscard]] double time_of(std::size_t k) const {
    return std::min(static_cast<double>(k) * step_, motion_.duration());
  }

  void add(Hazard hazard, std::size_t section, double limit, double sign, double threshold,
           const WatchedQuantity& quantity) {
    const FoundSpans found = spans_above(threshold, quantity, whole(),
                                         {.time = time_resolution,
                                          .value = std::abs(limit) * limit_tolerance,
                                          .most_intervals = most_intervals(limit_intervals)});
    add_undecided(fmt::format("section {}: {}", section + 1, name_of(hazard)), found);
    for (const Span& span : found.spans)
      add_limit(hazard, section, sign, limit, {span, worst_in(quantity.value, span)});
  }

  [[nodiscard]] std::size_t most_intervals(std::size_t at_least) const {
    return at_least + intervals_of_step * last_sample();
  }

  void add_undecided(const std::string& what, const FoundSpans& found) {
    if (!found.undecided) return;
    report_.caveats.push_back(
        fmt::format("{} undecided, {}: too near its limit to tell, sampled every {:.3g} s", what,
                    span_text(*found.undecided, start_), found.sampled_every));
  }

  void add_limit(Hazard hazard, std::size_t section, double sign, double limit,
                 const SampledSpans::Found& found) {
    report_.violations.push_back({.hazard = hazard,
                                  .start = start_ + found.span.start,
                                  .end = start_ + found.span.end,
                                  .worst_time = start_ + found.worst.time,
                                  .section = section,
                                  .value = sign * found.worst.value,
                                  .limit = limit});
  }

  // What touches in a span, of its ends and what lies evenly between: every section or pair with its depth
  // and its time, which is right to the distance of two samples; the deepest has the whole span.
  void add_contact(const ContactWatch& contact, const Span& span) {
    constexpr int samples = 100;
    const auto time_of_sample = [&](int k) {
      return k >= samples ? span.end : span.start + (span.end - span.start) * std::max(k, 0) / samples;
    };
    using Place = std::pair<std::size_t, std::optional<std::size_t>>;
    std::map<Place, Violation> found;
    for (int k = 0; k <= samples; ++k) {
      for (const Contact& now : contact.contacts(motion_.at(time_of_sample(k)))) {
        Violation& violation = found
                                   .try_emplace({now.section, now.other_section},
                                                Violation{.hazard = contact.hazard(),
                                                          .start = start_ + time_of_sample(k - 1),
                                                          .section = now.section,
                                                          .other_section = now.other_section,
                                                          .name = contact.obstacle_name()})
                                   .first->second;
        violation.end = start_ + time_of_sample(k + 1);
        if (-now.clearance <= violation.value) continue;
        violation.value = -now.clearance;
        violation.worst_time = start_ + time_of_sample(k);
      }
    }
    const auto depth = [](const auto& one) { return one.second.value; };
    const auto deepest = std::ranges::max_element(found, {}, depth);
    if (deepest == found.end()) {  // between two samples only, and hardly
      found.try_emplace({0, std::nullopt}, Violation{.hazard = contact.hazard(),
                                                     .worst_time = start_ + (span.start + span.end) / 2,
                                                     .name = contact.obstacle_name()});
    }
    Violation& whole = (deepest == found.end() ? found.begin() : deepest)->second;
    whole.start = start_ + span.start;
    whole.end = start_ + span.end;
    for (auto& [place, violation] : found) report_.violations.push_back(std::move(violation));
  }

  // Every step of the clock up to `last`.
  void sample(std::size_t last) {
    const std::vector<LimitWatch> watches = limit_watches(arm_);
    std::vector<SampledSpans> limits(watches.size());
    std::vector<SampledSpans> rates(arm_.sections.size());
    std::vector<SampledSpans> contacts(contacts_.size());
    ArmState before;
    for (std::size_t k = 0; k <= last; ++k) {
      const double t = time_of(k);
      const ArmState state = motion_.at(t);
      for (std::size_t w = 0; w < watches.size(); ++w) {
        const double value = watches[w].sign * watches[w].value(state);
        limits[w].sample(k, t, value, value > watches[w].threshold());
      }
      for (std::size_t i = 0; k > 0 && i < rates.size(); ++i) {
        const double rate = (state.bends[i] - before.bends[i]).norm() / (t - time_of(k - 1));
        rates[i].sample(k, t, rate, rate > limit_of_rate(arm_.sections[i].max_bend_rate));
      }
      for (std::size_t c = 0; c < contacts_.size(); ++c) {
        const double depth = -contacts_[c].contact(state, 0).clearance;
        contacts[c].sample(k, t, depth, depth > contact_tolerance);
      }
      before = state;
    }
    for (std::size_t w = 0; w < watches.size(); ++w) {
      for (const auto& found : limits[w].spans())
        add_limit(watches[w].hazard, watches[w].section, watches[w].sign, watches[w].limit, found);
    }
    for (std::size_t i = 0; i < rates.size(); ++i) {
      for (const auto& found : rates[i].spans())
        add_limit(Hazard::bend_rate, i, 1, arm_.sections[i].max_bend_rate, found);
    }
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      for (const auto& found : contacts[c].spans()) add_contact(contacts_[c], found.span);
    }
  }

  // The step from which on the law has no possible value, or the one after the last.
  [[nodiscard]] std::size_t first_impossible() const {
    std::size_t k = 0;
    while (k <= last_sample() && is_possible(motion_.at(time_of(k)))) ++k;
    return k;
  }

  const Arm& arm_;
  const std::vector<ContactWatch>& contacts_;
  const Motion& motion_;
  double start_;
  const std::string& task_;
  double step_;
  SafetyReport& report_;
};

void note_singular(const Arm& arm, const ArmState& state, double time, SafetyReport& report) {
  if (!is_possible(state)) return;
  const TipFreedom freedom = tip_freedom(arm, state);
  if (freedom.now == freedom.usual) return;
  report.notes.push_back(fmt::format("{:.6g} s: singular pose: the tip can set out in {} of {} dimensions",
                                     time, freedom.now, freedom.usual));
}

}  // namespace

bool is_possible(const ArmState& state) { return !impossible_section(state); }

std::optional<std::size_t> impossible_section(const ArmState& state) {
  for (std::size_t i = 0; i < state.bends.size(); ++i) {
    const double stretch = state.stretches[i];
    if (!state.bends[i].allFinite() || !std::isfinite(stretch) || stretch <= 0) return i;
  }
  return std::nullopt;
}

SafetyReport check_motions(const Arm& arm, const std::vector<Obstacle>& obstacles, const ArmState& initial,
                           const std::vector<TimedMotion>& motions, double step) {
  SafetyReport report;
  std::vector<ContactWatch> contacts{ContactWatch(arm)};
  for (const Obstacle& obstacle : obstacles) contacts.emplace_back(arm, obstacle);
  note_singular(arm, initial, 0, report);
  ArmState before = initial;
  for (const TimedMotion& timed : motions) {
    const Motion& motion = *timed.motion;
    MotionCheck check(arm, contacts, timed, step, report);
    const double jump = largest_change(before, motion.at(0));
    if (jump > smallest_jump && std::isfinite(jump))
      check.add_jump({0, jump, most_changed(before, motion.at(0))});
    if (motion.rates(0, 0, motion.duration())) {
      if (is_possible(motion.at(0))) {
        check.check_bounded();
      } else {
        check.add_impossible(0);
      }
    } else {
      check.check_sampled();
    }
    before = motion.at(motion.duration());
    note_singular(arm, before, timed.start + motion.duration(), report);
  }
  report.sort();
  report.notes.erase(std::ranges::unique(report.notes).begin(), report.notes.end());
  return report;
}

}  // namespace flexura
