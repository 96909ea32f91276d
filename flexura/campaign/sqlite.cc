#include "flexura/campaign/sqlite.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <stdexcept>
#include <variant>

#include "flexura/store/json.h"

namespace flexura {

SqliteFile::SqliteFile(const std::filesystem::path& path, Access access) : path_(path.string()) {
  const int flags =
      access == Access::read ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  if (sqlite3_open_v2(path_.c_str(), &connection_, flags, nullptr) != SQLITE_OK) {
    const std::string reason = connection_ == nullptr ? "out of memory" : sqlite3_errmsg(connection_);
    sqlite3_close(connection_);
    throw std::runtime_error(fmt::format("{}: {}", path_, reason));
  }
  constexpr int patience = 10'000;  // ms
  sqlite3_busy_timeout(connection_, patience);
}

SqliteFile::~SqliteFile() { sqlite3_close(connection_); }

void SqliteFile::fail() const {
  throw std::runtime_error(fmt::format("{}: {}", path_, sqlite3_errmsg(connection_)));
}

void SqliteFile::execute(const std::string& sql) {
  if (sqlite3_exec(connection_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

SqliteStatement::SqliteStatement(SqliteFile& file, std::string_view sql) : file_(file) {
  if (sqlite3_prepare_v2(file.connection_, sql.data(), static_cast<int>(sql.size()), &statement_, nullptr) !=
      SQLITE_OK)
    file.fail();
}

SqliteStatement::~SqliteStatement() { sqlite3_finalize(statement_); }

void SqliteStatement::bind(int index, const Node& value) {
  const auto text = [&](const std::string& one) {
    return sqlite3_bind_text(statement_, index, one.data(), static_cast<int>(one.size()), SQLITE_TRANSIENT);
  };
  int result = SQLITE_OK;
  if (const auto* truth = value.as<bool>()) {
    result = sqlite3_bind_int64(statement_, index, *truth ? 1 : 0);
  } else if (const auto* whole = value.as<std::int64_t>()) {
    result = sqlite3_bind_int64(statement_, index, *whole);
  } else if (const auto* real = value.as<double>()) {
    result = sqlite3_bind_double(statement_, index, *real);
  } else if (const auto* words = value.as<std::string>()) {
    result = text(*words);
  } else if (value.empty()) {
    result = sqlite3_bind_null(statement_, index);
  } else {
    result = text(write_json(value));
  }
  if (result != SQLITE_OK) file_.fail();
}

bool SqliteStatement::step() {
  const int result = sqlite3_step(statement_);
  if (result != SQLITE_ROW && result != SQLITE_DONE) file_.fail();
  return result == SQLITE_ROW;
}

void SqliteStatement::reset() { sqlite3_reset(statement_); }

Node SqliteStatement::column(int index) const {
  switch (sqlite3_column_type(statement_, index)) {
    case SQLITE_INTEGER:
      return {integer(index), {}};
    case SQLITE_FLOAT:
      return {number(index), {}};
    case SQLITE_NULL:
      return {};
    default:
      return {text(index), {}};
  }
}

std::int64_t SqliteStatement::integer(int index) const { return sqlite3_column_int64(statement_, index); }

double SqliteStatement::number(int index) const { return sqlite3_column_double(statement_, index); }

std::string SqliteStatement::text(int index) const {
  const unsigned char* bytes = sqlite3_column_text(statement_, index);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, index));
  return bytes == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(bytes), size);
}

SqliteTransaction::SqliteTransaction(SqliteFile& file) : file_(file) { file_.execute("BEGIN IMMEDIATE"); }

SqliteTransaction::~SqliteTransaction() {
  // Fails if SQLite has already undone the transaction, for example on a full disk.
  if (is_open_) (void)sqlite3_exec(file_.connection_, "ROLLBACK", nullptr, nullptr, nullptr);
}

void SqliteTransaction::commit() {
  file_.execute("COMMIT");
  is_open_ = false;
}

std::string quoted_name(std::string_view name) {
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

}  // namespace flexura
