#include "flexura/app/dry_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "flexura/app/stop_signal.h"
#include "flexura/app/words.h"
#include "flexura/base/node.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/rig/dry_rig.h"
#include "flexura/store/json.h"

namespace flexura {
namespace {

// A folder for results that nobody keeps.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "flexura-dry-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw std::runtime_error(fmt::format("{}: {}", name, std::strerror(errno)));
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code none;
    std::filesystem::remove_all(path_, none);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Stops the run at the first signal.
class DryProgress : public Progress {
 public:
  void update(double /*fraction*/, std::string_view /*what*/) override {}
  [[nodiscard]] bool is_cancelled() const override { return stop_.come() != 0; }
  [[nodiscard]] int signal() const { return stop_.come(); }

 private:
  StopSignal stop_;
};

bool uses_pictures(const TaskConfig& task) {
  return std::holds_alternative<CalibrateTask>(task) || std::holds_alternative<ServoTask>(task);
}

std::vector<std::string> notes_on(const Experiment& experiment) {
  std::vector<std::string> notes = dry_assumptions(experiment);
  if (std::ranges::any_of(experiment.task, uses_pictures))
    notes.emplace_back(
        "tasks that need pictures use pictures of the simulated rig, so the commands of these tasks are an "
        "example");
  return notes;
}

Node sent_node(const DryMessage& message) {
  std::string bytes;
  for (const char one : message.bytes) bytes += fmt::format("{:02x}", static_cast<unsigned char>(one));
  return {Node::Table{{"time", {}, number_node(message.time)},
                      {"device", {}, text_node(message.device)},
                      {"text", {}, text_node(message.sent.text)},
                      {"asks", {}, {message.sent.asks, {}}},
                      {"bytes", {}, text_node(bytes)}},
          {}};
}

// Prints messages as they come, or keeps them.
class DryListing {
 public:
  DryListing(const Experiment& experiment, const RunArguments& arguments, std::ostream& out)
      : arguments_(arguments), out_(out) {
    const RigEquipment& equipment = *experiment.equipment;
    const auto widen = [&](const std::string& name) { width_ = std::max(width_, name.size()); };
    for (const GrblConfig& one : equipment.grbl) widen(one.link);
    if (equipment.cia402) widen(equipment.cia402->link);
    for (const CameraEquipment& one : equipment.camera) {
      if (one.visca) widen(one.visca->bus.link);
      if (one.v4l2_head) widen(one.v4l2_head->device);
    }
  }
  void take(const DryMessage& message) {
    ++(message.sent.asks ? questions_ : commands_);
    if (message.sent.asks && !arguments_.queries) return;
    if (arguments_.json) {
      sent_.push_back(sent_node(message));
    } else {
      out_ << fmt::format("{:9.3f} s  {:<{}}  {}\n", message.time, one_line(message.device), width_,
                          one_line(message.sent.text));
    }
  }
  [[nodiscard]] std::size_t commands() const { return commands_; }
  [[nodiscard]] std::size_t questions() const { return questions_; }
  [[nodiscard]] Node::Array take_sent() { return std::move(sent_); }

 private:
  const RunArguments& arguments_;
  std::ostream& out_;
  std::size_t width_ = 0, commands_ = 0, questions_ = 0;
  Node::Array sent_;
};

}  // namespace

int dry_run_command(const RunArguments& arguments, std::ostream& out, std::ostream& err) {
  Experiment experiment = load_experiment(arguments.experiment, {arguments.sets, arguments.seed});
  if (experiment.task.empty())
    throw input_error(arguments.experiment, "nothing to do: expected at least one [[task]]", 1, 1);
  if (!experiment.equipment)
    throw input_error(arguments.experiment,
                      "--dry-run: the rig of this file is simulated, so a run sends nothing: expected a "
                      "table [rig]",
                      1, 1);
  experiment.record.cameras = experiment.record.report = experiment.record.scene = false;
  const std::vector<std::string> notes = notes_on(experiment);
  if (!arguments.json) {
    print_line(out, "dry run", "no command is sent to real devices; simulated devices answer");
    for (const std::string& note : notes) print_line(out, "note", note);
  }
  DryProgress progress;
  DryListing listing(experiment, arguments, out);
  const ScratchFolder folder;
  const RunResult result =
      run_experiment(experiment, folder.path(), progress, nullptr, [&](const Setup& setup) {
        return dry_rig(setup, [&](const DryMessage& message) { listing.take(message); });
      });
  for (const std::string& reason : result.reasons) print_line(err, name_of(result.outcome), reason);
  if (arguments.json) {
    const Node document{Node::Table{{"dry_run", {}, {true, {}}},
                                    {"notes", {}, texts_node(notes)},
                                    {"outcome", {}, text_node(name_of(result.outcome))},
                                    {"reasons", {}, texts_node(result.reasons)},
                                    {"commands", {}, {static_cast<std::int64_t>(listing.commands()), {}}},
                                    {"questions", {}, {static_cast<std::int64_t>(listing.questions()), {}}},
                                    {"sent", {}, {listing.take_sent(), {}}}},
                        {}};
    out << write_json(document, 2) << '\n';
  } else {
    print_line(out, "dry run",
               fmt::format("{} commands, {} questions{}", listing.commands(), listing.questions(),
                           arguments.queries ? "" : " (not listed; --queries lists them)"));
    print_line(out, "outcome", result.headline);
  }
  if (result.outcome == RunOutcome::cancelled) return exit_of_signal(progress.signal());
  return result.outcome == RunOutcome::done ? exit_done : exit_missed;
}

}  // namespace flexura
