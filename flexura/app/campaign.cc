#include "flexura/app/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <optional>
#include <ostream>
#include <thread>

#include "flexura/app/commands.h"
#include "flexura/app/stop_signal.h"
#include "flexura/app/terminal_progress.h"
#include "flexura/app/words.h"
#include "flexura/base/version.h"
#include "flexura/campaign/campaign_driver.h"
#include "flexura/campaign/campaign_file.h"
#include "flexura/campaign/campaign_groups.h"
#include "flexura/campaign/campaign_report.h"
#include "flexura/campaign/campaign_summary.h"
#include "flexura/campaign/engine.h"
#include "flexura/campaign/mpi_engine.h"
#include "flexura/log/results.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"

namespace flexura {
namespace {

// A progress that a signal cancels. A second signal ends the program at once, which loses no finished run.
class StoppableProgress : public Progress {
 public:
  explicit StoppableProgress(std::ostream& err)
      : terminal_(err), stop_([this] {
          if (is_stopped_.exchange(true)) std::_Exit(exit_of_signal(stop_.come()));
        }) {}
  void update(double fraction, std::string_view what) override { terminal_.update(fraction, what); }
  [[nodiscard]] bool is_cancelled() const override { return is_stopped_; }
  [[nodiscard]] int received_signal() const { return stop_.come(); }
  void clear() { terminal_.clear(); }

 private:
  TerminalProgress terminal_;
  std::atomic<bool> is_stopped_ = false;
  StopSignal stop_;
};

// With MPI, each rank has one worker by default, because mpirun starts one rank for each processor.
std::size_t workers_of(const CampaignArguments& arguments) {
  if (arguments.workers) return static_cast<std::size_t>(*arguments.workers);
  return is_started_by_mpi() ? 1 : std::max<std::size_t>(std::thread::hardware_concurrency(), 1);
}

RunFunction run_of(const Campaign& campaign) {
  return [&campaign](std::int64_t id, Progress& progress) { return execute_run(campaign, id, progress); };
}

std::filesystem::path out_of(const CampaignArguments& arguments) {
  if (!arguments.out.empty()) return arguments.out;
  std::filesystem::path file = default_results_folder(arguments.campaign);
  return file += ".db";
}

// Executes some runs spread over the campaign, and returns their mean duration, s.
double measured_duration(const Campaign& campaign, Progress& progress) {
  constexpr std::int64_t most_runs = 5;
  constexpr double longest = 10;  // s
  const std::int64_t runs = campaign.design().runs(), count = std::min(runs, most_runs);
  double sum = 0;
  std::int64_t done = 0;
  while (done < count && sum < longest) {
    progress.update(static_cast<double>(done) / static_cast<double>(count), "measuring runs");
    const auto row = execute_run(campaign, done * runs / count, progress);
    if (!row) break;
    sum += row->seconds, ++done;
  }
  return done == 0 ? 0 : sum / static_cast<double>(done);
}

int plan(const CampaignArguments& arguments, const Campaign& campaign, std::ostream& out, std::ostream& err) {
  StoppableProgress progress(err);
  const double duration = measured_duration(campaign, progress);
  progress.clear();
  if (progress.is_cancelled()) return exit_of_signal(progress.received_signal());
  const auto workers = workers_of(arguments);
  const std::int64_t runs = campaign.design().runs();
  const double total = duration * static_cast<double>(runs) / static_cast<double>(workers);
  if (arguments.json) {
    out << write_json({Node::Table{{"runs", {}, {runs, {}}},
                                   {"workers", {}, {static_cast<std::int64_t>(workers), {}}},
                                   {"seconds_per_run", {}, {duration, {}}},
                                   {"seconds", {}, {total, {}}}},
                       {}},
                      2)
        << '\n';
    return exit_done;
  }
  out << fmt::format("runs: {}\n", runs);
  out << fmt::format("time: about {} ({:.2g} s per run, {} at the same time)\n", duration_text(total),
                     duration, workers);
  if (!campaign.config().stop.precision.empty()) out << "the campaign may end earlier (stop.precision)\n";
  return exit_done;
}

// Says which measures no run has, for example because of a misspelt key.
void note_missing_measures(const Campaign& campaign, CampaignFile& file, std::ostream& err) {
  std::vector<bool> is_found(campaign.config().measure.size(), false);
  std::int64_t done = 0;
  file.for_each([&](const CampaignRow& row) {
    if (row.status == "done") ++done;
    for (std::size_t i = 0; i < is_found.size(); ++i)
      if (!row.measures[i].empty()) is_found[i] = true;
  });
  for (std::size_t i = 0; i < is_found.size(); ++i)
    if (!is_found[i] && done > 0)
      print_line(err, "note",
                 fmt::format("no run has the measure \"{}\": expected a key of summary.json",
                             campaign.config().measure[i].key));
}

void print_end(const CampaignArguments& arguments, const CampaignEnd& end, const std::filesystem::path& file,
               std::ostream& out) {
  if (!arguments.json) {
    print_line(out, "results", file.string());
    print_line(out, end.is_complete ? "complete" : "not complete", end.reason);
    return;
  }
  out << write_json({Node::Table{{"results", {}, text_node(file.string())},
                                 {"complete", {}, {end.is_complete, {}}},
                                 {"reason", {}, text_node(end.reason)},
                                 {"runs_before", {}, {end.before, {}}},
                                 {"runs", {}, {end.runs, {}}}},
                     {}},
                    2)
      << '\n';
}

}  // namespace

int campaign_command(const CampaignArguments& arguments, std::ostream& out, std::ostream& err) {
  std::optional<MpiSession> session;
  if (is_started_by_mpi()) session.emplace();
  if (session && session->rank() > 0) {
    const std::string record = MpiSession::hear();
    if (record.empty()) return exit_done;  // Rank 0 reports why.
    const Campaign campaign = Campaign::from_record(record, "campaign");
    serve_runs(run_of(campaign), workers_of(arguments));
    return exit_done;
  }
  const Campaign campaign(arguments.campaign, arguments.sets);
  if (arguments.dry_run) return plan(arguments, campaign, out, err);
  const std::filesystem::path path = out_of(arguments);
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
  CampaignFile file(path, campaign,
                    arguments.is_safe_from_power_loss ? Durability::power : Durability::process);
  StoppableProgress progress(err);
  std::unique_ptr<CampaignEngine> engine;
  if (session) {
    session->tell(campaign.record());
    engine = std::make_unique<MpiEngine>(*session, run_of(campaign), workers_of(arguments));
  } else {
    engine = std::make_unique<ThreadEngine>(run_of(campaign), workers_of(arguments));
  }
  const CampaignEnd end = run_campaign(campaign, file, *engine, progress);
  progress.clear();
  note_missing_measures(campaign, file, err);
  print_end(arguments, end, path, out);
  if (end.is_cancelled) return exit_of_signal(progress.received_signal());
  return end.is_complete ? exit_done : exit_missed;
}

int campaign_report_command(const CampaignReportArguments& arguments, std::ostream& out) {
  CampaignResults results(arguments.results);
  std::filesystem::path page = arguments.out;
  if (arguments.out.empty()) page = std::filesystem::path(arguments.results).replace_extension(".html");
  replace_file(page, campaign_html(results, arguments.results));
  print_line(out, "report", page.string());
  return exit_done;
}

int export_campaign_command(const std::string& results, const std::string& format,
                            const std::string& out_file, std::ostream& out) {
  const bool is_page = format == "markdown";
  if (format != "csv" && !is_page)
    throw input_error("--to",
                      fmt::format("\"{}\": the results of a campaign become csv or markdown only", format));
  CampaignResults read(results);
  std::filesystem::path file = out_file;
  if (out_file.empty()) file = std::filesystem::path(results).replace_extension(is_page ? ".md" : ".csv");
  if (!is_missing(file)) throw input_error(file.string(), "exists already: expected another --out");
  if (is_page)
    write_new_file(file, campaign_markdown(read));
  else
    export_campaign_csv(read, file);
  print_line(out, is_page ? "page" : "table", file.string());
  return exit_done;
}

Experiment replayed_experiment(const std::string& results, std::int64_t row,
                               const std::vector<std::string>& sets, std::ostream& err) {
  const CampaignResults read(results);
  const std::int64_t runs = read.campaign().design().runs();
  if (row >= runs)
    throw input_error("--row",
                      fmt::format("{}: the campaign has {} runs: expected 0 to {}", row, runs, runs - 1));
  if (read.version() != version())
    print_line(err, "note",
               fmt::format("the results are of Flexura {}, this is {}", read.version(), version()));
  read.campaign().check_named_files(results);
  return read.campaign().experiment(row, sets);
}

std::filesystem::path default_replay_folder(const std::string& results, std::int64_t row) {
  const std::string name = std::filesystem::path(results).stem().string();
  return std::filesystem::path("results") / fmt::format("{}-row-{}", name, row);
}

}  // namespace flexura
