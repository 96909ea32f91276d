#include "flexura/view/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "flexura/base/table.h"
#include "flexura/base/version.h"
#include "flexura/store/json.h"
#include "flexura/view/answers.h"
#include "flexura/view/document.h"
#include "flexura/view/request.h"

namespace flexura {
namespace {

Node examples_node(const std::vector<ViewExample>& examples) {
  Node::Array list;
  for (const ViewExample& one : examples)
    list.push_back({Node::Table{{"name", {}, text_node(one.name)}, {"title", {}, text_node(one.title)}}, {}});
  return {std::move(list), {}};
}

std::string hello_text(const Hello& hello, const ViewStart& start, bool has_rig, bool has_recording) {
  return write_json({Node::Table{{"type", {}, text_node("hello")},
                                 {"version", {}, text_node(std::string(version()))},
                                 {"session", {}, text_node(start.session)},
                                 {"mode", {}, text_node(hello.mode)},
                                 {"title", {}, text_node(hello.title)},
                                 {"scene", {}, hello.scene},
                                 {"controls", {}, hello.controls},
                                 {"duration", {}, {hello.duration, {}}},
                                 {"interval", {}, {hello.interval, {}}},
                                 {"marks", {}, Codec<std::vector<Mark>>::write(hello.marks)},
                                 {"quantities", {}, Codec<std::vector<Quantity>>::write(hello.quantities)},
                                 {"report", {}, {hello.report, {}}},
                                 {"rig", {}, {has_rig, {}}},
                                 {"recording", {}, {has_recording, {}}},
                                 {"examples", {}, examples_node(start.examples)},
                                 {"readonly", {}, {hello.readonly, {}}}},
                     {}});
}

std::string reply_text(const std::optional<std::int64_t>& id, const ViewAnswer& answer) {
  Node::Table table{{"type", {}, text_node("reply")}, {"id", {}, id ? Node{*id, {}} : Node{}}};
  if (answer.error.empty()) {
    table.push_back({"result", {}, answer.result});
  } else {
    table.push_back({"error", {}, text_node(answer.error)});
  }
  return write_json({std::move(table), {}});
}

}  // namespace

Viewer::Viewer(ViewStart start, Messenger& messenger, Background& background, double now)
    : start_(std::move(start)), messenger_(messenger), background_(background), clock_(now) {
  if (start_.recording != nullptr) {
    recording_ = std::make_unique<RecordingSession>(start_.recording, messenger_, background_);
    start_.rig = start_.recording->rig();
    shown_ = recording_.get();
  } else {
    go_live([](const ViewAnswer&) {});
  }
}

void Viewer::opened(ClientId client) {
  clients_.insert(client);
  greet(client);
}

void Viewer::greet(ClientId client) {
  messenger_.send(client, hello_text(shown_->hello(), start_, has_rig(), has_recording()));
  shown_->opened(client);
}

void Viewer::closed(ClientId client) {
  clients_.erase(client);
  failures_.erase(client);
  shown_->closed(client);
}

Reply Viewer::reply_to(ClientId client, std::int64_t id, std::shared_ptr<const void> debt) {
  return [this, client, id, debt = std::move(debt)](const ViewAnswer& answer) {
    if (clients_.contains(client)) messenger_.send(client, reply_text(id, answer));
  };
}

void Viewer::on_message(ClientId client, const std::string& message_text,
                        const std::shared_ptr<const void>& debt) {
  if (!clients_.contains(client)) return;
  const Request request = read_request(message_text);
  std::string error = request.error;
  try {
    if (error.empty()) take(client, request, debt);
  } catch (const std::exception& refusal) {
    error = refusal.what();
  }
  // An `ack` has a reply only if it is invalid.
  if (!error.empty()) messenger_.send(client, reply_text(request.id, {{}, error}));
}

void Viewer::take(ClientId client, const Request& request, const std::shared_ptr<const void>& debt) {
  Reply reply = request.id ? reply_to(client, *request.id, debt) : [](const ViewAnswer&) {};
  if (const auto* const open = std::get_if<OpenRequest>(&request.ask)) {
    if (open->example) {
      open_example(*open->example, reply);
    } else {
      open_last(std::move(reply));
    }
  } else if (std::holds_alternative<LiveRequest>(request.ask)) {
    go_live(reply);
  } else {
    if (std::holds_alternative<AckRequest>(request.ask)) reply = [](const ViewAnswer&) {};
    shown_->take(client, request.ask, std::move(reply));
  }
}

bool Viewer::has_rig() const { return start_.run == nullptr || live_ == nullptr || !live_->is_over(); }

bool Viewer::has_recording() const { return recording_ != nullptr || (live_ != nullptr && live_->results()); }

void Viewer::open_last(Reply reply) {
  if (!has_recording()) throw ViewRefusal("there is no recording yet: expected a finished run");
  if (live_ != nullptr && live_->results()) {
    open(*live_->results(), std::move(reply));
  } else {
    reply({nothing(), ""});
    show(*recording_);
  }
}

void Viewer::open_example(const std::string& name, const Reply& reply) {
  const auto found = std::ranges::find(start_.examples, name, &ViewExample::name);
  if (found == start_.examples.end())
    throw ViewRefusal(
        fmt::format("there is no example {}: expected one of the hello's examples", text_node(name).brief()));
  if (is_opening_) throw ViewRefusal("a recording is being opened");
  if (live_ != nullptr && live_->is_running()) throw ViewRefusal("tasks are running: cancel them first");
  start_.rig = found->load();
  start_.results = found->results;
  const auto live_before =
      std::exchange(live_, std::make_unique<LiveSession>(start_.rig, messenger_, background_,
                                                         LiveSession::Config{clock_, start_.results, {}}));
  reply({nothing(), ""});
  show(*live_);
  // No client is in the old sessions any more.
  recording_.reset();
}

// Opens a recording in the background, since a long log takes time to read.
void Viewer::open(const std::filesystem::path& folder, Reply reply) {
  if (is_opening_) throw ViewRefusal("a recording is being opened");
  is_opening_ = true;
  background_.run(
      Lane::checks,
      [this, folder, reply = std::move(reply), alive = std::weak_ptr(alive_)]() -> Background::After {
        RecordingPtr recording;
        std::string error;
        try {
          recording = std::make_shared<const Recording>(folder);
        } catch (const std::exception& problem) {
          error = problem.what();
        }
        return [this, recording, error, reply, alive] {
          if (alive.expired()) return;
          is_opening_ = false;
          reply({nothing(), error});
          if (recording == nullptr) return;
          // The previous one is destroyed once no client uses it.
          const auto before = std::exchange(
              recording_, std::make_unique<RecordingSession>(recording, messenger_, background_));
          show(*recording_);
        };
      });
}

void Viewer::go_live(const Reply& reply) {
  if (live_ == nullptr) {
    live_ = std::make_unique<LiveSession>(start_.rig, messenger_, background_,
                                          LiveSession::Config{clock_, start_.results, start_.run});
  } else if (!has_rig()) {
    throw ViewRefusal("the run has ended, and its rig no longer exists");
  }
  reply({nothing(), ""});
  show(*live_);
}

void Viewer::show(Session& session) {
  if (shown_ == &session) return;
  Session* before = std::exchange(shown_, &session);
  for (const ClientId client : clients_) {
    if (before != nullptr) before->closed(client);
  }
  for (const ClientId client : clients_) {
    try {
      greet(client);
    } catch (const std::exception& error) {
      failed(client, error.what());  // The other clients are still admitted.
    }
  }
}

void Viewer::asked(const std::string& target, const std::function<void(HttpAnswer)>& answer) {
  try {
    shown_->take(read_document(target), answer);
  } catch (const std::exception& error) {
    answer(
        {404, "application/json", write_json({Node::Table{{"error", {}, text_node(error.what())}}, {}}), ""});
  }
}

void Viewer::advance(double now) {
  clock_ = now;
  shown_->advance(now);
  if (shown_ != live_.get() || !live_->is_over() || is_opening_ || !live_->results()) return;
  open(*live_->results(), [](const ViewAnswer&) {});
}

void Viewer::failed(std::optional<ClientId> client, std::string why) {
  std::ranges::replace_if(why, [](char c) { return c >= 0 && c < ' '; }, ' ');
  const std::string text = reply_text(std::nullopt, {{}, why});
  for (const ClientId receiver : client ? std::set{*client} : clients_) {
    if (std::exchange(failures_[receiver], why) != why) messenger_.send(receiver, text);
  }
}

void Viewer::cancel() {
  if (live_ != nullptr) live_->cancel();
}

}  // namespace flexura
