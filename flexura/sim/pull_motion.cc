#include "flexura/sim/pull_motion.h"

#include <algorithm>
#include <utility>

namespace flexura {

PullMotion::PullMotion(std::size_t tendons, double horizon) : tendons_(tendons), horizon_(horizon) {}

void PullMotion::command(double time, std::vector<double> target, double end) {
  Plan plan{time, std::max(time, end), std::vector<double>(tendons_, 0.0), std::move(target)};
  add_to(plan.from, time);
  plans_.push_back(std::move(plan));
  while (plans_.size() > 1 && plans_[1].start <= time - horizon_) plans_.pop_front();
}

void PullMotion::back(double time, double end) {
  // Shortcut: most arms are never pulled this way, and are commanded a thousand times a second.
  const auto is_zero = [](double pulled) { return pulled == 0; };
  if (plans_.empty() || (std::ranges::all_of(plans_.back().to, is_zero) && plans_.back().end <= time)) return;
  command(time, std::vector<double>(tendons_, 0.0), end);
}

void PullMotion::halt(double time) {
  if (plans_.empty()) return;
  std::vector<double> here(tendons_, 0.0);
  add_to(here, time);
  command(time, std::move(here), time);
}

void PullMotion::add_to(std::vector<double>& pulled, double time) const {
  const auto after = std::ranges::upper_bound(plans_, time, {}, &Plan::start);
  if (after == plans_.begin()) return;
  const Plan& plan = *(after - 1);
  const double part = time < plan.end ? (time - plan.start) / (plan.end - plan.start) : 1;
  for (std::size_t i = 0; i < tendons_; ++i)
    pulled[i] += part < 1 ? plan.from[i] + part * (plan.to[i] - plan.from[i]) : plan.to[i];
}

}  // namespace flexura
