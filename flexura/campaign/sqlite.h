#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "flexura/base/node.h"

struct sqlite3;
struct sqlite3_stmt;

namespace flexura {

/// A connection to an SQLite file. All functions throw std::runtime_error with the file's path and SQLite's
/// reason.
class SqliteFile {
 public:
  enum class Access { read, write };
  /// Opens a file; with Access::write, creates it if it is missing. Waits up to 10 s for other connections.
  SqliteFile(const std::filesystem::path& path, Access access);
  ~SqliteFile();
  SqliteFile(const SqliteFile&) = delete;
  SqliteFile& operator=(const SqliteFile&) = delete;

  /// Executes statements without results.
  void execute(const std::string& sql);

 private:
  friend class SqliteStatement;
  friend class SqliteTransaction;
  [[noreturn]] void fail() const;

  std::string path_;
  sqlite3* connection_ = nullptr;
};

/// A prepared statement. The file must outlive it.
class SqliteStatement {
 public:
  SqliteStatement(SqliteFile& file, std::string_view sql);
  ~SqliteStatement();
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;

  /// Sets parameter `index`, counted from 1. Texts, numbers and truth values keep their type (false is 0,
  /// true is 1), a missing value becomes NULL, and arrays and tables become JSON.
  void bind(int index, const Node& value);
  /// Moves to the next row; returns false after the last one.
  bool step();
  /// Makes the statement ready for another execution.
  void reset();

  /// Returns the value of column `index`, counted from 0: a number, a text, or no value for NULL.
  [[nodiscard]] Node column(int index) const;
  [[nodiscard]] std::int64_t integer(int index) const;
  [[nodiscard]] double number(int index) const;
  [[nodiscard]] std::string text(int index) const;

 private:
  SqliteFile& file_;
  sqlite3_stmt* statement_ = nullptr;
};

/// A transaction, which is undone unless commit() was called.
class SqliteTransaction {
 public:
  explicit SqliteTransaction(SqliteFile& file);
  ~SqliteTransaction();
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;
  void commit();

 private:
  SqliteFile& file_;
  bool is_open_ = true;
};

/// Returns a name in the quotes of SQL.
[[nodiscard]] std::string quoted_name(std::string_view name);

}  // namespace flexura
