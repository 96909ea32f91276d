#include <fmt/format.h>

#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "flexura/safety/checked_motion.h"
#include "flexura/safety/jumps.h"

namespace flexura {
namespace {

// Share of a check's progress up to the end of the samples; the search for jumps has the rest.
constexpr double samples_share = 0.9;

// Spans that grow with samples: consecutive steps form one span.
class SampledSpans {
 public:
  struct Found {
    Span span;
    WorstValue worst;
  };

  // Adds a value above its limit at a step later than all previous ones: the value for the time `span`, as of
  // its end.
  void add(std::size_t step, const Span& span, double value) {
    if (spans_.empty() || last_step_ + 1 < step) spans_.push_back({span, {span.end, value}});
    last_step_ = step;
    Found& found = spans_.back();
    found.span.end = span.end;
    if (value > found.worst.value) found.worst = {span.end, value};
  }
  [[nodiscard]] const std::vector<Found>& spans() const { return spans_; }

 private:
  std::vector<Found> spans_;
  std::size_t last_step_ = 0;
};

class SampledCheck {
 public:
  explicit SampledCheck(const CheckedMotion& checked)
      : checked_(checked),
        times_(checked.clock_times()),
        watches_(limit_watches(checked.arm)),
        limits_(watches_.size()),
        bend_rates_(checked.arm.sections.size()),
        stretch_rates_(checked.arm.sections.size()),
        contacts_(checked.contacts.size()) {}

  void run() {
    const bool is_short = times_.size() <= 2;
    checked_.report.caveats.push_back(fmt::format(
        "{}: sampled {}: no bound on the rates of the motion is known",
        span_text(checked_.whole(), checked_.timed.start),
        is_short ? "only at its start and its end" : fmt::format("every {:.6g} s", checked_.step)));
    std::optional<double> last_possible;
    std::optional<ArmState> before;
    for (std::size_t k = 0; k < times_.size(); ++k) {
      const double time = times_[k];
      ArmState state = checked_.motion().at(time);
      if (!is_possible(state)) {
        checked_.add_impossible(time);
        break;
      }
      const double share = checked_.is_shape ? 1 : samples_share;
      if (!checked_.go_on(share * time / (checked_.motion().duration() + checked_.step))) break;
      look_at(k, state);
      if (before) look_at_rates(k, *before, state);
      last_possible = time;
      before = std::move(state);
    }
    add_found();
    if (!last_possible || !checked_.report.is_complete || checked_.is_shape) return;
    const auto go_on = [&](double done) {
      return checked_.go_on(samples_share + (1 - samples_share) * done);
    };
    for (const Jump& jump : find_jumps(checked_.motion(), checked_.step, *last_possible, go_on))
      checked_.add_jump({jump.time, jump.time}, jump.section, jump.is_of_stretch, {jump.time, jump.size});
  }

 private:
  void look_at(std::size_t k, const ArmState& state) {
    const double time = times_[k];
    for (std::size_t w = 0; w < watches_.size(); ++w) {
      const double value = watches_[w].sign * watches_[w].value(state);
      if (value > watches_[w].threshold()) limits_[w].add(k, {time, time}, value);
    }
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      for (const Contact& contact : checked_.contacts[c].contacts(state))
        contacts_[c][{contact.section, contact.other_section}].add(k, {time, time}, -contact.clearance);
    }
  }

  // Checks the mean rates since the previous step.
  void look_at_rates(std::size_t k, const ArmState& before, const ArmState& state) {
    const Span span{times_[k - 1], times_[k]};
    const double time = span.end - span.start;
    for (std::size_t i = 0; i < bend_rates_.size(); ++i) {
      const Section& section = checked_.arm.sections[i];
      const double bending = (state.bends[i] - before.bends[i]).norm() / time,
                   stretching = std::abs(state.stretches[i] - before.stretches[i]) / time;
      if (bending > threshold_of_rate(section.max_bend_rate)) bend_rates_[i].add(k, span, bending);
      if (stretching > threshold_of_rate(section.max_stretch_rate))
        stretch_rates_[i].add(k, span, stretching);
    }
  }

  void add_found() const {
    for (std::size_t w = 0; w < watches_.size(); ++w) {
      const LimitWatch& watch = watches_[w];
      add({.hazard = watch.hazard, .section = watch.section, .limit = watch.limit}, limits_[w], watch.sign);
    }
    for (std::size_t i = 0; i < bend_rates_.size(); ++i) {
      const Section& section = checked_.arm.sections[i];
      add({.hazard = Hazard::bend_rate, .section = i, .limit = section.max_bend_rate}, bend_rates_[i]);
      add({.hazard = Hazard::stretch_rate, .section = i, .limit = section.max_stretch_rate},
          stretch_rates_[i]);
    }
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      for (const auto& [place, found] : contacts_[c]) {
        const Contact where{.section = place.first, .other_section = place.second};
        add(contact_violation(checked_.contacts[c], where), found);
      }
    }
  }

  void add(const Violation& violation, const SampledSpans& spans, double sign = 1) const {
    for (const auto& [span, worst] : spans.spans()) checked_.add(violation, span, worst, sign);
  }

  using Place = std::pair<std::size_t, std::optional<std::size_t>>;

  const CheckedMotion& checked_;
  std::vector<double> times_;  // Times of the steps, in the motion's time.
  std::vector<LimitWatch> watches_;
  std::vector<SampledSpans> limits_;
  std::vector<SampledSpans> bend_rates_, stretch_rates_;
  std::vector<std::map<Place, SampledSpans>> contacts_;
};

}  // namespace

void check_sampled(const CheckedMotion& checked) { SampledCheck(checked).run(); }

}  // namespace flexura
