#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "flexura/safety/checked_motion.h"
#include "flexura/safety/jumps.h"

namespace flexura {
namespace {

constexpr double time_resolution = 1e-7;     // Smallest interval for limits, s.
constexpr double contact_resolution = 1e-4;  // Smallest interval for contacts, s.
// Largest numbers of intervals: for one limit, and for one section (or pair) and one object, which takes
// longer. Further numbers are per clock step, and for all contacts together.
constexpr std::size_t limit_intervals = 200'000;
constexpr std::size_t contact_intervals = 5'000;
constexpr std::size_t intervals_of_step = 4;
constexpr std::size_t all_contact_intervals = 20'000'000;
// Relative precision of a worst value, and precision of a depth, m. The `uncertain` values are the largest
// remaining errors, after too many intervals, that need no caveat.
constexpr double worst_part = 1e-6;
constexpr double uncertain_part = 1e-4;
constexpr double worst_depth = 1e-5;
constexpr double uncertain_depth = 1e-4;
// Most intervals for the worst values of one limit in all its spans, and for all worst depths. The least
// number is for one span.
constexpr std::size_t worst_intervals = 200'000;
constexpr std::size_t least_worst_intervals = 100;
constexpr std::size_t worst_depth_intervals = 50'000;
constexpr std::size_t least_worst_depth_intervals = 10;
// Fractions of a check's progress: after the limits, and before the worst values of contacts.
constexpr double limits_share = 0.3;
constexpr double contacts_share = 0.9;

WorstSearch worst_search(std::size_t spans) {
  const std::size_t each = worst_intervals / std::max<std::size_t>(spans, 1);
  return {.part = worst_part, .most_intervals = std::max(least_worst_intervals, each)};
}

WorstSearch worst_depth_search(std::size_t spans) {
  const std::size_t each = worst_depth_intervals / std::max<std::size_t>(spans, 1);
  return {.tolerance = worst_depth, .most_intervals = std::max(least_worst_depth_intervals, each)};
}

class BoundedCheck {
 public:
  explicit BoundedCheck(const CheckedMotion& checked) : checked_(checked) {}

  void run() {
    check_limits();
    if (checked_.report.is_complete) check_contacts();
  }

 private:
  void check_limits() {
    const Arm& arm = checked_.arm;
    const std::vector<LimitWatch> watches = limit_watches(arm);
    const auto jobs = static_cast<double>(watches.size() + arm.sections.size());
    double done = 0;
    for (const LimitWatch& watch : watches) {
      const auto value = [&](double t) { return watch.sign * watch.value(motion_.at(t)); };
      const auto rate = [&](double a, double b) { return watch.rate(motion_, a, b); };
      check_limit({.hazard = watch.hazard, .section = watch.section, .limit = watch.limit}, watch.sign,
                  watch.threshold(), with_rate(value, rate));
      if (!checked_.go_on(limits_share * ++done / jobs)) return;
    }
    const auto check_rate = [&](Hazard hazard, std::size_t i, double limit, const WatchedQuantity& rate) {
      if (std::isfinite(limit))
        check_limit({.hazard = hazard, .section = i, .limit = limit}, 1, threshold_of_rate(limit), rate);
    };
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      check_rate(Hazard::bend_rate, i, arm.sections[i].max_bend_rate, bend_rate(motion_, i));
      check_rate(Hazard::stretch_rate, i, arm.sections[i].max_stretch_rate, stretch_rate(motion_, i));
      check_jumps(i, false);
      check_jumps(i, true);
      if (!checked_.go_on(limits_share * ++done / jobs)) return;
    }
  }

  void check_limit(const Violation& violation, double sign, double threshold,
                   const WatchedQuantity& quantity) {
    const FoundSpans found = spans_above(threshold, quantity, checked_.whole(),
                                         limit_search(std::abs(violation.limit) * limit_tolerance));
    const std::string what = fmt::format("section {}: {}", *violation.section + 1, name_of(violation.hazard));
    if (found.undecided) report_undecided(what, *found.undecided, found.sampled_every, limit_intervals);
    const WorstSearch search = worst_search(found.spans.size());
    double uncertainty = 0;
    for (const Span& span : found.spans) {
      const WorstValue worst = worst_in(quantity, span, search);
      if (worst.uncertainty > uncertain_part * std::abs(worst.value))
        uncertainty = std::max(uncertainty, worst.uncertainty);
      checked_.add(violation, span, worst, sign);
    }
    if (uncertainty > 0) report_uncertain(what, violation.hazard, uncertainty);
  }

  // Finds spans in which a motion with known rates counts as a jump, for example between keyframes at almost
  // the same time.
  void check_jumps(std::size_t section, bool is_of_stretch) {
    const auto rate = is_of_stretch ? stretch_rate(motion_, section) : bend_rate(motion_, section);
    const FoundSpans found =
        spans_above(jump_rate, rate, checked_.whole(), limit_search(jump_rate * limit_tolerance));
    const WorstSearch search = worst_search(found.spans.size());
    for (const Span& span : found.spans) {
      const ArmState before = motion_.at(span.start);
      const auto change = [&](double t) {
        const ArmState now = motion_.at(t);
        return is_of_stretch ? std::abs(now.stretches[section] - before.stretches[section])
                             : (now.bends[section] - before.bends[section]).norm();
      };
      const auto change_rate = [&](double a, double b) {
        const SectionRates rates = rates_of(motion_, section, a, b);
        return is_of_stretch ? rates.stretch : rates.bend;
      };
      const WorstValue size = worst_in(with_rate(change, change_rate), span, search);
      if (size.value > smallest_jump) checked_.add_jump(span, section, is_of_stretch, size);
    }
  }

  void check_contacts() {
    const ContactDepths depths(checked_.arm, checked_.contacts, motion_);
    const auto searched = [&](double decided) {
      return checked_.go_on(limits_share + (contacts_share - limits_share) * decided);
    };
    const std::vector<FoundSpans> found = spans_above(contact_tolerance, depths, checked_.whole(),
                                                      {.time = contact_resolution,
                                                       .value = contact_motion,
                                                       .most_intervals = most_intervals(contact_intervals),
                                                       .most_together = all_contact_intervals,
                                                       .go_on = searched});
    if (!checked_.report.is_complete) return;
    report_undecided_contacts(depths, found);
    add_contacts(depths, found);
  }

  void add_contacts(const ContactDepths& depths, const std::vector<FoundSpans>& found) {
    std::size_t all = 0;
    for (const FoundSpans& one : found) all += one.spans.size();
    const WorstSearch search = worst_depth_search(all);
    std::vector<double> uncertainties(checked_.contacts.size());  // Per watch.
    double done = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto& [watch, first, last] = depths.part(i);
      const ContactWatch& contact = checked_.contacts[watch];
      for (const Span& span : found[i].spans) {
        const WorstValue worst = worst_in(depths.depth(i), span, search);
        uncertainties[watch] = std::max(uncertainties[watch], worst.uncertainty);
        checked_.add(contact_violation(contact, contact.place_of(first, last)), span, worst);
        const double share = ++done / static_cast<double>(all);
        if (!checked_.go_on(contacts_share + (1 - contacts_share) * share)) return;
      }
    }
    for (std::size_t watch = 0; watch < uncertainties.size(); ++watch) {
      const ContactWatch& contact = checked_.contacts[watch];
      if (uncertainties[watch] > uncertain_depth)
        report_uncertain(what_of(contact), contact.hazard(), uncertainties[watch]);
    }
  }

  static std::string what_of(const ContactWatch& contact) {
    return "contact with " + (contact.hazard() == Hazard::obstacle ? contact.obstacle_name() : "itself");
  }

  // Adds one line for all contacts of the arm with the same object.
  void report_undecided_contacts(const ContactDepths& depths, const std::vector<FoundSpans>& found) {
    std::vector<FoundSpans> of_watch(checked_.contacts.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!found[i].undecided) continue;
      FoundSpans& one = of_watch[depths.part(i).watch];
      if (!one.undecided) one.undecided = found[i].undecided;
      one.undecided->start = std::min(one.undecided->start, found[i].undecided->start);
      one.undecided->end = std::max(one.undecided->end, found[i].undecided->end);
      one.sampled_every = std::max(one.sampled_every, found[i].sampled_every);
    }
    for (std::size_t watch = 0; watch < of_watch.size(); ++watch) {
      const auto& [spans, undecided, sampled_every] = of_watch[watch];
      if (undecided)
        report_undecided(what_of(checked_.contacts[watch]), *undecided, sampled_every, contact_intervals);
    }
  }

  void report_undecided(const std::string& what, const Span& span, double sampled_every,
                        std::size_t intervals) {
    checked_.report.caveats.push_back(
        fmt::format("{} undecided, {}: the check needs more than {} intervals, therefore the motion is "
                    "sampled every {:.3g} s",
                    what, span_text(span, checked_.timed.start), most_intervals(intervals), sampled_every));
  }

  void report_uncertain(const std::string& what, Hazard hazard, double uncertainty) {
    checked_.report.caveats.push_back(fmt::format("{}, {}: the worst values may be larger by {}", what,
                                                  span_text(checked_.whole(), checked_.timed.start),
                                                  amount_text(hazard, uncertainty)));
  }

  [[nodiscard]] SpanSearch limit_search(double value) const {
    return {.time = time_resolution, .value = value, .most_intervals = most_intervals(limit_intervals)};
  }
  [[nodiscard]] std::size_t most_intervals(std::size_t at_least) const {
    return at_least + intervals_of_step * checked_.last_step();
  }

  const CheckedMotion& checked_;
  const Motion& motion_ = checked_.motion();
};

}  // namespace

void check_bounded(const CheckedMotion& checked) { BoundedCheck(checked).run(); }

}  // namespace flexura
