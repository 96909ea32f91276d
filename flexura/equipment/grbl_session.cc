#include "flexura/equipment/grbl_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace flexura {
namespace {

constexpr int tries = 3;
constexpr double slice = 0.02;           // s; how soon a wait sees an interrupt.
constexpr std::size_t most_said = 1024;  // Messages that are kept.

}  // namespace

PortFault GrblSession::silent(std::string_view what) const {
  return {FaultKind::link_lost,
          fmt::format("{}: the controller does not answer {}: check its cable and its power", link_.name(),
                      what)};
}

PortFault GrblSession::interrupted() const {
  return {FaultKind::refused, link_.name() + ": halted during a request"};
}

std::size_t GrblSession::unanswered() const {
  return std::accumulate(pending_.begin(), pending_.end(), std::size_t{0});
}

CommandOutcome GrblSession::act(char byte) { return link_.write(std::string_view(&byte, 1)); }

CommandOutcome GrblSession::interrupt(char byte) {
  const std::scoped_lock lock(sending_);
  ++interrupts_;
  return act(byte);
}

CommandOutcome GrblSession::send(const std::string& line) {
  const std::scoped_lock lock(sending_);
  if (is_interrupted()) return interrupted();
  pending_.push_back(line.size());
  auto sent = link_.write(line);
  if (!sent) is_out_of_step_ = true;  // A part of the line may have been sent.
  return sent;
}

void GrblSession::take(std::string_view bytes) {
  for (const std::string& line : lines_.add(bytes)) take(parse_grbl(line));
}

void GrblSession::take(GrblMessage message) {
  const auto answer = [&](int error) {
    if (mark_ != Mark::none) {
      if (mark_ == Mark::seen) mark_ = Mark::answered;
      return;
    }
    if (pending_.empty()) {
      is_out_of_step_ = true;  // An answer came twice, or late.
      return;
    }
    pending_.pop_front();
    answers_.push_back(error);
  };
  if (auto* const status = std::get_if<GrblStatus>(&message)) {
    status_ = std::move(*status);
  } else if (std::holds_alternative<GrblOk>(message)) {
    answer(0);
  } else if (const auto* const error = std::get_if<GrblError>(&message)) {
    answer(std::max(error->code, 1));
  } else if (const auto* const alarm = std::get_if<GrblAlarm>(&message)) {
    alarm_ = alarm->code;
  } else if (std::holds_alternative<GrblBanner>(message)) {
    has_restarted_ = true;
    pending_.clear(), answers_.clear();
  } else if (std::holds_alternative<GrblUnknown>(message)) {
    is_out_of_step_ = true;  // It may have been an answer.
  } else {
    const auto* const feedback = std::get_if<GrblFeedback>(&message);
    if (mark_ == Mark::awaited && feedback != nullptr && feedback->type == "GC") mark_ = Mark::seen;
    if (said_.size() < most_said) said_.push_back(std::move(message));
  }
}

Outcome<bool> GrblSession::wait(double timeout, const std::function<bool()>& is_done) {
  const double end = clock_.now() + timeout;
  for (;;) {
    if (is_done()) return true;
    if (is_interrupted()) return interrupted();
    const double left = end - clock_.now();
    if (!(left > 0)) return false;
    const auto bytes = link_.read(std::min(left, slice));
    if (!bytes) return *bytes.fault();
    take(bytes.value());
  }
}

CommandOutcome GrblSession::drain() {
  for (int i = 0; i < tries; ++i) {
    const auto bytes = link_.read(0);
    if (!bytes) return *bytes.fault();
    if (bytes.value().empty()) break;
    take(bytes.value());
  }
  return Accepted{};
}

Outcome<GrblAnswer> GrblSession::ask(const std::string& line, double timeout) {
  if (is_out_of_step_) {
    const auto outcome = resynchronize();
    if (!outcome) return *outcome.fault();
  }
  answers_.clear(), said_.clear();
  const auto sent = send(line);
  if (!sent) return *sent.fault();
  const auto done = wait(timeout, [&] { return !answers_.empty() || has_restarted_; });
  if (!done) {
    is_out_of_step_ = true;
    return *done.fault();
  }
  if (!done.value() || answers_.empty()) {
    is_out_of_step_ = true;
    if (!done.value()) return silent("a line");
    return PortFault{FaultKind::link_lost,
                     link_.name() + ": the controller has restarted: home it or set its position"};
  }
  return GrblAnswer{answers_.front(), std::exchange(said_, {})};
}

Outcome<int> GrblSession::stream(std::span<const std::string> lines) {
  if (is_out_of_step_) {
    const auto outcome = resynchronize();
    if (!outcome) return *outcome.fault();
  }
  answers_.clear(), said_.clear();
  int error = 0;
  const auto wait_for = [&](const std::function<bool()>& is_done) -> CommandOutcome {
    while (!is_done()) {
      const std::size_t before = pending_.size();
      const auto done = wait(answer_timeout_, [&] { return pending_.size() != before; });
      if (done && done.value()) continue;
      is_out_of_step_ = true;
      return done ? silent("a line") : *done.fault();
    }
    return Accepted{};
  };
  for (const std::string& line : lines) {
    const auto room = wait_for([&] { return pending_.empty() || unanswered() + line.size() <= window_; });
    if (!room) return *room.fault();
    const auto sent = send(line);
    if (!sent) return *sent.fault();
  }
  const auto all = wait_for([&] { return pending_.empty(); });
  if (!all) return *all.fault();
  for (const int one : answers_)
    if (error == 0) error = one;
  return error;
}

// The answer to $G is the ok after its [GC:...]; those before it belong to earlier lines.
CommandOutcome GrblSession::resynchronize() {
  for (int i = 0; i < tries; ++i) {
    lines_.clear();
    mark_ = Mark::awaited;
    // The first end of line completes a line whose end was lost.
    const auto sent = send("\n$G\n");
    const auto done =
        sent ? wait(answer_timeout_, [&] { return mark_ == Mark::answered; }) : Outcome<bool>(*sent.fault());
    mark_ = Mark::none;
    pending_.clear(), answers_.clear(), said_.clear();
    is_out_of_step_ = !done || !done.value();
    if (!done) return *done.fault();
    if (done.value()) return Accepted{};
  }
  return silent("$G");
}

CommandOutcome GrblSession::listen(double duration) {
  const auto done = wait(duration, [] { return false; });
  if (!done) return *done.fault();
  return Accepted{};
}

Outcome<GrblStatus> GrblSession::status(bool is_urgent) {
  for (int i = 0; i < tries; ++i) {
    if (!is_urgent && (i > 0 || is_out_of_step_)) {
      // A late report must not be taken for the next one.
      const auto outcome = resynchronize();
      if (!outcome && i > 0) return *outcome.fault();
    }
    const auto drained = drain();
    if (!drained) return *drained.fault();
    status_.reset();
    const auto sent = act(grbl::ask_status);
    if (!sent) return *sent.fault();
    const auto done = wait(answer_timeout_, [&] { return status_.has_value(); });
    if (!done) return *done.fault();
    if (done.value()) return *std::exchange(status_, std::nullopt);
    is_out_of_step_ = true;
  }
  return silent("\"?\"");
}

CommandOutcome GrblSession::reset(double timeout) {
  const double end = clock_.now() + timeout;
  has_restarted_ = false;
  for (double left = timeout; left > 0; left = end - clock_.now()) {
    // A board that is starting does not hear the first resets.
    auto sent = act(grbl::reset);
    if (!sent) return sent;
    const auto done = wait(std::min(left, 4 * answer_timeout_), [&] { return has_restarted_; });
    if (!done) return *done.fault();
    if (!done.value()) continue;
    is_out_of_step_ = true;  // A second banner may follow.
    const auto outcome = resynchronize();
    has_restarted_ = false;
    return outcome;
  }
  return PortFault{
      FaultKind::link_lost,
      fmt::format("{}: no controller with Grbl answers within {:g} s: check the cable, the power and "
                  "the speed of the line",
                  link_.name(), timeout)};
}

}  // namespace flexura
