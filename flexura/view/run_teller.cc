#include "flexura/view/run_teller.h"

#include <cmath>
#include <cstddef>
#include <memory>

#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/store/json.h"
#include "flexura/view/extras.h"

namespace flexura {

void RunTeller::begin() {
  told_fraction_ = told_at_ = drawn_at_ = -1;
  told_what_.clear();
  measured_.clear();
  changes_ = 0, are_extras_known_ = true;
}

void RunTeller::tell(RunLink& run, const RunLink::News& news, double clock, std::optional<double> now,
                     const std::set<ClientId>& clients) {
  // What a run tells at once is told over some ticks: a client that reads slowly is not cut off for it.
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
  tell_extras(news, clock, now, clients);
  if (!news.end) {
    tell_progress(news, clock, clients);
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

void RunTeller::tell_progress(const RunLink::News& news, double clock, const std::set<ClientId>& clients) {
  constexpr double to_be_seen = 0.002, between = 0.25;  // of the whole; s, between two words
  const bool has_moved = std::abs(news.fraction - told_fraction_) >= to_be_seen;
  const bool says_more = news.what != told_what_ && clock - told_at_ >= between;
  if (!has_moved && !says_more) return;
  told_fraction_ = news.fraction, told_what_ = news.what, told_at_ = clock;
  send({Node::Table{{"type", {}, text_node("progress")},
                    {"what", {}, text_node(news.what)},
                    {"fraction", {}, {news.fraction, {}}}},
        {}},
       clients);
}

void RunTeller::tell_extras(const RunLink::News& news, double clock, std::optional<double> now,
                            const std::set<ClientId>& clients) {
  constexpr double between = 0.04;  // s; more often nobody sees
  const bool is_something = news.servo || news.calibration;
  // With the run its last servo or calibration is over, however it ended.
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
    extras = {};  // Of an arm that cannot be drawn nothing is.
  }
  measured_ = is_over ? std::vector<RunLink::Measured>() : news.measured;
  if (now) extras.time = *now;
  const auto message = std::make_shared<const std::string>(extras_message(extras));
  for (const ClientId client : clients) messenger_.post(client, extras_stream, message);
}

void RunTeller::send(const Node& message, const std::set<ClientId>& clients) {
  const std::string text = write_json(message);
  for (const ClientId client : clients) messenger_.send(client, text);
}

}  // namespace flexura
