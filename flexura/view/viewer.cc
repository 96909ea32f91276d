#include "flexura/view/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "flexura/base/table.h"
#include "flexura/base/version.h"
#include "flexura/store/json.h"
#include "flexura/view/answers.h"
#include "flexura/view/branch.h"
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

std::string hello_text(const Hello& hello, const ViewStart& start, bool has_rig, bool has_recording,
                       bool has_campaign) {
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
                                 {"headline", {}, text_node(hello.headline)},
                                 {"report", {}, {hello.report || has_campaign, {}}},
                                 {"campaign", {}, {has_campaign, {}}},
                                 {"rig", {}, {has_rig, {}}},
                                 {"recording", {}, {has_recording, {}}},
                                 {"examples", {}, examples_node(start.examples)},
                                 {"readonly", {}, {hello.readonly, {}}},
                                 {"speed", {}, hello.speed ? Node{*hello.speed, {}} : Node{}}},
                     {}});
}

Node problems_node(const std::vector<Problem>& problems) {
  Node::Array list;
  for (const Problem& problem : problems)
    list.push_back({Node::Table{{"line", {}, {std::int64_t{problem.where.line}, {}}},
                                {"column", {}, {std::int64_t{problem.where.column}, {}}},
                                {"text", {}, text_node(problem.what)}},
                    {}});
  return {Node::Table{{"problems", {}, {std::move(list), {}}}}, {}};
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
  if (start_.results.empty()) start_.results = std::filesystem::path("results") / "view";
  if (!start_.campaign.empty())
    campaign_ = std::make_unique<CampaignWatcher>(start_.campaign, messenger_, background_);
  if (start_.recording != nullptr) {
    recording_ = std::make_unique<RecordingSession>(start_.recording, messenger_, background_);
    start_.rig = start_.recording->rig();
    shown_ = recording_.get();
  } else if (!start_.pictures.empty()) {
    files_ = std::make_unique<FileSession>(start_.pictures, messenger_, background_);
    shown_ = files_.get();
  } else {
    go_live([](const ViewAnswer&) {});
  }
}

void Viewer::opened(ClientId client) {
  clients_.insert(client);
  greet(client);
}

void Viewer::greet(ClientId client) {
  messenger_.send(client,
                  hello_text(shown_->hello(), start_, has_rig(), has_recording(), is_campaign_shown()));
  shown_->opened(client);
  if (campaign_ != nullptr) campaign_->opened(client);
}

void Viewer::closed(ClientId client) {
  clients_.erase(client);
  failures_.erase(client);
  shown_->closed(client);
  if (campaign_ != nullptr) campaign_->closed(client);
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
  if (files_ != nullptr) {
    if (std::holds_alternative<AckRequest>(request.ask)) reply = [](const ViewAnswer&) {};
    files_->take(client, request.ask, std::move(reply));
  } else if (const auto* const open = std::get_if<OpenRequest>(&request.ask)) {
    if (open->example) {
      open_example(*open->example, reply);
    } else {
      open_last(std::move(reply));
    }
  } else if (std::holds_alternative<LiveRequest>(request.ask)) {
    go_live(reply);
  } else if (const auto* const branch_at = std::get_if<BranchRequest>(&request.ask)) {
    branch(branch_at->time, reply);
  } else if (const auto* const experiment = std::get_if<ExperimentRequest>(&request.ask)) {
    give_text(client, *experiment, reply);
  } else if (const auto* const checked = std::get_if<CheckRequest>(&request.ask)) {
    check(checked->text.content, reply);
  } else if (const auto* const saved = std::get_if<SaveRequest>(&request.ask)) {
    save(*saved, reply);
  } else {
    if (std::holds_alternative<AckRequest>(request.ask)) reply = [](const ViewAnswer&) {};
    shown_->take(client, request.ask, std::move(reply));
  }
}

bool Viewer::has_rig() const {
  return files_ == nullptr && (start_.run == nullptr || live_ == nullptr || !live_->is_over());
}

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
    throw ViewRefusal(fmt::format("there is no example {}: expected one of the examples in the message hello",
                                  text_node(name).brief()));
  if (is_opening_) throw ViewRefusal("a recording is being opened");
  if (live_ != nullptr && live_->is_running()) throw ViewRefusal("tasks are running: cancel them first");
  replace_rig(found->load(), found->results, found->text, reply);
  start_.stem = found->name;
  // No client is in the old sessions any more.
  recording_.reset();
}

// The recording stays, to be opened again.
void Viewer::branch(double time, const Reply& reply) {
  if (shown_ != recording_.get()) throw ViewRefusal("this is a live rig: expected a recording to start from");
  if (is_opening_) throw ViewRefusal("a recording is being opened");
  if (live_ != nullptr && live_->is_running()) throw ViewRefusal("tasks are running: cancel them first");
  replace_rig(std::make_shared<const ViewedRig>(experiment_from(recording_->recording(), time)),
              start_.results, "", reply);
}

// Works on the lane of checks: the check of an experiment takes a while.
void Viewer::answer_later(std::function<ViewAnswer()> work, const Reply& reply) {
  background_.run(Lane::checks,
                  [work = std::move(work), reply, alive = std::weak_ptr(alive_)]() -> Background::After {
                    ViewAnswer answer;
                    try {
                      answer = work();
                    } catch (const std::exception& error) {
                      answer.error = error.what();
                    }
                    return [answer, reply, alive] {
                      if (!alive.expired()) reply(answer);
                    };
                  });
}

void Viewer::give_text(ClientId client, const ExperimentRequest& request, const Reply& reply) {
  const bool is_recording = shown_ == recording_.get();
  const ViewedRigPtr rig = is_recording ? recording_->recording().rig() : start_.rig;
  const RigInstant instant = shown_->instant(client);
  std::optional<std::size_t> camera;
  if (request.camera) {
    camera = rig->camera(*request.camera);
    if (!camera)
      throw ViewRefusal(
          fmt::format("camera = {}: there is no camera with this name", text_node(*request.camera).brief()));
  }
  answer_later(
      [request, rig, instant, camera, file = is_recording ? "" : start_.text, folder = start_.folder,
       stem = start_.stem]() -> ViewAnswer {
        std::string text = editable_text(file, rig->experiment);
        if (camera) {
          text = with_camera_start(text, *rig, *camera, instant.cameras.at(*camera));
        } else if (request.add) {
          text = with_move(text, *rig, instant.arm);
        }
        return {{Node::Table{{"text", {}, text_node(text)},
                             {"name", {}, text_node(free_name(folder, stem))},
                             {"folder", {}, text_node(folder.empty() ? "." : folder.string())}},
                 {}},
                ""};
      },
      reply);
}

void Viewer::check(const std::string& text, const Reply& reply) {
  answer_later([text]() -> ViewAnswer { return {problems_node(experiment_problems(text)), ""}; }, reply);
}

void Viewer::save(const SaveRequest& request, const Reply& reply) {
  answer_later(
      [request, folder = start_.folder]() -> ViewAnswer {
        const std::vector<Problem> problems = experiment_problems(request.text.content);
        Node answer = problems_node(problems);
        if (problems.empty()) {
          const auto file = save_new_experiment(folder, request.name, request.text.content);
          std::get<Node::Table>(answer.value).push_back({"file", {}, text_node(file.string())});
        }
        return {std::move(answer), ""};
      },
      reply);
}

void Viewer::replace_rig(ViewedRigPtr rig, std::filesystem::path results, std::string text,
                         const Reply& reply) {
  auto live =
      std::make_unique<LiveSession>(rig, messenger_, background_, LiveSession::Config{clock_, results, {}});
  start_.rig = std::move(rig);
  start_.results = std::move(results);
  start_.text = std::move(text);
  start_.run.reset();
  const auto live_before = std::exchange(live_, std::move(live));
  reply({nothing(), ""});
  show(*live_);
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
    live_ =
        std::make_unique<LiveSession>(start_.rig, messenger_, background_,
                                      LiveSession::Config{clock_, start_.results, start_.run, start_.speed});
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
    const Document document = read_document(target);
    if (is_campaign_shown() && std::holds_alternative<ReportAsk>(document)) {
      campaign_->give_report(answer);
    } else {
      shown_->take(document, answer);
    }
  } catch (const std::exception& error) {
    answer(
        {404, "application/json", write_json({Node::Table{{"error", {}, text_node(error.what())}}, {}}), ""});
  }
}

void Viewer::advance(double now) {
  clock_ = now;
  shown_->advance(now);
  if (campaign_ != nullptr) campaign_->advance(now);
  if (live_ == nullptr || shown_ != live_.get() || !live_->is_over() || is_opening_ || !live_->results())
    return;
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
