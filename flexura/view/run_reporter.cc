#include "flexura/view/run_reporter.h"

#include <cmath>
#include <cstddef>
#include <memory>

#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/store/json.h"
#include "flexura/view/extras.h"

namespace flexura {

void RunReporter::begin() {
  reported_fraction_ = reported_at_ = drawn_at_ = -1;
  reported_what_.clear();
  time_left_ = {}, began_.reset();
  measured_.clear();
  changes_ = 0, are_extras_known_ = true;
}

void RunReporter::report(RunLink& run, const RunLink::News& news, double clock, std::optional<double> now,
                         const std::set<ClientId>& clients) {
  // Spreads simultaneous events of a run over several ticks, so that a client that reads slowly is not
  // disconnected.
  constexpr std::size_t at_once = 8, all = 1000;
  for (const RunLink::Event& event : run.take_events(news.end ? all : at_once)) {
    send({Node::Table{{"type", {}, text_node("event")},
                      {"time", {}, {now.value_or(event.time), {}}},
                      {"level", {}, text_node(event.level)},
                      {"name", {}, text_node(event.name)},
                      {"text", {}, text_node(event.text)}},
          {}},
         clients);
  }
  report_extras(news, clock, now, clients);
  if (!news.end) {
    report_progress(news, clock, clients);
    return;
  }
  send({Node::Table{{"type", {}, text_node("progress")},
                    {"done", {}, {true, {}}},
                    {"outcome", {}, text_node(news.end->outcome)},
                    {"recording", {}, {!news.end->folder.empty(), {}}},
                    {"text", {}, text_node(news.end->text)}},
        {}},
       clients);
}

void RunReporter::report_progress(const RunLink::News& news, double clock,
                                  const std::set<ClientId>& clients) {
  constexpr double to_be_seen = 0.002, between = 0.25;  // Fraction of the whole; s between two texts.
  const bool has_moved = std::abs(news.fraction - reported_fraction_) >= to_be_seen;
  const bool reports_more = news.what != reported_what_ && clock - reported_at_ >= between;
  if (!has_moved && !reports_more) return;
  if (!began_) began_ = clock;
  const std::optional<double> left = time_left_.at(news.fraction, clock - *began_);
  reported_fraction_ = news.fraction, reported_what_ = news.what, reported_at_ = clock;
  send({Node::Table{{"type", {}, text_node("progress")},
                    {"what", {}, text_node(news.what)},
                    {"fraction", {}, {news.fraction, {}}},
                    {"left", {}, left ? Node{*left, {}} : Node{}}},
        {}},
       clients);
}

void RunReporter::report_extras(const RunLink::News& news, double clock, std::optional<double> now,
                                const std::set<ClientId>& clients) {
  constexpr double between = 0.04;  // In s; faster changes are not visible.
  const bool is_something = news.servo || news.calibration;
  // The end of a run also ends its servo or calibration, whatever its outcome.
  const bool is_over = news.end || !is_something;
  const bool is_new = news.changes != changes_ || (!are_extras_known_ && !is_over);
  if (!is_new && !(news.end && is_something)) return;
  if (!is_over && clock - drawn_at_ < between) return;
  changes_ = news.changes, drawn_at_ = clock, are_extras_known_ = true;
  Extras extras;
  try {
    if (!is_over)
      extras = news.servo ? servo_extras(*rig_, *news.servo) : calibration_extras(*news.calibration);
  } catch (const InputError&) {
    extras = {};  // An arm that cannot be drawn is omitted.
  }
  measured_ = is_over ? std::vector<RunLink::Measured>() : news.measured;
  if (now) extras.time = *now;
  const auto message = std::make_shared<const std::string>(extras_message(extras));
  for (const ClientId client : clients) messenger_.post(client, extras_stream, message);
}

void RunReporter::send(const Node& message, const std::set<ClientId>& clients) {
  const std::string text = write_json(message);
  for (const ClientId client : clients) messenger_.send(client, text);
}

}  // namespace flexura
