#include "flexura/app/commands.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string_view>

#include "flexura/app/campaign.h"
#include "flexura/app/export_gltf.h"
#include "flexura/app/forward.h"
#include "flexura/app/inverse.h"
#include "flexura/app/json_lines.h"
#include "flexura/app/linearise.h"
#include "flexura/app/statics.h"
#include "flexura/app/stop_signal.h"
#include "flexura/app/terminal_progress.h"
#include "flexura/app/view.h"
#include "flexura/app/words.h"
#include "flexura/base/table.h"
#include "flexura/base/work_progress.h"
#include "flexura/campaign/campaign_config.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/experiment/safety_nodes.h"
#include "flexura/experiment/schedule.h"
#include "flexura/log/export_csv.h"
#include "flexura/log/export_mp4.h"
#include "flexura/log/export_png.h"
#include "flexura/log/results.h"
#include "flexura/log/results_log.h"
#include "flexura/rig/rig_devices.h"
#include "flexura/safety/violation_groups.h"
#include "flexura/store/child_process.h"
#include "flexura/store/json.h"
#include "flexura/store/schema.h"
#include "flexura/store/text_file.h"
#include "flexura/tasks/task_kinds.h"
#include "flexura/view/run_link.h"

namespace flexura {
namespace {

using Clock = std::chrono::steady_clock;

// Writes all wall-clock values of a run to the only file that may differ from run to run.
void write_timing(const std::filesystem::path& folder, std::time_t started, double wall,
                  const Node& summary) {
  const double simulated = *summary.find("duration")->as<double>();
  const Node timing{Node::Table{{"started", {}, {fmt::format("{:%FT%TZ}", fmt::gmtime(started)), {}}},
                                {"wall_seconds", {}, {wall, {}}},
                                {"simulated_seconds", {}, {simulated, {}}},
                                {"times_real_time", {}, {wall > 0 ? simulated / wall : 0.0, {}}}},
                    {}};
  write_new_file(folder / timing_file_name, write_json(timing, 2) + "\n");
}

void print_result(const Experiment& experiment, const RunResult& result, std::ostream& out) {
  const auto& position = *result.summary.find("tip")->find("position")->as<Node::Array>();
  const auto coordinate = [&](std::size_t i) { return *position[i].as<double>(); };
  const bool planar = experiment.arm.kind == ArmKind::planar;
  const std::string z = planar ? "" : fmt::format(", {:.3f}", coordinate(2));
  if (result.outcome == RunOutcome::done) {
    out << fmt::format("end effector: ({:.3f}, {:.3f}{})\n", coordinate(0), coordinate(1), z);
  }
  print_line(out, "results", result.folder.string());
  // What came of each task, if there are several, and last of the run.
  constexpr std::size_t most_lines = 30;
  const std::size_t count = result.outcomes.size() > 1 ? result.outcomes.size() : 0;
  for (std::size_t i = 0; i < std::min(count, most_lines); ++i)
    out << one_line(result.outcomes[i].line()) << '\n';
  if (count > most_lines) out << fmt::format("and {} more, in {}\n", count - most_lines, summary_file_name);
  print_line(out, "outcome", result.headline);
}

// A run with a viewer, which stays open until the program is stopped. Stopping during the run cancels it.
class WatchedRun {
 public:
  WatchedRun(const Experiment& experiment, const std::shared_ptr<RunLink>& link,
             const ViewerArguments& arguments, double speed, std::ostream& out)
      : stop_([link] { link->cancel(); }),
        viewer_({.session = {},
                 .rig = std::make_shared<const ViewedRig>(experiment),
                 .run = link,
                 .speed = speed},
                arguments, out) {}
  void wait() const { stop_.wait(); }

 private:
  StopSignal stop_;
  OpenViewer viewer_;
};

// A run or a check without a viewer. The first stop signal cancels it; a second one ends the program at once,
// as the default handler would.
class UnwatchedRun {
 public:
  explicit UnwatchedRun(const std::shared_ptr<RunLink>& link)
      : stop_([this, link] {
          if (times_signalled_++ > 0) std::_Exit(exit_of_signal(stop_.come()));
          link->cancel();
        }) {}
  /// Returns the first stop signal received; 0: none.
  [[nodiscard]] int received_signal() const { return stop_.come(); }

 private:
  int times_signalled_ = 0;  // Used only in the signal thread.
  StopSignal stop_;
};

// Exports a run's log as tables, or the films of its cameras.
ExportResult export_as(const std::string& format, const std::filesystem::path& results, Progress& progress) {
  if (format == "csv") return export_csv(results, task_tables(), &progress);
  const Experiment experiment = load_experiment(file_of_results(results, experiment_file_name));
  const std::vector<CameraConfig> cameras = experiment.true_rig().cameras;
  return format == "mp4" ? export_mp4(results, cameras, &progress) : export_png(results, cameras, &progress);
}

// Answers lines about the elastic arm in a file with an `Answers` object. Throws InputError if the arm does
// not allow one.
template <typename Answers>
int answer_about_rod(const std::string& arm_file, std::istream& in, std::ostream& out) {
  const Experiment experiment = load_experiment(arm_file);
  std::optional<Answers> answers;
  try {
    answers.emplace(experiment.arm, experiment.drive);
  } catch (const std::invalid_argument& error) {
    throw input_error(arm_file, error.what());
  }
  answer_lines([&](std::string_view line) { return answers->answer(line); }, in, out);
  return exit_done;
}

}  // namespace

int run_command(const RunArguments& arguments, std::ostream& out, std::ostream& err) {
  const auto start = Clock::now();
  const std::time_t started = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  const bool is_replay = !arguments.from.empty();
  const Experiment experiment =
      is_replay ? replayed_experiment(arguments.from, arguments.row.value(), arguments.sets, err)
                : load_experiment(arguments.experiment, {arguments.sets, arguments.seed});
  if (experiment.task.empty())
    throw input_error(arguments.experiment, "nothing to do: expected at least one [[task]]", 1, 1);
  std::filesystem::path desired = arguments.out;
  if (arguments.out.empty())
    desired = is_replay ? default_replay_folder(arguments.from, *arguments.row)
                        : default_results_folder(arguments.experiment);
  const auto folder = make_new_folder(desired);
  TerminalProgress progress(err);
  // A film takes about a tenth of the work of its pictures.
  const bool has_films = experiment.record.cameras && has_program(film_program);
  WorkProgress work(progress, {0.9, has_films ? 0.1 : 0.0});
  const auto link = std::make_shared<RunLink>(&work.piece(0));
  std::optional<WatchedRun> watched;
  std::optional<UnwatchedRun> unwatched;
  if (arguments.viewer) {
    watched.emplace(experiment, link, *arguments.viewer, arguments.speed, arguments.json ? err : out);
  } else {
    unwatched.emplace(link);
  }
  RunResult result;
  try {
    result = run_experiment(experiment, folder, *link, link.get());
  } catch (const HomingCancelled& cancelled) {
    progress.clear();
    print_line(err, "cancelled", cancelled.what());
    return exit_of_signal(unwatched ? unwatched->received_signal() : SIGINT);
  }
  // The film is optional: the run succeeds without ffmpeg, and a cancelled run does not wait for it.
  std::string no_film;
  if (has_films && result.outcome != RunOutcome::cancelled) {
    try {
      (void)export_as("mp4", folder, work.piece(1));
    } catch (const std::exception& error) {
      no_film = error.what();
    }
  }
  progress.clear();
  if (!no_film.empty()) print_line(err, "no film", no_film);
  const auto is_recorded = [](const TaskOutcome& outcome) { return outcome.kind == "record"; };
  if (experiment.record.cameras && !has_films && std::ranges::any_of(result.outcomes, is_recorded))
    print_line(
        err, "note",
        fmt::format(
            "the log contains all pictures; to make a film, install {0} and run: flexura export {1} --to mp4",
            film_program, folder.string()));
  write_timing(folder, started, std::chrono::duration<double>(Clock::now() - start).count(), result.summary);
  for (std::size_t i = 0; i < result.reasons.size(); ++i) {
    // After the reason of a cancellation come the reasons why the run was unsafe.
    const bool is_second = result.outcome == RunOutcome::cancelled && i > 0;
    print_line(err, name_of(is_second ? RunOutcome::unsafe : result.outcome), result.reasons[i]);
  }
  if (arguments.json) {
    out << write_json(result.summary, 2) << '\n';
    print_line(err, "results", folder.string());
  } else {
    print_result(experiment, result, out);
  }
  out.flush();
  link->finish(
      {name_of(result.outcome), result.reasons.empty() ? result.headline : result.reasons.front(), folder});
  if (watched) watched->wait();
  if (result.outcome == RunOutcome::cancelled && unwatched)
    return exit_of_signal(unwatched->received_signal());
  return result.outcome == RunOutcome::done ? exit_done : exit_missed;
}

int check_command(const CheckArguments& arguments, std::ostream& out, std::ostream& err) {
  const Experiment experiment = load_experiment(arguments.experiment, {arguments.sets, {}});
  if (experiment.task.empty())
    throw input_error(arguments.experiment, "nothing to check: expected at least one [[task]]", 1, 1);
  TerminalProgress progress(err);
  const auto link = std::make_shared<RunLink>(&progress);
  const UnwatchedRun stoppable(link);
  const SafetyReport report = check_experiment_safety(experiment, *link);
  progress.clear();
  if (link->is_cancelled()) {
    print_line(err, "cancelled", "the check was stopped before it was complete");
    return exit_of_signal(stoppable.received_signal());
  }
  if (arguments.json) {
    out << write_json(safety_node(report), 2) << '\n';
  } else {
    for (const std::string& line : violation_lines(report)) print_line(out, "unsafe", line);
    for (const std::string& caveat : report.caveats) print_line(out, "caveat", caveat);
    for (const std::string& note : report.notes) print_line(out, "note", note);
    if (report.is_safe()) out << "safe\n";
  }
  return report.is_safe() ? exit_done : exit_missed;
}

int forward_command(const std::string& arm_file, std::istream& in, std::ostream& out) {
  const ArmModel arm = load_experiment(arm_file).arm_model();
  answer_lines([&](std::string_view line) { return answer_forward(arm, line); }, in, out);
  return exit_done;
}

int inverse_command(const std::string& arm_file, std::istream& in, std::ostream& out) {
  const ArmModel arm = load_experiment(arm_file).arm_model();
  answer_lines([&](std::string_view line) { return answer_inverse(arm, line); }, in, out);
  return exit_done;
}

int statics_command(const std::string& arm_file, std::istream& in, std::ostream& out) {
  return answer_about_rod<StaticsAnswers>(arm_file, in, out);
}

int linearise_command(const std::string& arm_file, std::istream& in, std::ostream& out) {
  return answer_about_rod<LineariseAnswers>(arm_file, in, out);
}

int export_command(const ExportArguments& arguments, std::ostream& out, std::ostream& err) {
  const std::string& format = arguments.format;
  constexpr std::array formats = {"csv", "mp4", "png", "gltf", "markdown"};
  if (std::ranges::find(formats, format) == formats.end())
    throw input_error("--to", fmt::format("\"{}\": expected csv, mp4, png, gltf or markdown", format));
  if (std::filesystem::is_regular_file(arguments.results))
    return export_campaign_command(arguments.results, format, arguments.out, out);
  if (format == "markdown")
    throw input_error("--to",
                      "\"markdown\" is for the results of a campaign: expected csv, mp4, png or gltf");
  const bool is_gltf = format == "gltf";
  if (!is_gltf && !arguments.out.empty())
    throw input_error("--out",
                      fmt::format("--to {} writes a folder, not one file: expected --to gltf", format));
  TerminalProgress progress(err);
  std::filesystem::path written;
  std::vector<std::string> notes;
  if (is_gltf) {
    const GltfExport result = export_gltf(arguments.results, arguments.out, &progress);
    written = result.file, notes = result.notes;
  } else {
    const ExportResult result = export_as(format, arguments.results, progress);
    written = result.folder, notes = result.notes;
  }
  progress.clear();
  for (const std::string& note : notes) err << "note: " << note << '\n';
  const char* const films_or_tables = format == "csv" ? "tables" : "films";
  print_line(out, is_gltf ? "glTF" : films_or_tables, written.string());
  return exit_done;
}

int schema_command(const std::string& format, const std::string& subject, std::ostream& out) {
  const TableInfo& info = subject == "campaign"
                              ? fields_of(static_cast<const CampaignConfig*>(nullptr)).info()
                              : fields_of(static_cast<const Experiment*>(nullptr)).info();
  out << (format == "json" ? write_json(json_schema(info), 2) + "\n" : markdown_reference(info));
  return exit_done;
}

}  // namespace flexura
