#include "flexura/campaign/campaign_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include "flexura/base/version.h"

namespace flexura {
namespace {

constexpr std::string_view file_version = "1";

// Names of the columns with parameters and measures, quoted and separated by commas.
std::string value_columns(const CampaignConfig& config) {
  std::string columns;
  for (const ParameterConfig& parameter : config.parameter)
    columns += ", " + quoted_name(place_of(parameter).label());
  for (const CampaignMeasureConfig& measure : config.measure) columns += ", " + quoted_name(measure.label());
  return columns;
}

Descriptor locked(const std::filesystem::path& path) {
  Descriptor lock(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
  if (!lock) throw std::system_error(errno, std::generic_category(), path.string());
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) throw std::system_error(errno, std::generic_category(), path.string());
    throw input_error(path.string(), "another campaign writes this file: expected another --out");
  }
  return lock;
}

bool has_campaign(SqliteFile& file) {
  SqliteStatement tables(file, "SELECT count(*) FROM sqlite_master WHERE name IN ('campaign', 'runs')");
  return tables.step() && tables.integer(0) == 2;
}

bool is_new(SqliteFile& file) {
  SqliteStatement tables(file, "SELECT count(*) FROM sqlite_master");
  return tables.step() && tables.integer(0) == 0;
}

std::string entry(SqliteFile& file, const char* key) {
  SqliteStatement query(file, "SELECT value FROM campaign WHERE key = ?");
  query.bind(1, text_node(key));
  return query.step() ? query.text(0) : std::string();
}

void set_entry(SqliteFile& file, const char* key, std::string value) {
  SqliteStatement insert(file, "INSERT OR REPLACE INTO campaign VALUES (?, ?)");
  insert.bind(1, text_node(key));
  insert.bind(2, text_node(std::move(value)));
  insert.step();
}

InputError not_a_campaign(const std::filesystem::path& path) {
  return input_error(path.string(),
                     "not the results of a campaign: expected a file made by flexura campaign");
}

}  // namespace

CampaignFile::CampaignFile(const std::filesystem::path& path, const Campaign& campaign, Durability durability)
    : path_(path), campaign_(campaign), lock_(locked(path)) {
  file_.emplace(path, SqliteFile::Access::write);
  bool is_empty = false;
  try {
    is_empty = is_new(*file_);
  } catch (const std::runtime_error&) {
    throw not_a_campaign(path);  // Not an SQLite file.
  }
  if (!is_empty && !has_campaign(*file_)) throw not_a_campaign(path);
  file_->execute("PRAGMA journal_mode = WAL");
  file_->execute(durability == Durability::power ? "PRAGMA synchronous = FULL"
                                                 : "PRAGMA synchronous = NORMAL");
  if (is_empty)
    create();
  else
    check_identity();
}

void CampaignFile::create() {
  SqliteTransaction transaction(*file_);
  file_->execute("CREATE TABLE campaign (key TEXT PRIMARY KEY, value)");
  set_entry(*file_, "format", std::string(file_version));
  set_entry(*file_, "flexura", std::string(version()));
  set_entry(*file_, "identity", campaign_.identity());
  set_entry(*file_, "record", campaign_.record());
  // Columns without a type store each value as it is.
  file_->execute(
      fmt::format("CREATE TABLE runs (id INTEGER PRIMARY KEY, seed INTEGER, status TEXT, error TEXT, "
                  "seconds REAL{})",
                  value_columns(campaign_.config())));
  transaction.commit();
}

void CampaignFile::check_identity() {
  const std::string made_by = entry(*file_, "flexura");
  if (entry(*file_, "format") != file_version || made_by != version())
    throw input_error(path_.string(), fmt::format("made by Flexura {}, this is {}: expected another --out",
                                                  made_by, version()));
  if (entry(*file_, "identity") != campaign_.identity())
    throw input_error(path_.string(),
                      "the results of another campaign, or this campaign or its experiment has changed: "
                      "expected another --out");
}

void CampaignFile::for_each(const std::function<void(const CampaignRow&)>& visit) {
  std::string columns;
  for (const CampaignMeasureConfig& measure : campaign_.config().measure)
    columns += ", " + quoted_name(measure.label());
  SqliteStatement query(*file_, fmt::format("SELECT id, status{} FROM runs ORDER BY id", columns));
  CampaignRow row;
  row.measures.resize(campaign_.config().measure.size());
  while (query.step()) {
    row.id = query.integer(0), row.status = query.text(1);
    for (std::size_t i = 0; i < row.measures.size(); ++i)
      row.measures[i] = query.column(static_cast<int>(i) + 2);
    visit(row);
  }
}

void CampaignFile::add(std::span<const CampaignRow> rows) {
  const CampaignConfig& config = campaign_.config();
  std::string marks;
  for (std::size_t i = 0; i < config.parameter.size() + config.measure.size(); ++i) marks += ", ?";
  SqliteTransaction transaction(*file_);
  SqliteStatement insert(*file_, fmt::format("INSERT INTO runs (id, seed, status, error, seconds{}) "
                                             "VALUES (?, ?, ?, ?, ?{})",
                                             value_columns(config), marks));
  for (const CampaignRow& row : rows) {
    int index = 0;
    insert.bind(++index, {row.id, {}});
    insert.bind(++index, {row.seed, {}});
    insert.bind(++index, text_node(row.status));
    insert.bind(++index, row.error.empty() ? Node{} : text_node(row.error));
    insert.bind(++index, {row.seconds, {}});
    for (const Node& value : row.parameters) insert.bind(++index, value);
    for (const Node& value : row.measures) insert.bind(++index, value);
    insert.step();
    insert.reset();
  }
  transaction.commit();
}

void CampaignFile::complete(std::int64_t runs, const std::string& reason) {
  SqliteTransaction transaction(*file_);
  file_->execute(fmt::format("DELETE FROM runs WHERE id >= {}", runs));
  set_entry(*file_, "complete", fmt::format("{}", runs));
  set_entry(*file_, "reason", reason);
  transaction.commit();
}

std::optional<std::int64_t> CampaignFile::completed_runs() {
  const std::string runs = entry(*file_, "complete");
  return runs.empty() ? std::nullopt : std::optional<std::int64_t>(std::stoll(runs));
}

CampaignResults::CampaignResults(const std::filesystem::path& path) : path_(path) {
  if (!std::filesystem::is_regular_file(path))
    throw input_error(path.string(), "no such file: expected the results of a campaign");
  std::string record;
  try {
    file_.emplace(path, SqliteFile::Access::read);
    if (has_campaign(*file_)) record = entry(*file_, "record");
  } catch (const std::runtime_error&) {
    throw not_a_campaign(path);
  }
  if (record.empty()) throw not_a_campaign(path);
  campaign_.emplace(Campaign::from_record(record, path.string()));
  version_ = entry(*file_, "flexura"), reason_ = entry(*file_, "reason");
}

CampaignCounts CampaignResults::counts() {
  CampaignCounts counts;
  // A complete campaign gets no more rows, so the reason is read first.
  counts.reason = entry(*file_, "reason");
  SqliteStatement query(*file_, "SELECT status, count(*) FROM runs GROUP BY status");
  while (query.step()) counts.runs += counts.statuses[query.text(0)] = query.integer(1);
  return counts;
}

void CampaignResults::for_each(const std::function<void(const CampaignRow&)>& visit) {
  const CampaignConfig& config = campaign_->config();
  SqliteStatement query(*file_, fmt::format("SELECT id, seed, status, error, seconds{} FROM runs ORDER BY id",
                                            value_columns(config)));
  CampaignRow row;
  row.parameters.resize(config.parameter.size()), row.measures.resize(config.measure.size());
  while (query.step()) {
    row.id = query.integer(0), row.seed = query.integer(1), row.status = query.text(2);
    row.error = query.text(3), row.seconds = query.number(4);
    int index = 5;
    for (Node& value : row.parameters) value = query.column(index++);
    for (Node& value : row.measures) value = query.column(index++);
    visit(row);
  }
}

}  // namespace flexura
