#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "flexura/experiment/experiment.h"

namespace flexura {

/// Arguments of `flexura campaign`.
struct CampaignArguments {
  std::string campaign;
  std::string out;  ///< File of the results; "": results/NAME.db.
  std::vector<std::string> sets;
  std::optional<std::int64_t> workers;  ///< Runs at the same time; missing: the number of processors.
  bool is_safe_from_power_loss = false;
  bool dry_run = false;
  bool json = false;
};

/// Executes the missing runs of a campaign, or only says what it would do (CampaignArguments::dry_run).
/// Returns an exit status; throws as the commands of commands.h.
int campaign_command(const CampaignArguments& arguments, std::ostream& out, std::ostream& err);

/// Arguments of `flexura report`.
struct CampaignReportArguments {
  std::string results;
  std::string out;  ///< The page; "": the name of the results with ".html".
};

/// Writes a page about the results of a campaign. An existing page is replaced.
int campaign_report_command(const CampaignReportArguments& arguments, std::ostream& out);

/// Writes the rows of a campaign as CSV into a new file; `out_file` "": the name of the results with ".csv".
int export_campaign_command(const std::string& results, const std::string& format,
                            const std::string& out_file, std::ostream& out);

/// Returns the experiment of run `row` of a campaign, with further changes. Notes on `err` if another version
/// of Flexura made the results.
[[nodiscard]] Experiment replayed_experiment(const std::string& results, std::int64_t row,
                                             const std::vector<std::string>& sets, std::ostream& err);
/// Returns the default folder of a replay: results/NAME-row-N.
[[nodiscard]] std::filesystem::path default_replay_folder(const std::string& results, std::int64_t row);

}  // namespace flexura
