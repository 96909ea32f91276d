#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/campaign/campaign_config.h"
#include "flexura/campaign/campaign_design.h"
#include "flexura/campaign/named_files.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/experiment_document.h"

namespace flexura {

/// The result of one run.
struct CampaignRow {
  std::int64_t id = 0;  ///< Number of the run, from 0.
  std::int64_t seed = 0;
  std::vector<Node> parameters;  ///< In the order of the campaign's parameters.
  std::string status;            ///< "done", "unsafe", "failed" (outcomes of a run), or "error".
  std::string error;             ///< Why the status is not "done", in one line.
  std::vector<Node> measures;  ///< In the order of the campaign's measures; empty: the run has no such value.
  double seconds = 0;          ///< Duration of the computation, s.
};

/// A campaign file with its experiment, checked.
class Campaign {
 public:
  /// Reads both files. `sets`: changes "path=value" of the campaign file. Throws InputError with all problems
  /// if a file is bad, or if none of the first runs has an experiment that can be read.
  explicit Campaign(const std::filesystem::path& file, const std::vector<std::string>& sets = {});
  /// Restores a campaign from its record(). A record without digests of named files gets those that the files
  /// have now. `source`: name of the record in errors.
  [[nodiscard]] static Campaign from_record(std::string_view record, const std::string& source);

  [[nodiscard]] const CampaignConfig& config() const { return config_; }
  [[nodiscard]] const CampaignDesign& design() const { return design_; }

  /// Returns the experiment of run `id`, with `sets` as further changes. Throws InputError if its values are
  /// invalid.
  [[nodiscard]] Experiment experiment(std::int64_t id, const std::vector<std::string>& sets = {}) const;

  /// Throws InputError if none of the first runs has an experiment that can be read and run.
  void check_first_runs() const;

  /// Throws InputError if a file that the experiment names is missing, or has changed since the campaign was
  /// read from its file. `source`: name of the record in the error.
  void check_named_files(const std::string& source) const;

  /// Returns the campaign as text (JSON), from which from_record() restores it. Of files that the experiment
  /// names, only digests are included.
  [[nodiscard]] std::string record() const;
  /// Returns the part of the record that determines the rows.
  [[nodiscard]] std::string identity() const;

 private:
  Campaign(CampaignConfig config, ExperimentDocument experiment, std::vector<NamedFile> files);
  [[nodiscard]] std::vector<Setting> settings(std::int64_t id) const;

  CampaignConfig config_;
  CampaignDesign design_;
  ExperimentDocument experiment_;
  std::vector<NamedFile> files_;
  std::vector<SourcePosition> places_;  // Of the parameters' paths.
};

/// Executes run `id` without writing files. Returns std::nullopt if it was cancelled. An experiment that
/// cannot be read or simulated is a row with the status "error". Throws std::system_error or std::bad_alloc
/// if the machine fails.
[[nodiscard]] std::optional<CampaignRow> execute_run(const Campaign& campaign, std::int64_t id,
                                                     Progress& progress);

/// Returns the value at a path of a document, "servos.0.rms" or "servos[0].rms"; null if the path does not
/// exist.
[[nodiscard]] const Node* find_path(const Node& root, std::string_view path);

}  // namespace flexura
