#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flexura/base/descriptor.h"
#include "flexura/campaign/campaign.h"
#include "flexura/campaign/sqlite.h"

namespace flexura {

/// Which failures the rows of a campaign survive without loss.
enum class Durability {
  process,  ///< The end of the program at any moment (SQLite's `synchronous = NORMAL`).
  power,    ///< Also a loss of power (`synchronous = FULL`); each group of rows waits for the disk.
};

/// The results of a campaign in an SQLite file (write-ahead log), one row per run in the table `runs`
/// (docs/campaigns.md). Only one object at a time can write the file; other connections may read it. All
/// functions throw std::runtime_error with the path if the file cannot be read or written.
class CampaignFile {
 public:
  /// Creates the file, or opens the file of an interrupted campaign. Throws InputError if another program
  /// writes the file, or if it is a file of something else: another campaign, another version of Flexura.
  CampaignFile(const std::filesystem::path& path, const Campaign& campaign,
               Durability durability = Durability::process);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Passes all rows in the order of their numbers. Only the numbers, the status and the measures are set.
  void for_each(const std::function<void(const CampaignRow&)>& visit);
  /// Adds rows in one transaction.
  void add(std::span<const CampaignRow> rows);
  /// Records that the campaign is complete with `runs` runs, and deletes all rows beyond.
  void complete(std::int64_t runs, const std::string& reason);
  /// Returns the number of runs of a complete campaign; std::nullopt if runs are missing.
  [[nodiscard]] std::optional<std::int64_t> completed_runs();

 private:
  void create();
  void check_identity();

  std::filesystem::path path_;
  const Campaign& campaign_;
  Descriptor lock_;  // Closed after the connection: closing it first would drop SQLite's own locks.
  std::optional<SqliteFile> file_;
};

/// How far a campaign is.
struct CampaignCounts {
  std::int64_t runs = 0;                         ///< Number of rows.
  std::map<std::string, std::int64_t> statuses;  ///< Number of rows with each status.
  std::string reason;                            ///< Why the campaign is complete; "" if runs are missing.
};

/// Reads the results of a campaign, also while the campaign runs.
class CampaignResults {
 public:
  /// Throws InputError if the file is missing or is no file of a campaign.
  explicit CampaignResults(const std::filesystem::path& path);

  [[nodiscard]] const Campaign& campaign() const { return *campaign_; }
  /// Returns the version of Flexura that wrote the rows.
  [[nodiscard]] const std::string& version() const { return version_; }
  /// Returns why the campaign was complete when the file was opened; "" if runs were missing.
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// Counts the rows that the file has now.
  [[nodiscard]] CampaignCounts counts();
  /// Passes all rows in the order of their numbers. Parameters and measures that are arrays are JSON texts.
  void for_each(const std::function<void(const CampaignRow&)>& visit);

 private:
  std::filesystem::path path_;
  std::optional<SqliteFile> file_;
  std::optional<Campaign> campaign_;
  std::string version_, reason_;
};

}  // namespace flexura
