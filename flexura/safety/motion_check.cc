#include "flexura/safety/motion_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "flexura/safety/spans.h"

namespace flexura {
namespace {

// Limits are typed in degrees and bends computed in radians: a bend on its limit is not beyond it.
constexpr double limit_tolerance = 1e-9;
constexpr double time_resolution = 1e-7;  // s
constexpr double smallest_jump = 1e-6;    // rad, or a factor of stretch

// One quantity of one section under a limit: what `spans_above` needs, and how to say it.
struct Watch {
  Hazard hazard;
  double limit;              // what is reported
  double sign = 1;           // -1: the value must not fall below the limit
  WatchedQuantity quantity;  // the value at a time within the motion, and its rate bound
};

SectionRates rates_of(const Motion& motion, std::size_t section, double start, double end) {
  return motion.rates(section, start, end).value_or(SectionRates{});
}

double curvature_times_radius(const Section& section, const ArmState& state, std::size_t i) {
  return state.bends[i].norm() * std::max(section.radius[0], section.radius[1]) /
         (section.length * state.stretches[i]);
}

// |d/dt (bend r / (length stretch))| where the bend stays below and the stretch above what they are in the
// middle and the rates allow.
double folding_rate(const Section& section, const Motion& motion, std::size_t i, double start, double end) {
  const SectionRates rates = rates_of(motion, i, start, end);
  const ArmState middle = motion.at((start + end) / 2);
  const double half = (end - start) / 2;
  const double bend = middle.bends[i].norm() + rates.bend * half;
  const double stretch = middle.stretches[i] - rates.stretch * half;
  if (stretch <= 0) return std::numeric_limits<double>::infinity();
  const double scale = std::max(section.radius[0], section.radius[1]) / section.length;
  return scale * (rates.bend / stretch + bend * rates.stretch / (stretch * stretch));
}

std::vector<Watch> watches_of(const Arm& arm, const Motion& motion, std::size_t i) {
  const Section& section = arm.sections[i];
  const auto bend_rate = [&motion, i](double a, double b) { return rates_of(motion, i, a, b).bend; };
  const auto stretch_rate = [&motion, i](double a, double b) { return rates_of(motion, i, a, b).stretch; };
  std::vector<Watch> watches;
  if (std::isfinite(section.max_bend)) {
    watches.push_back({Hazard::bend,
                       section.max_bend,
                       1,
                       {[&motion, i](double t) { return motion.at(t).bends[i].norm(); }, bend_rate}});
  }
  watches.push_back({Hazard::stretch,
                     section.stretch_limits[1],
                     1,
                     {[&motion, i](double t) { return motion.at(t).stretches[i]; }, stretch_rate}});
  watches.push_back({Hazard::stretch,
                     section.stretch_limits[0],
                     -1,
                     {[&motion, i](double t) { return -motion.at(t).stretches[i]; }, stretch_rate}});
  watches.push_back(
      {Hazard::folding,
       1,
       1,
       {[&motion, &section, i](double t) { return curvature_times_radius(section, motion.at(t), i); },
        [&motion, &section, i](double a, double b) { return folding_rate(section, motion, i, a, b); }}});
  return watches;
}

double threshold(const Watch& watch) {
  return watch.sign * watch.limit + std::abs(watch.limit) * limit_tolerance;
}

// The worst value in a span, of its ends and what lies evenly between.
double worst(const std::function<double(double)>& value, const Span& span) {
  constexpr int samples = 200;
  double most = -std::numeric_limits<double>::infinity();
  for (int k = 0; k <= samples; ++k) {
    most = std::max(most, value(span.start + (span.end - span.start) * k / samples));
  }
  return most;
}

// Spans whose samples are above the limit, each sample standing for the time up to the next.
std::vector<Span> sampled_spans(double limit, const std::function<double(double)>& value, double duration,
                                double step) {
  std::vector<Span> spans;
  const auto count = static_cast<std::size_t>(std::ceil(duration / step));
  for (std::size_t k = 0; k <= count; ++k) {
    const double t = std::min(static_cast<double>(k) * step, duration);
    if (!(value(t) > limit)) continue;
    if (!spans.empty() && spans.back().end >= t - 1.5 * step) {
      spans.back().end = t;
    } else {
      spans.push_back({t, t});
    }
  }
  return spans;
}

class MotionCheck {
 public:
  MotionCheck(const Arm& arm, const TimedMotion& timed, double step, SafetyReport& report)
      : arm_(arm), motion_(*timed.motion), start_(timed.start), step_(step), report_(report) {}

  void check_bounded() {
    for (std::size_t i = 0; i < arm_.sections.size(); ++i) {
      for (const Watch& watch : watches_of(arm_, motion_, i)) {
        add(watch, i, spans_above(threshold(watch), watch.quantity, whole(), time_resolution));
      }
      check_rate(i);
    }
  }

  void check_sampled() {
    if (const auto t = first_not_finite()) {
      report_.violations.push_back({Hazard::not_finite, start_ + *t, start_ + *t, std::nullopt, 0, 0});
      return;
    }
    for (std::size_t i = 0; i < arm_.sections.size(); ++i) {
      for (const Watch& watch : watches_of(arm_, motion_, i)) {
        add(watch, i, sampled_spans(threshold(watch), watch.quantity.value, motion_.duration(), step_));
      }
      check_sampled_rate(i);
    }
    find_jumps();
    report_.caveats.push_back(
        fmt::format("{:.6g} s to {:.6g} s: sampled every {:.6g} s: the law has no bound on its rates", start_,
                    start_ + motion_.duration(), step_));
  }

 private:
  [[nodiscard]] Span whole() const { return {0, motion_.duration()}; }

  void add(const Watch& watch, std::size_t section, const std::vector<Span>& spans) {
    for (const Span& span : spans) {
      report_.violations.push_back({watch.hazard, start_ + span.start, start_ + span.end, section,
                                    watch.sign * worst(watch.quantity.value, span), watch.limit});
    }
  }

  // A rate has no rate bound of its own. Its own bound over ever shorter intervals comes down to it.
  void check_rate(std::size_t i) {
    const double limit = arm_.sections[i].max_bend_rate;
    if (!std::isfinite(limit)) return;
    const auto bound = [&](const Span& span) { return rates_of(motion_, i, span.start, span.end).bend; };
    std::vector<Span> found;
    std::vector<Span> open{whole()};
    double most = 0;
    while (!open.empty()) {
      const Span span = open.back();
      open.pop_back();
      const double rate = bound(span);
      if (rate <= limit * (1 + limit_tolerance)) continue;
      if (span.end - span.start > std::max(time_resolution, motion_.duration() * 1e-4)) {
        const double middle = (span.start + span.end) / 2;
        open.push_back({middle, span.end});
        open.push_back({span.start, middle});
        continue;
      }
      if (!found.empty() && found.back().end >= span.start) {
        found.back().end = span.end;
        most = std::max(most, rate);
      } else {
        flush_rate(i, found, most);
        found = {span};
        most = rate;
      }
    }
    flush_rate(i, found, most);
  }

  void flush_rate(std::size_t i, const std::vector<Span>& found, double most) {
    if (found.empty()) return;
    report_.violations.push_back({Hazard::bend_rate, start_ + found.back().start, start_ + found.back().end,
                                  i, most, arm_.sections[i].max_bend_rate});
  }

  void check_sampled_rate(std::size_t i) {
    const double limit = arm_.sections[i].max_bend_rate;
    if (!std::isfinite(limit)) return;
    const auto rate = [&](double t) {
      const double next = std::min(t + step_, motion_.duration());
      return next > t ? (motion_.at(next).bends[i] - motion_.at(t).bends[i]).norm() / (next - t) : 0.0;
    };
    const Watch watch{Hazard::bend_rate, limit, 1, {rate, {}}};
    add(watch, i, sampled_spans(threshold(watch), rate, motion_.duration(), step_));
  }

  [[nodiscard]] std::optional<double> first_not_finite() const {
    const auto count = static_cast<std::size_t>(std::ceil(motion_.duration() / step_));
    for (std::size_t k = 0; k <= count; ++k) {
      const double t = std::min(static_cast<double>(k) * step_, motion_.duration());
      const ArmState state = motion_.at(t);
      for (std::size_t i = 0; i < state.bends.size(); ++i) {
        if (!state.bends[i].allFinite() || !std::isfinite(state.stretches[i]) || state.stretches[i] <= 0)
          return t;
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] double change(double a, double b) const;
  void find_jumps();

  const Arm& arm_;
  const Motion& motion_;
  double start_;
  double step_;
  SafetyReport& report_;
};

double state_distance(const ArmState& a, const ArmState& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.bends.size(); ++i) {
    most = std::max({most, (a.bends[i] - b.bends[i]).norm(), std::abs(a.stretches[i] - b.stretches[i])});
  }
  return most;
}

double MotionCheck::change(double a, double b) const { return state_distance(motion_.at(a), motion_.at(b)); }

// Where the state changes much more in one step than in the steps beside it, the step is halved towards the
// larger change: a jump keeps its size, what is only fast does not.
void MotionCheck::find_jumps() {
  const auto count = static_cast<std::size_t>(std::ceil(motion_.duration() / step_));
  const auto time = [&](std::size_t k) {
    return std::min(static_cast<double>(k) * step_, motion_.duration());
  };
  std::vector<double> changes;
  for (std::size_t k = 0; k < count; ++k) changes.push_back(change(time(k), time(k + 1)));
  for (std::size_t k = 0; k < count; ++k) {
    const double before = k > 0 ? changes[k - 1] : 0;
    const double after = k + 1 < count ? changes[k + 1] : 0;
    if (changes[k] < smallest_jump || changes[k] < 4 * std::max(before, after)) continue;
    double a = time(k);
    double b = time(k + 1);
    constexpr int halvings = 40;
    for (int n = 0; n < halvings; ++n) {
      const double middle = (a + b) / 2;
      (change(a, middle) > change(middle, b) ? b : a) = middle;
    }
    const double size = change(a, b);
    if (size > std::max(smallest_jump, changes[k] / 4)) {
      report_.violations.push_back({Hazard::jump, start_ + b, start_ + b, std::nullopt, size, 0});
    }
  }
}

}  // namespace

SafetyReport check_motions(const Arm& arm, const ArmState& initial, const std::vector<TimedMotion>& motions,
                           double step) {
  SafetyReport report;
  ArmState before = initial;
  for (const TimedMotion& timed : motions) {
    const Motion& motion = *timed.motion;
    MotionCheck check(arm, timed, step, report);
    if (motion.rates(0, 0, motion.duration())) {
      check.check_bounded();
    } else {
      check.check_sampled();
    }
    const double jump = state_distance(before, motion.at(0));
    if (jump > smallest_jump)
      report.violations.push_back({Hazard::jump, timed.start, timed.start, std::nullopt, jump, 0});
    before = motion.at(motion.duration());
  }
  const auto order = [](const Violation& v) { return std::pair(v.start, v.section.value_or(0)); };
  std::ranges::stable_sort(report.violations, {}, order);
  return report;
}

}  // namespace flexura
