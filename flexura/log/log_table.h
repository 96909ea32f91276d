#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/node.h"

namespace flexura {

/// A table that an export makes from some messages of a log.
class LogTable {
 public:
  virtual ~LogTable() = default;
  LogTable() = default;
  LogTable(const LogTable&) = delete;
  LogTable& operator=(const LogTable&) = delete;

  [[nodiscard]] virtual std::string file_name() const = 0;  ///< Returns its name: "servo.csv".
  /// Returns true if messages of this topic belong to it.
  [[nodiscard]] virtual bool takes(std::string_view topic) const = 0;
  /// Adds a message of such a topic, in the order of the log: its topic, its time in the log, s, and its
  /// text. Throws InputError or std::runtime_error if it is not a valid message.
  virtual void add(std::string_view topic, double time, const Node& message) = 0;
  /// Returns the file's text; "" means no file.
  [[nodiscard]] virtual std::string text() const = 0;
};

using LogTables = std::vector<std::unique_ptr<LogTable>>;

}  // namespace flexura
